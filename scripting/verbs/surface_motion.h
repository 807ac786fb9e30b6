// Surfaces that are moved, turned and put together; what was made of a part before it moved can be moved after it.
#pragma once

#include <span>
#include <string>

#include "scripting/lua/script_call.h"
#include "scripting/values/verbs.h"

namespace sterna::scripting {

/// The surface elsewhere: its parts, or it as one part, remember where they were made.
/// \pre `motion` is a rotation and a shift
SurfaceValue moved_surface(const SurfaceValue& surface, const Transform& motion);

/// The surfaces side by side, each a part (or its parts): a triangulated model in a triangulated tunnel. Patches of the same name and kind are one. Nothing is
/// united.
/// \throws Error(self_intersection) where triangles of two surfaces cross, with places
SurfaceValue side_by_side(std::span<const SurfaceHandle> surfaces, const RunContext& context);

/// surface:move, surface:rotate
std::span<const ScriptVerb> surface_motions();

}  // namespace sterna::scripting
