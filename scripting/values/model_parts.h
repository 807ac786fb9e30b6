// Parts of models: what was read or made together and has since been moved and turned only. Parts are meshed where they were made and then moved, so that the
// same part has the same triangles, whatever its attitude is and whatever is around it.
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
  std::shared_ptr<const Model> own;    ///< in its own frame; its names and kinds may be older than those of the model that it is part of
  Transform placement;                 ///< rotation and shift, from there to where it is
  std::optional<ContentKey> key = {};  ///< of what `own` was made of, for caches; nothing: not known
  bool is_in_place() const { return placement == Transform{}; }
};

/// The parts of a model, in the order of its components, corners, edges, faces and solids; one, in its place, where nothing is known of others.
std::vector<ModelPart> parts_of(const ModelValue& value);

/// Part `i` in its own frame, with the names, roles and kinds that the model's faces have now.
Model own_model(const ModelValue& value, const std::vector<ModelPart>& parts, std::size_t i);

/// The model moved and turned: its parts stay what they are.
/// \pre `motion` is a rotation and a shift
void move_parts(const Transform& motion, ModelValue& value);
/// The mirror image in the plane through `at`: parts become their own mirror images, in places that are the images of theirs.
void mirror_parts(const Point& at, const Vec3& normal, ModelValue& value);

/// Makes `value` the solids of `changed`, which a boolean made of those of `looked_at` (the model of `value`, or what OpenCASCADE took instead of it). Solids
/// that it left as they were stay the parts that they are, with the surfaces that `value` had; others that follow each other are one part, in their place;
/// where all are such, nothing is known of parts any more. Order: that of `changed`.
/// \pre all faces of both are of solids
void take_solids(const Model& looked_at, const Model& changed, ModelValue& value);

}  // namespace sterna::scripting
