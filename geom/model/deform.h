// Moves, mirrors and deforms whole models. Each curve and surface is changed once, so that shared edges stay shared and meshes on them follow.
#pragma once

#include <functional>
#include <string>

#include "geom/base/ids.h"
#include "geom/base/run_context.h"
#include "geom/mesh/tri_mesh.h"
#include "geom/model/frame.h"
#include "geom/model/model.h"
#include "geom/model/space_map.h"

namespace sterna {

/// Returns the model moved, rotated, scaled or mirrored; a mirror keeps outward normals outward. `shape` is dropped.
/// \throws Error(bad_argument) if the transform is singular
Model transformed(const Model& model, const Transform& transform);

/// Maps the old name of a component, face, solid or edge to its new name.
using NameRule = std::function<std::string(const std::string&)>;
/// Mirrors a name, e.g. "left wing" -> "right wing", "Starboard" -> "Port"; a name without a side gets " mirrored".
std::string mirrored_name(const std::string& name);
/// Mirrors a name that becomes a patch name of meshes, without blanks: a name without a side gets "Left" ("RightNacelle" -> "LeftNacelle", "pod" -> "podLeft").
std::string image_name(const std::string& name);
/// Returns the mirror image in the plane through `at`; empty names stay empty.
/// \throws Error(bad_argument) for a normal of zero length
Model mirrored(const Model& model, const Point& at, const Vec3& normal, const NameRule& rename = mirrored_name);

/// Number of intervals of the fold-over check in each direction of a face's (u, v) box. If its surface has more breaks, the breaks are the samples.
inline constexpr int k_fold_over_samples = 32;

/// Returns the model composed with a map, without any refit. Parameters, names and topology are unchanged, `shape` is dropped, and tolerances grow with the
/// largest stretching found.
/// \throws Error(self_intersection) where the map folds over (determinant of the Jacobian <= 0 at a sample of a face's surface), worst locations first
Model deformed(const Model& model, const SpaceMapPtr& map, const RunContext& context);

/// Location of a surface mesh vertex on its model.
struct VertexLocation {
  FaceId face;
  Uv at;
};

}  // namespace sterna
