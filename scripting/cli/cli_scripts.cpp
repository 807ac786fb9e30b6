#include "scripting/cli/cli_scripts.h"

#include <CLI/CLI.hpp>

#include "geom/base/error.h"
#include "scripting/interpreter/script_args.h"
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

}  // namespace

void add_script_arguments(CLI::App& command, OptionOverrides& arguments) {
  command
      .add_option_function<std::vector<std::string>>(
          "arguments",
          [&arguments](const std::vector<std::string>& texts) {
            for (const std::string& text : texts) arguments.push_back(split_argument(text));
          },
          "arguments that the script reads with args{ alpha = 0 }, e.g. alpha=4 height=2mm half=true")
      ->type_name("NAME=VALUE ...");
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

int execute(const CheckScriptCommand& command, const CommandContext& context) {
  ScriptCheck check;
  check_script({.script = command.script.script, .overrides = command.script.overrides, .print = {}, .on_mesh = {}, .arguments = command.script.arguments},
               check, context.run);
  const std::string name = command.script.script.string();
  if (check.problems.empty()) {
    context.console.print(name + ": no problems found; nothing was meshed or written");
    return k_exit_success;
  }
  for (const ErrorHandle& problem : check.problems) context.console.error(problem->what());
  context.console.print(name + ": " + std::to_string(check.problems.size()) + (check.problems.size() == 1 ? " problem" : " problems"));
  return k_exit_usage;
}

}  // namespace sterna::scripting
