// Shell completions and the man page of the commands and their options. They are generated from the same tables as --help.
#pragma once

#include <functional>
#include <string>

#include "scripting/command/command_context.h"

namespace CLI {
class App;
}

namespace sterna::scripting {

/// Returns a script that completes commands, options and file names in a shell.
/// \p shell: bash, zsh or fish
/// \throws Error(bad_argument) for another shell
std::string completion_script(const CLI::App& app, const std::string& shell);

/// Returns the page sterna(1) in roff.
std::string man_page(const CLI::App& app);

/// Adds the commands `completion` and `man`. \p choose: receives the command to execute. The app must outlive it.
void add_shell_commands(CLI::App& app, const std::function<void(std::function<int(const CommandContext&)>)>& choose);

}  // namespace sterna::scripting
