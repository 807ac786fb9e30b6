// `sterna doctor`: tests if this installation is complete.
#include <fmt/format.h>
#include <link.h>
#include <sys/utsname.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <sstream>
#include <string>
#include <vector>

#include "geom/base/error.h"
#include "geom/base/machine_memory.h"
#include "io/output/scratch_folder.h"
#include "scripting/cli/commands.h"
#include "scripting/interpreter/script_run.h"
#include "scripting/report/report_page.h"
#include "scripting/terminal/exit_status.h"
#include "scripting/view/view_page.h"
#include "volmesh/tetra/engine_process.h"

namespace sterna::scripting {
namespace {

namespace fs = std::filesystem;

constexpr double k_gigabyte = 1e9;
constexpr double k_bytes_of_cell = 250.0;                     ///< memory per cell in complete runs on a few million cells, with a margin
constexpr double k_little_memory = 2e9, k_little_room = 1e9;  ///< bytes; a warning is given below
constexpr std::array<const char*, 3> k_engines = {"sterna", "hxt", "tetgen"};

enum class Health { good, poor, broken };

struct Finding {
  std::string what;
  Health health = Health::good;
  std::string text;
  std::string remedy;
};

std::string gigabytes(double bytes) { return fmt::format("{:.1f} GB", bytes / k_gigabyte); }

/// Returns the names of the large libraries in this process, with their versions as in their file names.
Finding libraries() {
  std::vector<std::string> names;
  dl_iterate_phdr(
      [](dl_phdr_info* info, std::size_t, void* list) {
        std::error_code failure;
        const std::string name = fs::canonical(info->dlpi_name, failure).filename().string();
        constexpr std::array<const char*, 8> k_reported = {"libTKernel.", "libtbb.", "libcgns.", "libhdf5", "libnetcdf.", "libnlopt.", "liblua", "libgmp."};
        if (!failure && std::ranges::any_of(k_reported, [&](const char* reported) { return name.starts_with(reported); }))
          static_cast<std::vector<std::string>*>(list)->push_back(name);
        return 0;
      },
      &names);
  std::ranges::sort(names);
  std::string text;
  for (const std::string& name : names) text += (text.empty() ? "" : ", ") + name;
  return {.what = "libraries", .text = std::move(text)};
}

Finding processor(const CommandContext& context) {
  Finding finding{.what = "processor", .text = fmt::format("{} threads in use", context.run.threads())};
  if (__builtin_cpu_supports("avx2") && __builtin_cpu_supports("fma") && __builtin_cpu_supports("bmi2")) {
    finding.text += ", x86-64-v3";
    return finding;
  }
  finding.text += ", not x86-64-v3";
  finding.health = Health::poor;
  finding.remedy = "meshes have the same bytes only on x86-64-v3 machines (Haswell and newer)";
  return finding;
}

Finding memory() {
  const double all = static_cast<double>(sysconf(_SC_PHYS_PAGES)) * static_cast<double>(sysconf(_SC_PAGE_SIZE)), free = available_memory();
  Finding finding{.what = "memory",
                  .text = gigabytes(all) + fmt::format(", {} free: about {:.0f} million cells", gigabytes(free), free / k_bytes_of_cell / 1e6)};
  if (free > k_little_memory) return finding;
  finding.health = Health::poor;
  finding.remedy = "a million cells need some hundred MB";
  return finding;
}

Finding temporary_folder() {
  std::error_code failure;
  const fs::path folder = fs::temp_directory_path(failure);
  const fs::space_info space = failure ? fs::space_info{} : fs::space(folder, failure);
  Finding finding{.what = "temporary", .text = folder.string() + ", " + gigabytes(static_cast<double>(space.available)) + " free"};
  if (!failure && access(folder.c_str(), W_OK) == 0 && static_cast<double>(space.available) > k_little_room) return finding;
  finding.health = Health::broken;
  finding.remedy = "engines write files there: set TMPDIR to a writable folder with free space";
  return finding;
}

Finding page() {
  const bool has_report = !report_page().empty(), has_view = !view_page().empty();
  if (has_report && has_view) return {.what = "page", .text = "pages of report{} and sterna view are available"};
  return {.what = "page",
          .health = Health::poor,
          .text = std::string(has_report ? "" : "report{} ") + (has_view ? "" : "sterna view ") + "has no page",
          .remedy = "build where npm can reach its registry"};
}

Finding browser() {
  std::istringstream folders(std::getenv("PATH") ? std::getenv("PATH") : "");
  for (std::string folder; std::getline(folders, folder, ':');)
    if (access((fs::path(folder) / "xdg-open").c_str(), X_OK) == 0) return {.what = "browser", .text = "started by xdg-open"};
  return {.what = "browser", .health = Health::poor, .text = "no xdg-open", .remedy = "sterna view then prints its address only; install xdg-utils"};
}

/// Meshes a box in a sphere. This tests CAD, triangles, layers, tetrahedra, certificate and file.
Finding tiny_mesh(const std::string& engine, const CommandContext& context) {
  const std::string what = "engine " + engine;
  const bool is_needed = engine == k_engines.front();
  try {
    const io::ScratchFolder folder("doctor");
    const fs::path script = folder.path() / "doctor.lua";
    std::ofstream(script) << "local m = volume_mesh{ surface_mesh{ box{ {0, 0, 0}, {1, 1, 1} }, max_edge = 0.4 }, layers = 4, first_height = 0.01,\n"
                             "  farfield = sphere{ radius = 8 }, tetrahedra = { engine = \""
                          << engine << "\", try_other_engine = false } }\nm:check():write(\"" << (folder.path() / "doctor.su2").string() << "\")\nprint(m)\n";
    std::string printed;
    const RunContext quiet({.threads = context.run.threads(), .stop = context.run.stop_token()});
    run_script({.script = script, .print = [&](std::string_view line) { printed = line; }, .on_mesh = {}}, quiet);
    std::string text = printed;
    if (!is_needed) text += ", by " + volmesh::find_helper("sterna-tet-" + engine, {});
    return {.what = what, .text = std::move(text)};
  } catch (const Error& error) {
    if (error.code() == ErrorCode::cancelled) throw;
    return {.what = what,
            .health = is_needed ? Health::broken : Health::poor,
            .text = error.what(),
            .remedy = is_needed ? "this installation cannot mesh: install sterna again"
                                : "used only if sterna's own engine fails; a complete installation includes it"};
  }
}

}  // namespace

int doctor_command(const CommandLine& /*line*/, const CommandContext& context) {
  context.console.print("sterna " STERNA_VERSION ", GPL-3.0-or-later");
  Health worst = Health::good;
  const auto report = [&](const Finding& finding) {
    constexpr std::array<const char*, 3> k_marks = {"ok", "poor", "BROKEN"};
    context.console.print(fmt::format("  {:<14} {:<7} {}{}", finding.what, k_marks[static_cast<std::size_t>(finding.health)], finding.text,
                                      finding.remedy.empty() ? "" : "; " + finding.remedy));
    worst = std::max(worst, finding.health);
  };
  utsname system{};
  uname(&system);
  report({.what = "program", .text = fs::read_symlink("/proc/self/exe").string() + ", " + system.sysname + " " + system.release + " " + system.machine});
  report(libraries());
  report(processor(context));
  report(memory());
  report(temporary_folder());
  report(page());
  report(browser());
  for (const char* engine : k_engines) report(tiny_mesh(engine, context));
  context.console.print(worst == Health::broken ? "This installation cannot mesh: see BROKEN above."
                        : worst == Health::poor ? "This installation can mesh; see poor above for limitations."
                                                : "All tests passed.");
  return worst == Health::broken ? k_exit_failed : k_exit_success;
}

}  // namespace sterna::scripting
