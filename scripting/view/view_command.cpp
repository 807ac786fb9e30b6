#include "scripting/view/view_command.h"

#include <cstdlib>
#include <optional>

#include "geom/base/child_process.h"
#include "geom/base/error.h"
#include "io/file/format_table.h"
#include "io/output/atomic_file.h"
#include "io/output/scratch_folder.h"
#include "scripting/cache/stage_cache.h"
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

}  // namespace

int view_command(const CommandLine& line, const CommandContext& context) {
  const std::filesystem::path input = line.word("file");
  const double cache_limit = line.cache_limit.value_or(k_cache_limit);
  if (line.flag("worker")) {
    const StageCache cache(CacheSettings{.folder = line.cache, .limit = cache_limit});
    return run_view_worker({.script = input, .overrides = line.set, .cache = &cache}, context);
  }
  if (view_page().empty())
    throw Error({.code = ErrorCode::unsupported_format,
                 .attempted = "sterna view",
                 .problem = "this build has no page: npm was missing, or could not get the page's libraries",
                 .hint = "install npm and run cmake again"});
  require_input(input);
  const io::ScratchFolder session("view");
  const bool is_script = input.extension() == ".lua";
  const std::filesystem::path script = is_script ? input : session.path() / "view.lua";
  SeriesCases series;
  if (std::filesystem::is_directory(input)) series = read_series_cases(input);
  if (!is_script) io::write_whole(script, series.script.empty() ? reading_script(input) : series.script);
  const std::filesystem::path cache = line.cache.empty() ? session.path() / "cache" : line.cache;
  std::vector<std::string> words = {std::filesystem::read_symlink("/proc/self/exe").string(),
                                    "view",
                                    script.string(),
                                    "--worker",
                                    "--quiet",
                                    "--threads=" + std::to_string(context.run.threads()),
                                    "--seed=" + std::to_string(context.run.seed()),
                                    "--cache=" + cache.string(),
                                    "--cache-limit=" + std::to_string(cache_limit)};
  for (const auto& [name, value] : line.set) words.push_back("--set=" + name + "=" + value);
  Workbench bench({.input = input,
                   .script = script,
                   .is_made_script = !is_script,
                   .arguments = line.arguments,
                   .words = std::move(words),
                   .page = view_page(),
                   .cases = std::move(series.json),
                   .pictures = std::move(series.pictures)});
  const std::string port = line.word("port");
  const PageServer server(port.empty() ? 0 : std::stoi(port), [&](const PageRequest& request) { return bench.answer(request); });
  context.console.print(server.address());
  context.run.info("shows " + input.string() + "; press Ctrl-C to end");
  const std::optional<ChildProcess> browser = line.flag("no-browser") ? std::nullopt : open_browser(server.address(), context);
  if (context.stops_itself) context.stops_itself(true);
  bench.follow(context.run.stop_token());
  return k_exit_success;
}

}  // namespace sterna::scripting
