// How far a surface is from being its own image in a plane.
#pragma once

#include <cstddef>
#include <string>

#include "geom/base/run_context.h"
#include "geom/mesh/tri_mesh.h"

namespace sterna {

struct MirrorGap {
  double distance = 0.0;  ///< m, from the image of a vertex to the surface
  Point at{};             ///< that vertex
};

/// The vertex whose image in the plane `coordinate axis = at` is farthest from the surface, beyond `share` of its longest edge: triangles of both sides need
/// not be images of each other, chords of curves are not. Zero where there is none. Of equally far ones the first.
MirrorGap mirror_gap(const TriMesh& surface, std::size_t axis, double at, double share, const RunContext& context);

/// The warning about a half whose other side is no image of it. \p plane: "y = 0 m"
std::string describe_asymmetry(const MirrorGap& gap, const std::string& plane);

}  // namespace sterna
