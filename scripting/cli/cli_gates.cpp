#include "scripting/cli/cli_gates.h"

#include <CLI/CLI.hpp>
#include <utility>

#include "scripting/cli/cli_scripts.h"

namespace sterna::scripting {
namespace {

/// The same limit as for --threads of all commands.
constexpr int k_max_gate_threads = 1024;

using Choose = std::function<void(std::function<int(const CommandContext&)>)>;

std::pair<std::string, std::string> split_override(const std::string& text) {
  const std::size_t equals = text.find('=');
  if (equals == std::string::npos || equals == 0) throw CLI::ValidationError("--set", "\"" + text + "\" is not stage.option=value");
  return {text.substr(0, equals), text.substr(equals + 1)};
}

void add_determinism_command(CLI::App& app, DeterminismCommand& determinism, const Choose& choose) {
  CLI::App* command = app.add_subcommand("determinism",
                                         "gate G22: run a Lua case once for each number of threads, in separate folders, and compare all written files byte by "
                                         "byte; exit status 0 only if they are equal");
  command
      ->add_option("script", determinism.script,
                   "case.lua; input files are searched in the current folder, then beside the script; files written under absolute names are not compared")
      ->required();
  add_script_arguments(*command, determinism.arguments);
  command->add_option("--threads", determinism.threads, "numbers of threads, one run each; a number given twice compares two equal runs; default: 1,2,7")
      ->delimiter(',')
      ->allow_extra_args(false)
      ->check(CLI::Range(1, k_max_gate_threads))
      ->type_name("N,N,...");
  command
      ->add_option_function<std::vector<std::string>>(
          "--set",
          [&determinism](const std::vector<std::string>& texts) {
            for (const std::string& text : texts) determinism.overrides.push_back(split_override(text));
          },
          "any option of any stage, e.g. --set envelope.layers=24")
      ->type_name("STAGE.OPTION=VALUE")
      ->allow_extra_args(false)
      ->take_all();
  command->add_flag("--json", determinism.is_json, "print the report as JSON");
  command->footer(
      "Pages (.html), logs and measures of cases contain times; they are not compared, and the report lists them. The files of the runs are removed if all are "
      "equal, otherwise kept below TMPDIR.");
  command->final_callback([&determinism, choose] { choose([&determinism](const CommandContext& context) { return execute(determinism, context); }); });
}

void add_check_family_command(CLI::App& app, CheckFamilyCommand& family, const Choose& choose) {
  CLI::App* command = app.add_subcommand("check-family",
                                         "check that meshes are members of one family: the same factor between successive meshes in nodes, walls, first "
                                         "heights, layers and growth; exit status 3 if a rule FAILs");
  command
      ->add_option("meshes", family.inputs, "mesh files from coarse to fine; .sterna files contain most data, manifests <file>.json beside the files are read")
      ->required();
  FamilyTolerances tolerances;
  for (const Option& option : sterna::options_of(tolerances)) {
    std::string flag = "--" + std::string(option.name);
    for (char& c : flag)
      if (c == '_') c = '-';
    command
        ->add_option_function<std::string>(
            flag, [&family, name = std::string(option.name)](const std::string& text) { family.options.emplace_back(name, text); },
            std::string(option.help) + "; " + option.default_text())
        ->group("Options of stage " + std::string(option.stage))
        ->type_name("NUMBER");
  }
  command->add_flag("--json", family.is_json, "print the report as JSON");
  command->final_callback([&family, choose] { choose([&family](const CommandContext& context) { return execute(family, context); }); });
}

}  // namespace

void add_gate_commands(CLI::App& app, GateCommands& commands, const Choose& choose) {
  add_determinism_command(app, commands.determinism, choose);
  add_check_family_command(app, commands.family, choose);
}

}  // namespace sterna::scripting
