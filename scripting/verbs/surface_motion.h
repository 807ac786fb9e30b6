// Methods that move, turn and combine surfaces. Parts that were meshed before a motion can be reused after it.
#pragma once

#include <span>
#include <string>

#include "scripting/lua/script_call.h"
#include "scripting/values/verbs.h"

namespace sterna::scripting {

/// Returns the moved surface. Its parts, or the surface as one part, keep their original location.
/// \pre `motion` is a rotation and a shift
SurfaceValue moved_surface(const SurfaceValue& surface, const Transform& motion);

/// Returns the surfaces side by side, for example a triangulated model in a triangulated tunnel. Each surface becomes a part, or keeps its parts. Patches of
/// the same name and kind are merged. No union is made.
/// \throws Error(self_intersection) with locations if triangles of two surfaces cross
SurfaceValue side_by_side(std::span<const SurfaceHandle> surfaces, const RunContext& context);

/// The methods surface:move, surface:rotate.
std::span<const ScriptVerb> surface_motions();

}  // namespace sterna::scripting
