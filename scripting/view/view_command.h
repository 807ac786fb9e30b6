// `sterna view`: the workbench of a script, or of a file.
#pragma once

#include <filesystem>

#include "scripting/cache/stage_cache.h"
#include "scripting/command/command_context.h"

namespace CLI {
class App;
}

namespace sterna::scripting {

struct ViewCommand {
  std::filesystem::path input;
  OptionOverrides arguments;  ///< NAME=VALUE
  OptionOverrides overrides;  ///< --set
  int port = 0;               ///< 0: any free port
  bool is_without_browser = false;
  std::filesystem::path cache;  ///< empty: a cache for this session, removed at its end
  double cache_limit = k_cache_limit;
  bool is_worker = false;  ///< not listed in the help: this process runs scripts for the workbench (view_worker.h)
};

CLI::App* add_view_arguments(CLI::App& app, ViewCommand& view);
/// Serves the page until Ctrl-C.
/// \throws Error(file_not_found, unsupported_format) for an input that cannot be shown, (bad_argument) if the port is taken
int execute(const ViewCommand& command, const CommandContext& context);

}  // namespace sterna::scripting
