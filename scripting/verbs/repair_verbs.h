// The verb repair, and the entries repair, wrap and auto of read_surface.
#pragma once

#include <functional>
#include <span>
#include <vector>

#include "scripting/lua/script_call.h"
#include "scripting/lua/table_reader.h"
#include "scripting/values/verbs.h"

namespace sterna::scripting {

/// The verb repair.
std::span<const ScriptVerb> repair_verbs();

/// Reader for read_surface; empty if its table has none of repair, wrap and auto.
using SurfaceReader = std::function<SurfaceValue(const std::vector<InputPath>&, const surfmesh::StitchOptions&, const RunContext&, const Reuse&)>;
/// Reads one of repair, wrap and auto. repair and wrap are true or a table of options of the step; auto is true. At most one of them may be given.
SurfaceReader read_surface_entry(TableReader& reader, const ScriptCall& call);

}  // namespace sterna::scripting
