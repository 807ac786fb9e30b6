// Runs one Lua script in its sandbox.
#pragma once

#include <cstddef>
#include <filesystem>
#include <functional>
#include <string_view>

#include "scripting/lua/script_call.h"
#include "scripting/lua/script_sandbox.h"

namespace sterna::scripting {

/// Memory that a script's own values may take; meshes live outside of it.
inline constexpr std::size_t k_script_memory_limit = std::size_t{1} << 30;

struct ScriptSettings {
  std::filesystem::path script;
  OptionOverrides overrides;                      ///< "stage.option" -> text, checked before the script starts
  std::function<void(std::string_view)> print;    ///< results: print(), verdicts, help
  std::function<void(const MeshValue&)> on_mesh;  ///< called for every volume mesh made; may be empty
  const StageCache* cache = nullptr;              ///< stage_cache.h; null: every stage is made anew
  std::size_t memory_limit = k_script_memory_limit;
  SeriesSettings series = {};          ///< empty: series{} is refused
  OptionOverrides arguments = {};      ///< NAME=VALUE of the command line: what the script sees as args
  ScriptCheck* check = nullptr;        ///< see check_script
  const ScriptWatch* watch = nullptr;  ///< who looks on (script_watch.h)
  std::filesystem::path input_folder =
      {};  ///< where input files are looked for that are not in the current folder, before that of the script; empty: nowhere else
};

/// What a script that came to its end has to say to the shell.
struct ScriptOutcome {
  std::size_t n_failed_cases = 0;   ///< of its series
  std::size_t n_invalid_cases = 0;  ///< whose mesh is INVALID
};

/// Scripts see Lua's base (without dofile, loadfile, load), table, string, math, utf8, and our verbs; math.random is seeded from the context's seed;
/// require("name") loads name.lua beside the script. A stop request ends the script at its next instruction.
/// \throws Error script_failed (syntax, run-time error: with file:line), unknown_option or bad_argument of an override, or the Error of a verb with the
/// script's file:line in front. In a worker the script ends with its case, whose failure is no error here but counts in the outcome.
ScriptOutcome run_script(const ScriptSettings& settings, const RunContext& context);

/// Runs a script without meshing or writing (script_check.h); what is wrong is in `check`, nothing of that is thrown.
/// \throws Error cancelled; of overrides, as run_script
void check_script(const ScriptSettings& settings, ScriptCheck& check, const RunContext& context);

}  // namespace sterna::scripting
