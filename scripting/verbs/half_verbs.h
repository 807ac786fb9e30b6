// The verb half. It cuts models as exact geometry, and triangulated surfaces as triangles.
#pragma once

#include <span>

#include "scripting/lua/script_call.h"
#include "scripting/values/verbs.h"

namespace sterna {
struct HalfOptions;  // geom/mesh/half.h
}

namespace sterna::scripting {

/// The verb half. Takes a surface, the name of a surface's file, models or components.
std::span<const ScriptVerb> half_verbs();

/// Returns the half of a surface, with the data on its origin.
/// \throws Error of half_of
SurfaceValue half_surface(const SurfaceValue& surface, const HalfOptions& options, const RunContext& context);

}  // namespace sterna::scripting
