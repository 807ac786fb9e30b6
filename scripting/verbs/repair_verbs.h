// The verb repair, and what read_surface takes of it and of --auto.
#pragma once

#include <functional>
#include <span>
#include <vector>

#include "scripting/lua/script_call.h"
#include "scripting/lua/table_reader.h"
#include "scripting/values/verbs.h"

namespace sterna::scripting {

/// repair.
std::span<const ScriptVerb> repair_verbs();

/// How read_surface reads: nothing where its table has none of repair, wrap and auto.
using SurfaceReader = std::function<SurfaceValue(const std::vector<InputPath>&, const surfmesh::StitchOptions&, const RunContext&, const Reuse&)>;
/// repair = true or a table of repair's options, wrap likewise, auto = true; at most one of them.
SurfaceReader read_surface_entry(TableReader& reader, const ScriptCall& call);

}  // namespace sterna::scripting
