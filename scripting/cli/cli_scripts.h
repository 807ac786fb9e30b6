// The commands about scripts on the command line: check-script, prompt, manual.
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

/// Adds the arguments NAME=VALUE behind a script.
void add_script_arguments(CLI::App& command, OptionOverrides& arguments);

/// The commands of the program in Markdown, for the manual.
std::string commands_markdown(const CLI::App& app);

/// Prints what is wrong with a script, all of it; status 2 where there is something.
int execute(const CheckScriptCommand& command, const CommandContext& context);

}  // namespace sterna::scripting
