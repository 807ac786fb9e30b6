// `sterna doctor`: whether this installation can do its work.
#pragma once

#include <functional>

#include "scripting/command/command_context.h"

namespace CLI {
class App;
}

namespace sterna::scripting {

/// The command `doctor`: versions, processor, memory, engines, page, browser, a folder for temporary files, and a small mesh by each engine, made in a folder
/// of its own that goes again. Exit status 0 where nothing that a mesh needs is missing. \p choose: what is to be executed
void add_doctor_command(CLI::App& app, const std::function<void(std::function<int(const CommandContext&)>)>& choose);

}  // namespace sterna::scripting
