// `sterna inspect`: the pre-flight inspection on the command line.
#pragma once

#include <filesystem>
#include <functional>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "scripting/cli/commands.h"

namespace CLI {
class App;
}

namespace sterna::scripting {

inline constexpr std::string_view k_inspect_summary =
    "predict within seconds how volume_mesh will treat a surface: reasons to refuse it, low layers, bad cells, each with a line of advice. Exit status 0 if "
    "there is no error, else 1";

struct InspectCommand {
  std::vector<std::string> inputs;
  OptionOverrides options;  ///< --layers 30 as {"layers", "30"} and --set stage.option=value
  VolumeRequest volume;
  std::string flow;  ///< "mach=0.78 altitude=11000 length=4.2"; empty: none
  std::filesystem::path output;
  bool is_json = false;
  bool is_strict = false;  ///< warnings count as failures, too
};

/// Adds the arguments of the command, and calls `chosen` if the command is selected.
void add_inspect_arguments(CLI::App& command, InspectCommand& inspect, const std::function<void()>& chosen);

/// Prints the report; status 1 if there is an error, with is_strict also for a warning.
int execute(const InspectCommand& command, const CommandContext& context);

}  // namespace sterna::scripting
