// The commands for scripts: check-script, manual.
#include <CLI/CLI.hpp>

#include "geom/base/error.h"
#include "scripting/cli/command_table.h"
#include "scripting/cli/commands.h"
#include "scripting/interpreter/script_manual.h"
#include "scripting/interpreter/script_run.h"
#include "scripting/lua/script_check.h"
#include "scripting/terminal/exit_status.h"

namespace sterna::scripting {
namespace {

std::string markdown_cell(std::string text) {
  for (std::size_t at = 0; (at = text.find('|', at)) != std::string::npos; at += 2) text.insert(at, "\\");
  return text;
}

std::string options_markdown(const CLI::App& app) {
  std::string text;
  for (const CLI::Option* option : app.get_options()) {
    if (option->get_group().empty()) continue;  // not listed
    const std::string type = option->get_type_name();
    text += "| `" + option->get_name(option->get_positional(), true) + "`" + (type.empty() ? "" : " " + markdown_cell(type)) + " | " +
            markdown_cell(option->get_description()) + " |\n";
  }
  return text.empty() ? text : "\n| option | |\n|---|---|\n" + text;
}

std::string commands_markdown(const CLI::App& app) {
  std::string text = "Options of every command:\n" + options_markdown(app);
  for (const CLI::App* command : app.get_subcommands({})) {
    if (command->get_group().empty()) continue;
    text += "\n### sterna " + command->get_name() + "\n\n" + command->get_description() + "\n" + options_markdown(*command);
    if (!command->get_footer().empty()) text += "\n" + command->get_footer() + "\n";
  }
  return text + "\n" + std::string(k_exit_status_help) + "\n";
}

}  // namespace

void add_manual_command(CLI::App& app, const ChooseCommand& choose) {
  app.add_subcommand("manual", "print the reference of verbs, objects, options and commands (docs/lua.md)")->final_callback([&app, choose] {
    choose([&app](const CommandContext& context) {
      context.console.print(manual_text(commands_markdown(app)));
      return k_exit_success;
    });
  });
}

int check_script_command(const CommandLine& line, const CommandContext& context) {
  ScriptCheck check;
  const std::string script = line.word("script");
  check_script({.script = script, .overrides = line.set, .print = {}, .on_mesh = {}, .arguments = line.arguments}, check, context.run);
  if (check.problems.empty()) {
    context.console.print(script + ": no problems found; nothing was meshed or written");
    return k_exit_success;
  }
  for (const ErrorHandle& problem : check.problems) context.console.error(problem->what());
  context.console.print(script + ": " + std::to_string(check.problems.size()) + (check.problems.size() == 1 ? " problem" : " problems"));
  return k_exit_usage;
}

}  // namespace sterna::scripting
