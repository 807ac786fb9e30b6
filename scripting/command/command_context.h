// What every subcommand gets, and how its options are set.
#pragma once

#include <functional>
#include <string>

#include "geom/base/run_context.h"
#include "geom/base/schema.h"
#include "scripting/lua/script_call.h"
#include "scripting/terminal/console.h"

namespace sterna::scripting {

/// What every command gets: where to print, and the run.
struct CommandContext {
  Console& console;
  const RunContext& run;
  bool only_options = false;                    ///< --show-options: the command ends when its options are set
  std::function<void(bool)> stops_itself = {};  ///< see SeriesSettings
};

/// Thrown with --show-options once all options of a command are set. No error.
struct OptionsShown {
  std::string json;
};

/// Sets every option; all problems are reported together, also options that are given twice with different values.
/// \throws Error(bad_argument); OptionsShown
void set_options(const OptionTable& table, const OptionOverrides& given, const CommandContext& context);

}  // namespace sterna::scripting
