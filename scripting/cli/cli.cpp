// The whole command line: options of all commands, and the rows of the table of commands.
#include "scripting/cli/cli.h"

#include <unistd.h>
#include <CLI/CLI.hpp>

#include <algorithm>
#include <array>
#include <cstdio>
#include <functional>
#include <list>

#include "geom/base/error.h"
#include "geom/base/schema.h"
#include "scripting/cli/command_table.h"
#include "scripting/cli/commands.h"
#include "scripting/cli/line_editor.h"
#include "scripting/cli/prompt.h"
#include "scripting/lua/foreign_error.h"
#include "scripting/terminal/console.h"
#include "scripting/terminal/exit_status.h"
#include "scripting/terminal/interrupt.h"

namespace sterna::scripting {
namespace {

/// Largest accepted number of threads. It is far above that of any machine and far below the limit of the system, so a larger number is a typing error.
constexpr int k_max_threads = 1024;

/// Options common to all commands.
struct CommonSettings {
  ConsoleSettings console;
  int threads = 0;
  std::uint64_t seed = 1;
  std::filesystem::path dump_directory;
  bool only_options = false;
};

/// The request of the command line: one command, and a file for the picture of a failure.
struct Request {
  std::function<int(const CommandContext&)> execute;
  std::filesystem::path picture;
  bool is_prompt = false;
  bool prints_findings = false;  ///< the command prints the findings on the input as its result, so the log omits them unless it is verbose
};

void add_common_options(CLI::App& app, CommonSettings& common) {
  app.add_option("--threads", common.threads, "number of worker threads; 0 = all threads of the machine. The result does not depend on this number")
      ->check(CLI::Range(0, k_max_threads));
  app.add_option("--seed", common.seed, "seed of random numbers (math.random of scripts)");
  app.add_flag("-q,--quiet", common.console.is_quiet, "no log and no progress, only results, warnings and errors");
  app.add_flag("-v,--verbose", common.console.is_verbose, "write a more detailed log");
  app.add_option("--log", common.console.log_file, "write every log line with its time to this file")->type_name("FILE");
  app.add_flag("--show-options", common.only_options,
               "print the options that mesh, surface, half, union, convert, draw or report would use, as JSON, and stop");
  app.add_option("--dump-dir", common.dump_directory, "folder for VTU pictures of failures; default: beside the output")
      ->type_name("FOLDER")
      ->check(CLI::ExistingDirectory);
}

/// Returns the path of the picture of a failure: beside an output, or in the current folder for an input.
std::filesystem::path picture_path(const CommandRow& row, const CommandLine& line) {
  if (row.name == "pentagrow") return "hybrid.trouble.vtu";
  const std::filesystem::path file = line.word(row.picture);
  if (file.empty()) return {};
  return (row.picture == "output" ? file : file.filename()).string() + ".trouble.vtu";
}

void add_row(CLI::App& app, const CommandRow& row, CommandLine& line, Request& request) {
  if (row.add) return row.add(app, [&request](std::function<int(const CommandContext&)> execute) { request.execute = std::move(execute); });
  CLI::App* command = app.add_subcommand(std::string(row.name), row.summary);
  if (!row.alias.empty()) command->alias(std::string(row.alias));
  add_arguments(*command, row.arguments, line);
  if (!row.footer.empty()) command->footer(row.footer);
  command->final_callback([&, command] {
    complete_line(*command, line);
    request.is_prompt = row.run == nullptr;
    request.execute = [&](const CommandContext& context) { return row.run(line, context); };
    request.picture = picture_path(row, line);
    request.prints_findings = row.prints_findings;
  });
}

int execute_request(const Request& request, const CommonSettings& common) {
  InterruptGuard interrupt;
  Console console(common.console);
  const RunSettings settings{.threads = common.threads,
                             .seed = common.seed,
                             .stop = interrupt.token(),
                             .dump_directory = common.dump_directory,
                             .log =
                                 [&](LogLevel level, std::string_view text) {
                                   const bool is_reported = request.prints_findings && level == LogLevel::info && !common.console.is_verbose;
                                   if (!is_reported) console.log(level, text);
                                 },
                             .progress = [&](const ProgressState& state) { console.progress(state); }};
  if (request.is_prompt)
    return run_prompt({.script = {.script = "prompt", .overrides = {}, .print = [&](std::string_view text) { console.print(text); }, .on_mesh = {}},
                       .run = settings,
                       .history_file = default_history_file()},
                      console, interrupt);
  const RunContext context(settings);
  try {
    return request.execute({console, context, common.only_options, [&](bool is_left) { interrupt.leave_to_work(is_left); }});
  } catch (const OptionsShown& shown) {
    console.print(shown.json);
    return k_exit_success;
  } catch (const Error& error) {
    const std::filesystem::path trouble = common.dump_directory.empty() ? request.picture : common.dump_directory / request.picture.filename();
    console.end_progress();
    console.error(error.what() + draw_trouble(error, trouble));
    return exit_status_of(error.code());
  }
}

/// Returns the names of the commands of the program, or the long options of a command.
std::vector<std::string> command_names(const CLI::App& app) {
  std::vector<std::string> names;
  for (const CLI::App* command : app.get_subcommands({})) {
    names.push_back(command->get_name());
    for (const std::string& alias : command->get_aliases()) names.push_back(alias);
  }
  return names;
}
std::vector<std::string> long_options(const CLI::App& app) {
  std::vector<std::string> names;
  for (const CLI::App* level = &app; level; level = level->get_parent())
    for (const CLI::Option* option : level->get_options())
      for (const std::string& name : option->get_lnames()) names.push_back("--" + name);
  return names;
}

/// Returns the misspelt name in a command line that was refused, with a suggestion; empty if every name is known and the problem is another one.
std::string misspelling(const CLI::App& app, int argc, const char* const* argv) {
  const std::vector<std::string> commands = command_names(app);
  const auto with_suggestion = [](const std::string& what, const std::string& word, const std::vector<std::string>& known) {
    const std::string nearest = nearest_name(word, known);
    return "there is no " + what + " " + word + (nearest.empty() ? "" : ", did you mean " + nearest + "?");
  };
  const CLI::App* command = nullptr;
  for (int i = 1; i < argc; ++i) {
    const std::string word = argv[i];
    if (word == "--") break;
    if (!word.starts_with("--")) {
      if (command || word.starts_with("-")) continue;
      if (std::find(commands.begin(), commands.end(), word) == commands.end()) return with_suggestion("command", word, commands);
      command = app.get_subcommand(word);
      continue;
    }
    const std::string name = word.substr(0, word.find('='));
    const std::vector<std::string> known = long_options(command ? *command : app);
    if (std::find(known.begin(), known.end(), name) == known.end())
      return with_suggestion(command ? "option of " + command->get_name() : "option", name, known);
    const CLI::Option* option = (command ? *command : app).get_option_no_throw(name);
    if (!option) option = app.get_option_no_throw(name);
    if (!command && option && option->get_items_expected_min() > 0 && word.find('=') == std::string::npos)
      ++i;  // the value of an option is not the name of a
            // command
  }
  return {};
}

int parse_and_execute(int argc, const char* const* argv) {
  CLI::App app("sterna: hybrid meshes (prism layers and tetrahedra) around aircraft, for RANS solvers", "sterna");
  app.require_subcommand(1);
  app.fallthrough();
  app.set_version_flag("--version", "sterna " STERNA_VERSION);
  app.footer(k_exit_status_help);
  CommonSettings common;
  std::list<CommandLine> lines;
  Request request;
  add_common_options(app, common);
  for (const CommandRow& row : command_rows()) add_row(app, row, lines.emplace_back(), request);
  // Without arguments and at a terminal the program is a prompt.
  constexpr std::array k_prompt = {"sterna", "prompt"};
  const bool is_alone = argc == 1 && ::isatty(STDIN_FILENO) != 0;
  try {
    if (is_alone) app.parse(static_cast<int>(k_prompt.size()), k_prompt.data());
    else app.parse(argc, argv);
  } catch (const CLI::ParseError& error) {
    if (error.get_exit_code() == 0) return app.exit(error);
    if (const std::string wrong = misspelling(app, argc, argv); !wrong.empty()) {
      std::fprintf(stderr, "error: %s\nRun with --help for more information.\n", wrong.c_str());
      return k_exit_usage;
    }
    app.exit(error);
    return k_exit_usage;
  }
  return execute_request(request, common);
}

}  // namespace

int run_command_line(int argc, const char* const* argv) noexcept {
  // Before the console exists, and for exceptions other than Error, stderr is the only output.
  try {
    std::vector<const char*> arguments(argv, argv + argc);
    if (argc > 0 && std::filesystem::path(argv[0]).filename() == "pentagrow") arguments.insert(arguments.begin() + 1, "pentagrow");
    // `sterna help --auto` requests help on an option; --auto is no option of help.
    if (argc == 3 && std::string_view(argv[1]) == "help" && std::string_view(argv[2]).starts_with("--") && std::string_view(argv[2]) != "--help")
      arguments[2] += 2;
    return parse_and_execute(static_cast<int>(arguments.size()), arguments.data());
  } catch (const Error& error) {
    std::fprintf(stderr, "error: %s\n", error.what());
    return exit_status_of(error.code());
  } catch (const std::bad_alloc&) {  // avoid allocating a string here
    std::fputs("error: not enough memory\n  try: a larger limit (ulimit -v, the job's memory)\n", stderr);
  } catch (const std::exception& error) {
    std::fprintf(stderr, "error: %s\n", Error(foreign_error(error, "sterna")).what());
  }
  return k_exit_failed;
}

}  // namespace sterna::scripting
