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

/// Returns the vertex whose image in the plane `coordinate axis = at` is farthest from the surface, if the distance exceeds `share` times the longest edge at
/// it: triangles of both sides need not be images of each other, chords of curves are not. Zero if there is none; ties by the first vertex.
MirrorGap mirror_gap(const TriMesh& surface, std::size_t axis, double at, double share, const RunContext& context);

/// Returns the warning about a half model whose other side is not its mirror image. \p plane: "y = 0 m"
std::string describe_asymmetry(const MirrorGap& gap, const std::string& plane);

}  // namespace sterna
