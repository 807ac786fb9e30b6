// The common context of all subcommands, and the setting of their options.
#pragma once

#include <functional>
#include <initializer_list>
#include <string>
#include <string_view>
#include <vector>

#include "geom/base/run_context.h"
#include "geom/base/schema.h"
#include "scripting/lua/script_call.h"
#include "scripting/terminal/console.h"

namespace sterna::scripting {

/// The common context of all commands: output and run.
struct CommandContext {
  Console& console;
  const RunContext& run;
  bool only_options = false;                    ///< --show-options: the command ends when its options are set
  std::function<void(bool)> stops_itself = {};  ///< see SeriesSettings
};

/// Thrown with --show-options once all options of a command are set. Not an error.
struct OptionsShown {
  std::string json;
};

/// Options that the command has only for other inputs, or with another flag. If one of them is given, the reason why it has no effect is reported.
struct OptionsElsewhere {
  OptionTable table;
  std::string why;  ///< reason: "is for models (STEP ...), and wall.stl is a triangulation"
};

/// Sets every option. All problems are reported together, including options given twice with different values.
/// \throws Error(bad_argument); OptionsShown
void set_options(const OptionTable& table, const OptionOverrides& given, const CommandContext& context, const std::vector<OptionsElsewhere>& elsewhere = {});

/// Removes the options of a table from `given` and returns them.
OptionOverrides take_options(OptionOverrides& given, const OptionTable& table);
/// Removes the options "stage.option" of a stage from `given` and returns them.
OptionOverrides take_stage(OptionOverrides& given, std::string_view stage);

/// \param given as in CommandLine. \throws Error(bad_argument) that names the given options of `without_effect`: "--strict has no effect: a.step is
/// a model"
void refuse_without_effect(const std::vector<std::string>& given, std::initializer_list<std::string_view> without_effect, const std::string& attempted,
                           const std::string& why, const std::string& hint = {});

}  // namespace sterna::scripting
