// Whole models moved, mirrored and deformed: every curve and surface once, so edges that are shared stay shared; meshes on them follow.
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

/// The model moved, turned, scaled, mirrored; a mirror keeps outward normals outward. `shape` is dropped.
/// \throws Error(bad_argument) when T flattens space
Model transformed(const Model& model, const Transform& transform);

/// New name of a component, face, solid or edge from its old one.
using NameRule = std::function<std::string(const std::string&)>;
/// "left wing" -> "right wing", "Starboard" -> "Port" ...; a name without a side gets " mirrored".
std::string mirrored_name(const std::string& name);
/// The same for names that become patches of meshes, without blanks: a name without a side gets "Left" ("RightNacelle" -> "LeftNacelle", "pod" -> "podLeft").
std::string image_name(const std::string& name);
/// Mirror image in the plane through `at`; empty names stay empty.
/// \throws Error(bad_argument) for a normal without a direction
Model mirrored(const Model& model, const Point& at, const Vec3& normal, const NameRule& rename = mirrored_name);

/// Intervals of the fold-over check in each direction of a face's (u, v) box; where its surface has more breaks, these are the samples.
inline constexpr int k_fold_over_samples = 32;

/// The model seen through a map: no refit, parameters, names and topology stay, `shape` is dropped; tolerances grow with the largest stretching found.
/// \throws Error(self_intersection) where space folds over (determinant of the Jacobian <= 0 at a sample of a face's surface), worst places first
Model deformed(const Model& model, const SpaceMapPtr& map, const RunContext& context);

/// Where a vertex of a surface mesh lies on its model.
struct VertexPlace {
  FaceId face;
  Uv at;
};

}  // namespace sterna
