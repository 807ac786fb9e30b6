// Parts of models. A part is geometry that was read or made together and has since only been moved and turned. Parts are meshed in their own frame and then
// moved, so that the same part has the same triangles, whatever its attitude and its surroundings.
#pragma once

#include <cstddef>
#include <memory>
#include <optional>
#include <vector>

#include "geom/base/run_context.h"
#include "geom/model/frame.h"
#include "geom/model/model.h"
#include "scripting/cache/provenance.h"

namespace sterna::scripting {

struct ModelValue;

struct ModelPart {
  std::shared_ptr<const Model> own;    ///< geometry in its own frame; its names and kinds may be older than those of the model that contains the part
  Transform placement;                 ///< rotation and shift, from its own frame to its location
  std::optional<ContentKey> key = {};  ///< key of the inputs of `own`, for caches; nothing: unknown
  bool is_in_place() const { return placement == Transform{}; }
};

/// Returns the parts of a model, in the order of its components, corners, edges, faces and solids. If no parts are recorded, the model is one part, at its
/// location.
std::vector<ModelPart> parts_of(const ModelValue& value);

/// Returns part `i` in its own frame, with the current names, roles and kinds of the model's faces.
Model own_model(const ModelValue& value, const std::vector<ModelPart>& parts, std::size_t i);

/// Moves and turns the model; its parts are kept.
/// \pre `motion` is a rotation and a shift
void move_parts(const Transform& motion, ModelValue& value);
/// Mirrors the model in the plane through `at`: parts become their own mirror images, at the mirrored locations.
void mirror_parts(const Point& at, const Vec3& normal, ModelValue& value);

/// Replaces the model of `value` by the solids of `changed`, which a boolean made from those of `looked_at` (the model of `value`, or its replacement for
/// OpenCASCADE). Solids that the boolean left unchanged stay the same parts, with the surfaces that `value` had. Consecutive changed solids form one part, at
/// their location. If all solids are changed, no parts are recorded any more. The order is that of `changed`.
/// \pre all faces of both are of solids
void take_solids(const Model& looked_at, const Model& changed, ModelValue& value);

}  // namespace sterna::scripting
