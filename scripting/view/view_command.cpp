#include "scripting/view/view_command.h"

#include <CLI/CLI.hpp>
#include <cstdlib>
#include <optional>

#include "geom/base/child_process.h"
#include "geom/base/error.h"
#include "io/file/format_table.h"
#include "io/output/atomic_file.h"
#include "io/output/scratch_folder.h"
#include "scripting/cache/stage_cache.h"
#include "scripting/command/command_line.h"
#include "scripting/interpreter/script_args.h"
#include "scripting/terminal/exit_status.h"
#include "scripting/values/models.h"
#include "scripting/view/finished_series.h"
#include "scripting/view/lua_quoting.h"
#include "scripting/view/page_server.h"
#include "scripting/view/view_page.h"
#include "scripting/view/view_worker.h"
#include "scripting/view/workbench.h"

namespace sterna::scripting {
namespace {

constexpr int k_last_port = 65535;

struct ViewCommand {
  std::filesystem::path input;
  OptionOverrides arguments;  ///< NAME=VALUE
  OptionOverrides overrides;  ///< --set
  int port = 0;               ///< 0: any free port
  bool is_without_browser = false;
  std::filesystem::path cache;  ///< empty: a cache for this session, removed at its end
  double cache_limit = k_cache_limit;
  bool is_worker = false;  ///< not listed in the help: this process runs scripts for the workbench (view_worker.h)
};

/// Returns a script that reads the file, so that files are shown in the same way as results of scripts.
std::string reading_script(const std::filesystem::path& input) {
  const std::string name = quoted_for_lua(std::filesystem::absolute(input).string());
  if (is_model_file(input)) {
    const std::string extension = input.extension().string();
    return "local model = " + std::string(extension == ".smx" ? "read_smx" : extension == ".xml" ? "read_cpacs" : "read_cad") + "{ " + name + " }\n";
  }
  const std::string as_surface = "read_surface{ " + name + ", allow_open = true }\n";
  if (!io::format_of(input).read_volume) return "local surface = " + as_surface;
  return "local surface\nlocal mesh = read_mesh{ " + name + " }\nif mesh.cells == 0 then\n  mesh = nil\n  surface = " + as_surface + "end\n";
}

void require_input(const std::filesystem::path& input) {
  if (std::filesystem::is_directory(input) && !is_series_folder(input))
    throw Error({.code = ErrorCode::unsupported_format,
                 .attempted = "showing " + input.string(),
                 .problem = "not a series folder: series.json is missing",
                 .hint = "give a file of this folder"});
  if (!std::filesystem::exists(input))
    throw Error({.code = ErrorCode::file_not_found, .attempted = "showing " + input.string(), .problem = "there is no such file"});
}

/// Opens a browser if there is a display; otherwise the printed address suffices.
std::optional<ChildProcess> open_browser(const std::string& address, const CommandContext& context) {
  if (!std::getenv("DISPLAY") && !std::getenv("WAYLAND_DISPLAY")) return std::nullopt;
  try {
    return ChildProcess({.words = {"xdg-open", address}, .descriptors = {}, .output = "/dev/null", .folder = {}});
  } catch (const Error&) {
    context.run.info("no browser could be started (xdg-open): open the address manually");
    return std::nullopt;
  }
}

CLI::App* add_view_arguments(CLI::App& app, ViewCommand& view) {
  CLI::App* command = app.add_subcommand("view", "open the workbench: a page in the browser that shows the results of a script and follows its changes");
  command->add_option("file", view.input, "case.lua; or a file of a model, surface or volume mesh; or the folder of a series that was run")->required();
  command
      ->add_option_function<std::vector<std::string>>(
          "arguments",
          [&view](const std::vector<std::string>& texts) {
            for (const std::string& text : texts) view.arguments.push_back(split_argument(text));
          },
          "arguments that the script reads with args{ alpha = 0 }, e.g. alpha=4 height=2mm half=true")
      ->type_name("NAME=VALUE ...");
  command->add_option("--port", view.port, "port on 127.0.0.1; default: any free port")->check(CLI::Range(1, k_last_port))->type_name("N");
  command->add_flag("--no-browser", view.is_without_browser, "only print the address");
  add_set_option(*command, view.overrides);
  command->add_option("--cache", view.cache, "store results of stages in this folder; default: until the workbench ends")->type_name("FOLDER");
  command
      ->add_option("--cache-limit", view.cache_limit,
                   "largest size of that folder in bytes; when exceeded, the least recently used results are removed; default: 20e9")
      ->check(CLI::PositiveNumber)
      ->type_name("BYTES");
  command->add_flag("--worker", view.is_worker, "")->group("");  // not listed in the help: see view_worker.h
  command->footer("sterna view case.lua span=11 --port 8123. Ctrl-C ends it. From another machine: ssh -L 8123:127.0.0.1:8123 HOST. See docs/view.md.");
  return command;
}

int run_view(const ViewCommand& command, const CommandContext& context) {
  if (command.is_worker) {
    const StageCache cache(CacheSettings{.folder = command.cache, .limit = command.cache_limit});
    return run_view_worker({.script = command.input, .overrides = command.overrides, .cache = &cache}, context);
  }
  if (view_page().empty())
    throw Error({.code = ErrorCode::unsupported_format,
                 .attempted = "sterna view",
                 .problem = "this build has no page: npm was missing, or could not get the page's libraries",
                 .hint = "install npm and run cmake again"});
  require_input(command.input);
  const io::ScratchFolder session("view");
  const bool is_script = command.input.extension() == ".lua";
  const std::filesystem::path script = is_script ? command.input : session.path() / "view.lua";
  SeriesCases series;
  if (std::filesystem::is_directory(command.input)) series = read_series_cases(command.input);
  if (!is_script) io::write_whole(script, series.script.empty() ? reading_script(command.input) : series.script);
  const std::filesystem::path cache = command.cache.empty() ? session.path() / "cache" : command.cache;
  std::vector<std::string> words = {std::filesystem::read_symlink("/proc/self/exe").string(),
                                    "view",
                                    script.string(),
                                    "--worker",
                                    "--quiet",
                                    "--threads=" + std::to_string(context.run.threads()),
                                    "--seed=" + std::to_string(context.run.seed()),
                                    "--cache=" + cache.string(),
                                    "--cache-limit=" + std::to_string(command.cache_limit)};
  for (const auto& [name, value] : command.overrides) words.push_back("--set=" + name + "=" + value);
  Workbench bench({.input = command.input,
                   .script = script,
                   .is_made_script = !is_script,
                   .arguments = command.arguments,
                   .words = std::move(words),
                   .page = view_page(),
                   .cases = std::move(series.json),
                   .pictures = std::move(series.pictures)});
  const PageServer server(command.port, [&](const PageRequest& request) { return bench.answer(request); });
  context.console.print(server.address());
  context.run.info("shows " + command.input.string() + "; press Ctrl-C to end");
  const std::optional<ChildProcess> browser = command.is_without_browser ? std::nullopt : open_browser(server.address(), context);
  if (context.stops_itself) context.stops_itself(true);
  bench.follow(context.run.stop_token());
  return k_exit_success;
}

}  // namespace

void add_view_command(CLI::App& app, const std::function<void(std::function<int(const CommandContext&)>)>& choose) {
  const auto view = std::make_shared<ViewCommand>();
  add_view_arguments(app, *view)->final_callback([view, choose] { choose([view](const CommandContext& context) { return run_view(*view, context); }); });
}

}  // namespace sterna::scripting
