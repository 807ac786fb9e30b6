// Steps of the driver after the tetrahedra: improvement, joining and proof.
#include <algorithm>
#include <string>
#include <utility>
#include <vector>

#include "geom/base/error.h"
#include "geom/base/number_text.h"
#include "geom/base/sort_unique.h"
#include "geom/mesh/check_moved.h"
#include "volmesh/layer/slide_lines.h"
#include "volmesh/run_steps.h"

namespace sterna::volmesh {
namespace {

constexpr int k_slide_rounds = 4;
constexpr double k_slides_begin = 0.75;  ///< fraction of the time

/// Improves tetrahedra within the boundary; \p report is that of the improvement that has already run. Then, where the boundary is the cause of bad tetrahedra,
/// ends of growth lines move, and the tetrahedra around them are improved again. \p slid receives these growth lines, ascending.
void slide_and_improve(HybridMesh& layers, FillBoundary& boundary, TetraResult& tets, const ImproveOptions& options, ImproveReport& report,
                       std::vector<std::uint32_t>& slid, const RunContext& context) {
  if (options.improve_rounds == 0 || options.slide_share == 0.0) return;
  LineSlider slider(layers, boundary, options, context);
  for (int round = 0; round < k_slide_rounds; ++round) {
    const std::vector<std::uint32_t> moved = slider.slide(tets);
    if (moved.empty()) break;
    slid.insert(slid.end(), moved.begin(), moved.end());
    if (round + 1 < k_slide_rounds)
      improve_around(improvement_boundary(boundary), moved, tets, options, report,
                     context.part("slides", k_slides_begin + (1.0 - k_slides_begin) * round / k_slide_rounds, 1.0));  // slides come last in this step
  }
  if (slider.n_moved() > 0) report_remaining(improvement_boundary(boundary), tets, options, report, context);
  sort_unique(slid);
  report.n_slid = static_cast<std::int64_t>(slid.size());
}

/// Merges patches of the same name and kind. They are parts of a patch that was split at its corners (split_at_corners).
void merge_equal_patches(HybridMesh& mesh) {
  Column<PatchId, Patch> patches;
  Column<PatchId, PatchId> merged;
  for (const Patch& patch : mesh.patches) {
    const auto same = std::find(patches.begin(), patches.end(), patch);
    merged.push_back(same == patches.end() ? patches.push_back(patch) : PatchId(static_cast<std::uint64_t>(same - patches.begin())));
  }
  if (patches.size() == mesh.patches.size()) return;
  mesh.patches = std::move(patches);
  for (sterna::BoundaryTriangle& face : mesh.boundary_triangles) face.patch = merged[face.patch];
  for (sterna::BoundaryQuad& face : mesh.boundary_quads) face.patch = merged[face.patch];
  for (PeriodicSides& sides : mesh.periodic) {
    sides.first = merged[sides.first];
    sides.second = merged[sides.second];
  }
}

void require_valid(const CheckReport& report) {
  if (report.is_valid()) return;
  const bool is_rounding_alone = std::ranges::all_of(report.counts, [](const auto& of_kind) {
    return of_kind.first == Violation::cell_within_rounding || of_kind.first == Violation::sub_volume_within_rounding;
  });
  ErrorInfo info{.code = ErrorCode::mesh_invalid,
                 .attempted = "checking the finished mesh",
                 .hint = is_rounding_alone ? "these cells are too flat for solvers in double precision: remesh the wall there without sliver triangles, or "
                                             "move the model towards the origin if it is far from it"
                                           : "report this surface"};
  for (const auto& [violation, count] : report.counts) {
    info.problem += (info.problem.empty() ? "" : ", ") + std::to_string(count) + " x " + std::string(to_string(violation));
    info.n_locations += count;
  }
  for (const CheckFinding& finding : report.findings) info.locations.push_back({finding.position, finding.what});
  throw Error(std::move(info));
}

/// Begins the result with the layer, and with what is known of it.
void begin_result(MeshRun& run) {
  LayerKnowledge& knowledge = run.knowledge;
  VolumeMeshResult& result = run.result;
  result.mesh = std::move(knowledge.closed ? *knowledge.closed : run.filled.layers);
  result.layer = std::move(knowledge.report);
  result.certificate = knowledge.certificate;
  result.tetra_failures = std::move(run.filled.tetra_failures);
  result.n_split_triangles = run.filled.n_split_triangles;
  result.slivers = run.filled.slivers;
  run.boundary = knowledge.closed ? std::move(knowledge.boundary) : boundary_of(result.mesh);
}

}  // namespace

void improvement_step(MeshRun& run, const RunContext& context) {
  begin_result(run);
  const StageTimer timer(context, "improve");
  const RunContext part = part_of_run(RunStep::improvement, context);
  const ImproveOptions& options = run.options->improve;
  VolumeMeshResult& result = run.result;
  TetraResult& tets = run.filled.tets;
  result.improvement = improve_tetrahedra(improvement_boundary(run.boundary), tets, options, part.part("tetrahedra", 0.0, k_slides_begin));
  if (run.knowledge.second && options.improve_rounds > 0)
    result.tetra_choice = choose_engine(run.boundary, *run.knowledge.second, options, result.tetra_failures, tets, result.improvement, part);
  slide_and_improve(result.mesh, run.boundary, tets, options, result.improvement, run.slid, part);
  result.tetra_engine = tets.engine + (tets.is_two_pass ? " in two passes" : "");
  result.is_reproducible = tets.is_reproducible;
  result.tetra_engine_seconds = tets.engine_seconds;
  result.tetra_engine_peak_bytes = tets.engine_peak_bytes;
}

void joining_step(MeshRun& run, const RunContext& context) {
  if (!run.slid.empty()) {
    const StageTimer timer(context, "check");
    run.knowledge.check = check_moved_lines(*run.knowledge.check, run.result.mesh, run.slid, {}, context);
  }
  const StageTimer timer(context, "assemble");
  add_tetrahedra(run.boundary, run.filled.tets, run.result.mesh, context);
}

void proof_step(MeshRun& run, const RunContext& context) {
  VolumeMeshResult& result = run.result;
  {
    const StageTimer timer(context, "check");
    result.check = check(result.mesh, {}, part_of_run(RunStep::proof, context), &*run.knowledge.check);
  }
  require_valid(result.check);
  merge_equal_patches(result.mesh);
  for (const PeriodicMatchReport& sides : result.check.periodic)
    context.info("periodic sides " + sides.first + " and " + sides.second + ": " + std::to_string(sides.n_nodes) + " nodes and " +
                 std::to_string(sides.n_faces) + " faces match within " + number_text(sides.worst, 3) + " m");
}

}  // namespace sterna::volmesh
