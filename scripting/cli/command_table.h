// The commands of `sterna` as one table. The command line, --help, completion, the man page and the manual are made from it.
#pragma once

#include <functional>
#include <string>
#include <string_view>
#include <vector>

#include "scripting/command/command_context.h"
#include "scripting/command/command_line.h"

namespace sterna::scripting {

/// Receives the command to execute.
using ChooseCommand = std::function<void(std::function<int(const CommandContext&)>)>;

struct CommandRow {
  std::string_view name;
  std::string summary = {};
  std::vector<std::string_view> verbs = {};     ///< verbs of scripts that do the same one after the other; empty: there are none
  std::vector<CommandArgument> arguments = {};  ///< in the order of the help
  std::string footer = {};
  int (*run)(const CommandLine&, const CommandContext&) = nullptr;  ///< null: the prompt
  std::string_view picture = {};  ///< argument with the file beside which a failure is drawn: beside an output, or in the current folder for an input
  std::string_view alias = {};
  bool prints_findings = false;  ///< the command prints the findings on the input as its result, so the log omits them unless it is verbose
  void (*add)(CLI::App& app, const ChooseCommand& choose) = nullptr;  ///< adds commands that need the whole program, in place of a row
};

/// Returns all rows, in the order of the help.
const std::vector<CommandRow>& command_rows();

/// Arguments of single commands (cli_arguments.cpp): NAME=VALUE ..., --threads N,N, --size WIDTHxHEIGHT, --flow, --kind.
void add_script_arguments(CLI::App& command, CommandLine& line);
void add_thread_numbers(CLI::App& command, CommandLine& line);
void add_picture_size(CLI::App& command, CommandLine& line);
void add_flow_words(CLI::App& command, CommandLine& line);
void add_patch_kinds(CLI::App& command, CommandLine& line);
/// Adds `manual`, which prints the commands of the program, too (cli_scripts.cpp).
void add_manual_command(CLI::App& app, const ChooseCommand& choose);

/// Returns the options of `foam-case` or `su2-config`: of the solver, of all cases and of the flow (case_commands.cpp).
HeldOptions case_arguments(bool is_foam);

}  // namespace sterna::scripting
