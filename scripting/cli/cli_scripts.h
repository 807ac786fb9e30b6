// Command line of the commands for scripts: check-script, prompt, manual.
#pragma once

#include <functional>
#include <string>

#include "scripting/cli/commands.h"
#include "scripting/terminal/interrupt.h"

namespace CLI {
class App;
}

namespace sterna::scripting {

struct CheckScriptCommand {
  RunCommand script;
};

/// Adds the arguments NAME=VALUE after a script.
void add_script_arguments(CLI::App& command, OptionOverrides& arguments);

/// Returns the commands of the program in Markdown, for the manual.
std::string commands_markdown(const CLI::App& app);

/// Prints all problems of a script; status 2 if there are any.
int execute(const CheckScriptCommand& command, const CommandContext& context);

}  // namespace sterna::scripting
