// Runs one Lua script in its sandbox.
#pragma once

#include <cstddef>
#include <filesystem>
#include <functional>
#include <string_view>

#include "scripting/script_call.h"

namespace sterna::scripting {

/// Memory that a script's own values may take; meshes live outside of it.
inline constexpr std::size_t k_script_memory_limit = std::size_t{1} << 30;

struct ScriptSettings {
  std::filesystem::path script;
  OptionOverrides overrides;                      ///< "stage.option" -> text, checked before the script starts
  std::function<void(std::string_view)> print;    ///< results: print(), verdicts, help
  std::function<void(const MeshValue&)> on_mesh;  ///< called for every volume mesh made; may be empty
  std::size_t memory_limit = k_script_memory_limit;
};

/// Scripts see Lua's base (without dofile, loadfile, load), table, string, math, utf8, and our verbs; math.random is seeded from the context's seed;
/// require("name") loads name.lua beside the script. A stop request ends the script at its next instruction.
/// \throws Error script_failed (syntax, run-time error: with file:line), unknown_option or bad_argument of an override, or the Error of a verb with the
/// script's file:line in front.
void run_script(const ScriptSettings& settings, const RunContext& context);

}  // namespace sterna::scripting
