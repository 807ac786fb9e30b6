// Consistent orientation within components, outward orientation over all of them.
#pragma once

#include "surfmesh/stitch/edges.h"

namespace sterna::surfmesh {

struct Orientation {
  std::vector<std::uint32_t> component;   ///< per triangle
  std::uint32_t n_components = 0;
  std::vector<EdgeUse> conflicts;         ///< edges at which no choice is consistent (Moebius bands); empty when orientable
  std::vector<std::uint8_t> is_flipped;   ///< per triangle, relative to the input
};

/// Flood fill over edges with two triangles from the lowest triangle of each component; flips triangles of `surface`.
Orientation orient_consistently(IndexedSurface& surface, const EdgeTable& edges);

/// Turns closed components so that normals point out of the body, and removes components that lie inside another one's solid (winding number).
/// \pre consistent, closed, free of self-intersection. Returns the number of removed triangles; flips are recorded in `orientation`.
std::int64_t orient_outward(IndexedSurface& surface, Orientation& orientation, const RunContext& context);

/// Turns an open component so that most of its area faces away from the surface's centre of area (a guess, said so to the user).
void orient_open_outward(IndexedSurface& surface, Orientation& orientation);

}  // namespace sterna::surfmesh
