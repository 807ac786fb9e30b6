// Table of CAD files: contents, repairs, whether the model is closed, and changes of area and volume by a STEP export.
// usage: cad_table FILE ...   (docs/cad_files.md holds its output for cad.tar.xz of tests/data/shared)
#include <sys/resource.h>

#include <algorithm>
#include <chrono>
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <filesystem>
#include <map>

#include "geom/model/model_measures.h"
#include "io/file/cad_file.h"

using namespace sterna;

namespace {

std::string repaired_text(const CadReport& report) {
  std::map<std::string, int> counts;
  for (const CadRepair& repair : report.repaired) ++counts[repair.what];
  std::string text;
  for (const auto& [what, count] : counts) text += (text.empty() ? "" : "; ") + std::to_string(count) + " x " + what;
  return text.empty() ? "-" : text;
}

/// Returns true if the model is closed once its flat openings are capped.
bool closes_with_caps(const std::filesystem::path& path) {
  ReadCadOptions options;
  options.cap = true;
  return io::read_cad(path, options, RunContext()).report.is_closed();
}

std::string closed_text(const std::filesystem::path& path, const CadReport& report) {
  if (report.is_closed()) return "closed";
  return std::string(closes_with_caps(path) ? "with caps; without: " : "open: ") + std::to_string(report.openings.size()) + " openings of " +
         std::to_string(report.free_edges.size()) + " edges" +
         (report.free_edges.empty() ? "" : ", first at " + format_point(report.free_edges.front().location));
}

/// Peak resident memory of the whole process. Call the program with one file to measure that file alone.
double peak_megabytes() {
  rusage usage{};
  getrusage(RUSAGE_SELF, &usage);
  return static_cast<double>(usage.ru_maxrss) / 1024.0;
}

double relative_change(double before, double after) { return before == after ? 0.0 : std::abs(after - before) / std::abs(before); }

/// Largest relative change of area and volume between the model and its STEP export read back.
double step_change(const CadFile& file, const ModelMeasures& before) {
  const std::string bytes = cad::cad_bytes(file.model, cad::CadFormat::step, "again.step", {}, RunContext());
  const ModelMeasures after = model_measures(cad::read_cad_bytes(bytes, cad::CadFormat::step, "again.step", {}, RunContext()).model, RunContext());
  return std::max(relative_change(before.total.area, after.total.area), relative_change(before.total.volume, after.total.volume));
}

void print_row(const std::filesystem::path& path) {
  const auto start = std::chrono::steady_clock::now();
  try {
    const CadFile file = io::read_cad(path, {}, RunContext());
    const double seconds = std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
    const double megabytes = peak_megabytes();
    const ModelMeasures data = model_measures(file.model, RunContext());
    const CadReport& r = file.report;
    std::printf("| %s | %zu | %zu | %s | %zu / %zu | %s | %s | %zu | %.6g | %.6g | %.0e | %.2f | %.0f |\n", path.filename().c_str(), r.n_faces, r.n_closed,
                r.file_unit.c_str(), r.n_named_parts, r.n_named_faces, repaired_text(r).c_str(), closed_text(path, r).c_str(), r.faults.size(), data.total.area,
                data.total.volume, step_change(file, data), seconds, megabytes);
    if (std::getenv("CAD_TABLE_VERBOSE")) std::printf("%s\n", to_text(r).c_str());
  } catch (const Error& error) {
    std::printf("| %s | error: %s |\n", path.filename().c_str(), error.what());
  }
  std::fflush(stdout);
}

}  // namespace

int main(int argc, char** argv) {
  std::puts("| file | faces | solids | unit | names: parts / faces | mended | closed | faults left | area, m^2 | volume, m^3 | STEP again | seconds | MB |");
  std::puts("|---|---|---|---|---|---|---|---|---|---|---|---|---|");
  for (int i = 1; i < argc; ++i) print_row(argv[i]);
}
