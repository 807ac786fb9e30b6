// What a run says of itself: one-paragraph descriptions of surfaces and meshes, the closing summary, and the same as JSON for benchmarks.
#pragma once

#include <filesystem>
#include <string>
#include <string_view>
#include <vector>

#include "scripting/values/verbs.h"

namespace sterna::scripting {

/// "316 204": groups of three digits.
std::string count_text(std::int64_t n);

/// "TriMesh: 316 204 triangles, closed, 7 patches"
std::string describe(const SurfaceValue& surface);
/// One entry of SurfaceValue::changes: "repaired: 3 holes filled; ..."
std::string change_text(std::string_view done, const std::vector<std::string>& messages);
/// "HybridMesh: 248 181 nodes, 383 760 prisms, 131 799 tetrahedra, 3 patches, VALID"
std::string describe(const MeshValue& mesh);

/// Measured by the caller around a whole run; log and statistics only.
struct RunMeasure {
  double wall_seconds = 0.0;  ///< from opening the first input to the last renamed output
  std::vector<StageTime> stages;
  int threads = 0;
};

/// Peak resident memory of this process so far, bytes.
double peak_memory_bytes();

/// "cell-centred: FAIL at 3 places (12 of 3.2 M cells): G9 OF; node-centred: pass", "quality not checked".
std::string quality_text(const CheckReport& report);
/// "FAIL: G9 OF", "pass": the worst state of the gates and which have it.
std::string worst_gates_text(const CheckReport& report);
/// "skew 63.1 deg": the measure that the summary names first and its worst value there; empty where all limits are kept.
std::string worst_quality_text(const CheckReport& report);
/// A dozen lines at most: verdict, sizes, coverage, the worst three measures that miss a limit with their worst place and a remedy. The rest is in `check`, the
/// manifest and the page.
/// \param consumers that the verdict is for
/// \pre mesh.origin
std::string summary_text(const MeshValue& mesh, Consumers consumers = {});
/// "wrote a.su2, a.vtu, each with a manifest beside it (.json)"
std::string wrote_text(const std::vector<std::filesystem::path>& names);
/// What a script's mesh:check() prints, a few lines: verdict, sizes and volume; with `tells_troubles` the worst three measures; violations with their places.
std::string check_summary_text(const CheckReport& report, bool tells_troubles);
/// One line: seconds in the tetrahedra engine and the rest, memory.
/// \pre mesh.origin
std::string measure_text(const MeshValue& mesh, const RunMeasure& measure);
/// One line: seconds of each stage, and how busy the threads were.
std::string stages_text(const RunMeasure& measure);
/// Both as JSON, schema "sterna-stats-1".
/// \pre mesh.origin
std::string stats_json(const MeshValue& mesh, const RunMeasure& measure);

}  // namespace sterna::scripting
