// `sterna doctor`: tests if this installation is complete.
#pragma once

#include <functional>

#include "scripting/command/command_context.h"

namespace CLI {
class App;
}

namespace sterna::scripting {

/// Adds the command `doctor`: versions, processor, memory, engines, page, browser, a folder for temporary files, and a small mesh by each engine, made in a
/// temporary folder that is removed afterwards. Exit status 0 if nothing that a mesh needs is missing. \p choose: receives the command to execute
void add_doctor_command(CLI::App& app, const std::function<void(std::function<int(const CommandContext&)>)>& choose);

}  // namespace sterna::scripting
