// The verbs that make triangulations: surface_mesh of models, remesh of triangulations.
#pragma once

#include <functional>
#include <span>

#include "scripting/lua/script_call.h"
#include "scripting/lua/table_reader.h"
#include "scripting/values/remeshed_surface.h"

namespace sterna::scripting {

std::span<const ScriptVerb> surface_verbs();

/// The entry `remesh` of read_surface, which is true or a table with the options of the verb remesh. Empty if there is no such entry.
using RemeshEntry = std::function<SurfaceValue(const SurfaceValue&, const RunContext&, const Reuse&)>;
RemeshEntry read_remesh_entry(TableReader& reader, const ScriptCall& call);

}  // namespace sterna::scripting
