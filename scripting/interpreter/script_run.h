// Runs one Lua script in its sandbox.
#pragma once

#include <cstddef>
#include <filesystem>
#include <functional>
#include <string_view>

#include "scripting/lua/script_call.h"
#include "scripting/lua/script_sandbox.h"

namespace sterna::scripting {

/// Memory limit for a script's own values; meshes are stored outside of it.
inline constexpr std::size_t k_script_memory_limit = std::size_t{1} << 30;

struct ScriptSettings {
  std::filesystem::path script;
  OptionOverrides overrides;                      ///< "stage.option" -> string, checked before the script starts
  std::function<void(std::string_view)> print;    ///< receives results: print(), verdicts, help
  std::function<void(const MeshValue&)> on_mesh;  ///< called for every volume mesh made; may be empty
  const StageCache* cache = nullptr;              ///< cache for stages; null: every stage is recomputed
  std::size_t memory_limit = k_script_memory_limit;
  SeriesSettings series = {};          ///< empty: series{} is refused
  OptionOverrides arguments = {};      ///< assignments NAME=VALUE of the command line, available to the script as args
  ScriptCheck* check = nullptr;        ///< see check_script
  const ScriptWatch* watch = nullptr;  ///< observer (script_watch.h)
  std::filesystem::path input_folder =
      {};  ///< searched for input files that are not in the current folder, before the folder of the script; empty: nowhere else
};

/// The outcome of a script that ran to its end, for the exit status.
struct ScriptOutcome {
  std::size_t n_failed_cases = 0;   ///< number of failed cases of its series
  std::size_t n_invalid_cases = 0;  ///< number of cases whose mesh is INVALID
};

/// Runs a script. Scripts have Lua's base (without dofile, loadfile, load), table, string, math, utf8, and the verbs of sterna. math.random is seeded from the
/// context's seed. require("name") loads name.lua beside the script. A stop request ends the script at its next instruction.
/// \throws Error script_failed (syntax or run-time error, with file:line), unknown_option or bad_argument of an override, or the Error of a verb with the
/// script's file:line in front. In a worker the script ends with its case; a failure of the case is not an error but is counted in the outcome.
ScriptOutcome run_script(const ScriptSettings& settings, const RunContext& context);

/// Runs a script without meshing or writing (script_check.h); problems go to `check`, none of them is thrown.
/// \throws Error cancelled; of overrides, as run_script
void check_script(const ScriptSettings& settings, ScriptCheck& check, const RunContext& context);

}  // namespace sterna::scripting
