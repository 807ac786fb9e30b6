// The verbs available to scripts, and the methods and fields of their objects.
#pragma once

#include <span>

#include "scripting/lua/script_call.h"

namespace sterna::scripting {

/// Global verbs: read_surface, union, read_mesh, volume_mesh, sphere, help, and those of stage_verbs.h, source_verbs.h, geometry_verbs.h and component_verbs.h.
std::span<const ScriptVerb> script_verbs();
std::span<const ScriptVerb> surface_methods();
std::span<const ScriptVerb> mesh_methods();

/// tostring() of all objects of sterna.
extern const ScriptVerb k_describe_object;
/// Verbs that read object.name for names that are no method.
extern const ScriptVerb k_surface_field;
extern const ScriptVerb k_mesh_field;
extern const ScriptVerb k_error_field;

struct ScriptUnit {
  const char* name;
  double value;  ///< SI
};
/// The global numbers m, mm, um, cm, inch, ft, deg.
std::span<const ScriptUnit> script_units();

/// Returns a suggestion for an unknown global name: the verb or unit with the nearest name, or the replacement for one of Lua's omitted libraries. Empty if no
/// name is near.
std::string hint_for_global(std::string_view name);

}  // namespace sterna::scripting
