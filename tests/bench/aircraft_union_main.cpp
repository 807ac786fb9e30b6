// Table of aircraft files: components, result of their union, run time, and changes of area and volume by a STEP export.
// usage: aircraft_union [--threads N] [--verbose] [--step FOLDER] FILE ...   (docs/aircraft_union.md holds its output for tests/data/shared)
#include <algorithm>
#include <chrono>
#include <cmath>
#include <cstdio>
#include <ctime>
#include <filesystem>
#include <fstream>
#include <set>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "geom/cad/aircraft_union.h"
#include "geom/cad/read_cad.h"
#include "geom/cad/write_cad.h"
#include "geom/model/components.h"
#include "geom/model/cpacs.h"
#include "geom/model/model_measures.h"
#include "geom/model/smx.h"

using namespace sterna;

namespace {

struct Settings {
  int threads = 0;
  bool is_verbose = false;
  double tolerance = k_automatic;
  std::filesystem::path step_folder;
};

class Stopwatch {
 public:
  double lap() {
    const auto now = std::chrono::steady_clock::now();
    return std::chrono::duration<double>(now - std::exchange(last_, now)).count();
  }

 private:
  std::chrono::steady_clock::time_point last_ = std::chrono::steady_clock::now();
};

/// CPU time of all threads; unlike the wall clock it excludes waiting on a busy machine.
double cpu_seconds() { return static_cast<double>(std::clock()) / CLOCKS_PER_SEC; }

double relative_change(double before, double after) { return before == after ? 0.0 : std::abs(after - before) / std::abs(before); }

std::string tries_text(const std::vector<UniteTry>& tries) {
  std::string text;
  char number[32];
  for (const UniteTry& one : tries) {
    std::snprintf(number, sizeof number, "%s%.3g", text.empty() ? "" : ", ", one.tolerance);
    text += number;
  }
  return text.empty() ? "-" : text;
}

std::set<std::string> names_of(const Model& model) {
  std::set<std::string> names;
  for (const ModelFace& face : model.faces) names.insert(face.name);
  return names;
}

void print_row(const std::filesystem::path& path, const Settings& settings) {
  Stopwatch watch;
  const std::string file = path.filename().string();
  const RunContext context({.threads = settings.threads, .log = [&](LogLevel level, std::string_view text) {
                              if (settings.is_verbose && level != LogLevel::info)
                                std::printf("    %.*s\n", static_cast<int>(text.size()), text.data()), std::fflush(stdout);
                            }});
  std::size_t n_components = 0, n_faces = 0;
  try {
    const Aircraft aircraft = path.extension() == ".smx" ? read_smx(path, RunContext()).aircraft : read_cpacs(path, RunContext()).aircraft;
    const Model components = make_components(aircraft, context);
    n_components = components.solids.size();
    n_faces = components.faces.size();
    const double load = watch.lap();
    const auto seconds_of = [&](std::string_view stage) {
      double seconds = 0.0;
      for (const StageTime& one : context.times())
        if (one.stage == stage) seconds += one.seconds;
      return seconds;
    };
    const double cpu = cpu_seconds();
    const UniteResult united = cad::unite_aircraft(components, {.tolerance = settings.tolerance}, context);
    const double unite = watch.lap();
    const double unite_cpu = cpu_seconds() - cpu;
    const ModelMeasures before = model_measures(united.model, context);
    const double measure = watch.lap();
    const std::string bytes = cad::cad_bytes(united.model, cad::CadFormat::step, file, {}, context);
    const double write = watch.lap();
    if (!settings.step_folder.empty()) std::ofstream(settings.step_folder / (path.stem().string() + ".step"), std::ios::binary) << bytes;
    const CadFile again = cad::read_cad_bytes(bytes, cad::CadFormat::step, file, {}, context);
    const double read = watch.lap();
    const ModelMeasures after = model_measures(again.model, context);
    const bool same_names = names_of(united.model) == names_of(again.model);
    std::printf(
        "| %s | %zu | %zu | %s | %zu | %zu | %zu | %.8g | %.8g | %s, %zu mended | %.1e | %.1e | %s | %.2f | %.2f (%.2f) | %.2f | %.2f | %.2f | %.2f |\n",
        file.c_str(), n_components, n_faces, tries_text(united.report.tries).c_str(), united.report.n_bodies, united.model.faces.size(),
        united.report.doubts.size(), before.total.area, before.total.volume, again.report.is_closed() ? "closed" : "OPEN", again.report.repaired.size(),
        relative_change(before.total.area, after.total.area), relative_change(before.total.volume, after.total.volume), same_names ? "kept" : "LOST", load,
        unite, unite_cpu, seconds_of("unite/contacts"), measure, write, read);
    if (settings.is_verbose)
      for (const StageTime& stage : context.times()) std::printf("    %6.2f s %s\n", stage.seconds, stage.stage.c_str());
    if (settings.is_verbose)
      for (const ErrorLocation& doubt : united.report.doubts) std::printf("    doubt at %s: %s\n", format_point(doubt.position).c_str(), doubt.what.c_str());
  } catch (const Error& error) {
    std::string text = error.what();
    for (std::size_t at = text.find('\n'); at != std::string::npos; at = text.find('\n')) text.replace(at, 1, ";");
    std::printf("| %s | %zu | %zu | error after %.2f s: %s |\n", file.c_str(), n_components, n_faces, watch.lap(), text.c_str());
  }
  std::fflush(stdout);
}

}  // namespace

int main(int argc, char** argv) {
  Settings settings;
  std::vector<std::filesystem::path> files;
  for (int i = 1; i < argc; ++i) {
    const std::string argument = argv[i];
    if (argument == "--threads" && i + 1 < argc) settings.threads = std::stoi(argv[++i]);
    else if (argument == "--tolerance" && i + 1 < argc) settings.tolerance = std::stod(argv[++i]);
    else if (argument == "--step" && i + 1 < argc) settings.step_folder = argv[++i];
    else if (argument == "--verbose") settings.is_verbose = true;
    else files.emplace_back(argument);
  }
  std::puts(
      "| file | components | faces | tolerances tried, m | bodies | faces of the union | doubts | area, m^2 | volume, m^3 | STEP again | area differs | volume "
      "differs | names | load, s | unite, s (of processors) | contacts of it, s | measure, s | write, s | read, s |");
  std::puts("|---|---|---|---|---|---|---|---|---|---|---|---|---|---|---|---|---|---|---|");
  for (const std::filesystem::path& file : files) print_row(file, settings);
}
