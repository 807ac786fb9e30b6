// Pictures in scripts: draw{ mesh, "mesh.png", view = "iso" }.
#pragma once

#include <optional>
#include <span>
#include <string>

#include "scripting/lua/script_call.h"

namespace sterna::scripting {

std::span<const ScriptVerb> draw_verbs();

/// Returns { point = {0, 0, 0}, normal = {0, 1, 0} } or { x = 1.2 } as the string of an option; nothing for other tables.
std::optional<std::string> cut_text(const ScriptTable& table);

}  // namespace sterna::scripting
