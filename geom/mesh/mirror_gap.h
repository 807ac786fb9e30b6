// Deviation of a surface from mirror symmetry about a plane.
#pragma once

#include <cstddef>
#include <string>

#include "geom/base/run_context.h"
#include "geom/mesh/tri_mesh.h"

namespace sterna {

struct MirrorGap {
  double distance = 0.0;  ///< m, from the image of a vertex to the surface
  Point at{};             ///< the vertex
};

/// Mirrors each vertex at the plane `coordinate axis = at` and measures the distance of its image from the surface. Returns the vertex with the largest
/// distance if that exceeds `share` times the longest edge at the vertex. A smaller distance is no gap: triangles of the two sides may differ, and so do the
/// chords of a curved surface. Returns zero if there is no gap; ties by the first vertex.
MirrorGap mirror_gap(const TriMesh& surface, std::size_t axis, double at, double share, const RunContext& context);

/// Returns the warning about a half model whose other side is not its mirror image. \p plane: "y = 0 m"
std::string describe_asymmetry(const MirrorGap& gap, const std::string& plane);

}  // namespace sterna
