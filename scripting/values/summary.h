// Reports of a run: one-paragraph descriptions of surfaces and meshes, the closing summary, and the summary as JSON for benchmarks.
#pragma once

#include <filesystem>
#include <string>
#include <string_view>
#include <vector>

#include "scripting/values/verbs.h"

namespace sterna::scripting {

/// Returns "316 204": groups of three digits.
std::string count_text(std::int64_t n);

/// Returns "TriMesh: 316 204 triangles, closed, 7 patches".
std::string describe(const SurfaceValue& surface);
/// Returns one entry of SurfaceValue::changes: "repaired: 3 holes filled; ...".
std::string change_text(std::string_view done, const std::vector<std::string>& messages);
/// Returns "HybridMesh: 248 181 nodes, 383 760 prisms, 131 799 tetrahedra, 3 patches, VALID".
std::string describe(const MeshValue& mesh);

/// Measures that the caller takes around a whole run. They are used only for log and statistics.
struct RunMeasure {
  double wall_seconds = 0.0;  ///< from opening the first input to renaming the last output
  std::vector<StageTime> stages;
  int threads = 0;
};

/// Returns the peak resident memory of this process so far, bytes.
double peak_memory_bytes();

/// Returns "cell-centred: FAIL at 3 places (12 of 3.2 M cells): G9 OF; node-centred: pass", "quality not checked".
std::string quality_text(const CheckReport& report);
/// Returns "FAIL: G9 OF" or "pass": the worst state of the gates, and the gates in this state.
std::string worst_gates_text(const CheckReport& report);
/// Returns "skew 63.1 deg": the measure that the summary names first and its worst value for these gates; empty if all limits are met.
std::string worst_quality_text(const CheckReport& report);
/// Returns a dozen lines at most: verdict, sizes, coverage, the worst three measures that miss a limit with their worst location and a remedy. The rest is in
/// `check`, the manifest and the page.
/// \param consumers solvers that the verdict applies to
/// \pre mesh.origin
std::string summary_text(const MeshValue& mesh, Consumers consumers = {});
/// Returns "wrote a.su2, a.vtu, each with a manifest beside it (.json)".
std::string wrote_text(const std::vector<std::filesystem::path>& names);
/// Returns the output of a script's mesh:check() in a few lines: verdict, sizes and volume; with `reports_troubles` also the worst three measures; violations
/// with their locations.
std::string check_summary_text(const CheckReport& report, bool reports_troubles);
/// Returns one line with the seconds in the tetrahedra engine, the other seconds, and the memory.
/// \pre mesh.origin
std::string measure_text(const MeshValue& mesh, const RunMeasure& measure);
/// Returns one line: seconds of each stage, and the utilisation of the threads.
std::string stages_text(const RunMeasure& measure);
/// Returns the report and the measures as JSON, schema "sterna-stats-1".
/// \pre mesh.origin
std::string stats_json(const MeshValue& mesh, const RunMeasure& measure);

}  // namespace sterna::scripting
