// `sterna view`: the workbench of a script, or of a file.
#pragma once

#include <functional>

#include "scripting/command/command_context.h"

namespace CLI {
class App;
}

namespace sterna::scripting {

/// Adds the command, which serves the page until Ctrl-C. \p choose: receives the command to execute.
/// It throws Error(file_not_found, unsupported_format) for an input that cannot be shown, (bad_argument) if the port is taken.
void add_view_command(CLI::App& app, const std::function<void(std::function<int(const CommandContext&)>)>& choose);

}  // namespace sterna::scripting
