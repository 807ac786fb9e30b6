#include "volmesh/tetra/own_engine.h"

#include <algorithm>
#include <chrono>
#include <cstdio>
#include <utility>

#include "geom/tets/refine.h"
#include "geom/tets/tet_mesh.h"
#include "volmesh/tetra/size_supply.h"
#include "volmesh/tetra/verify.h"

namespace sterna::volmesh {
namespace {

EngineOutcome failed(FailureKind kind, ErrorInfo error) { return {std::nullopt, {kind, std::move(error)}}; }

EngineOutcome no_sizes() {
  return failed(FailureKind::deterministic, {.code = ErrorCode::tetra_engine_failed,
                                             .attempted = "filling the volume with tetrahedra (our own engine)",
                                             .problem = "there is no size field, without which it puts no points into the volume"});
}

/// The first that has an answer; else the first failure that explains something.
EngineOutcome recover_boundary(const EngineInput& input, const TetraOptions& options, const RunContext& context) {
  const StageTimer timer(context, "tetrahedra/recovery");
  const EngineInput recovery{.boundary = input.boundary, .parts = input.parts, .joined = input.joined, .is_recovery_only = true};
  EngineOutcome first = run_engine(EngineKind::hxt, recovery, options, context);
  if (first.result || first.failure.kind == FailureKind::limit) return first;  // no limit of time or memory may decide between engines
  context.warn("recovery of the boundary: " + first.failure.error.attempted + ": " + first.failure.error.problem + "; trying TetGen");
  EngineOutcome second = run_engine(EngineKind::tetgen, recovery, options, context);
  if (second.result) second.result->failures.push_back("recovery of the boundary: " + first.failure.error.problem);
  return second.result || first.failure.kind == FailureKind::missing ? std::move(second) : std::move(first);
}

std::string told(const tets::RefineReport& report, std::size_t n_tets, double recovery_seconds, double seconds) {
  char text[300];
  std::snprintf(text, sizeof text,
                "refinement: %lld points in %d rounds, %zu tetrahedra; %lld larger than wanted; %.0f bytes for each; recovery %.2f s, refinement %.2f s",
                static_cast<long long>(report.n_inserted), report.rounds, n_tets, static_cast<long long>(report.n_left),
                report.bytes / static_cast<double>(std::max<std::size_t>(n_tets, 1)), recovery_seconds, seconds);
  return text;
}

/// The mesh of the boundary with points in the volume.
void refine_result(const EngineInput& input, TetraResult& result, const RunContext& context) {
  const StageTimer timer(context, "tetrahedra/refinement");
  const auto start = std::chrono::steady_clock::now();
  const std::size_t n_boundary = input.boundary.points.size();
  std::vector<Vec3> points(input.boundary.points.begin(), input.boundary.points.end());
  points.insert(points.end(), result.new_points.begin(), result.new_points.end());
  tets::TetMesh mesh = tets::connect(std::move(points), result.tetrahedra, context);
  result.tetrahedra = {};
  const SizeField& field = input.sizes->get();
  const tets::RefineReport report = tets::refine(mesh, static_cast<std::uint32_t>(n_boundary), field, context);
  const double seconds = std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
  context.info(told(report, mesh.nodes.size(), result.engine_seconds, seconds));
  result.new_points.assign(mesh.points.begin() + static_cast<std::ptrdiff_t>(n_boundary), mesh.points.end());
  result.tetrahedra = std::move(mesh.nodes);
  result.engine = to_string(EngineKind::sterna);
  result.engine_seconds += seconds;
  result.engine_peak_bytes = std::max(result.engine_peak_bytes, report.bytes);
}

}  // namespace

EngineOutcome run_own_engine(const EngineInput& input, const TetraOptions& options, const RunContext& context) {
  if (!input.sizes) return no_sizes();
  EngineOutcome outcome = recover_boundary(input, options, context);
  if (!outcome.result) return outcome;
  TetraResult& result = *outcome.result;
  try {
    refine_result(input, result, context);
    if (!is_automatic(options.max_new_points) && static_cast<double>(result.new_points.size()) > options.max_new_points)
      return failed(FailureKind::deterministic, {.code = ErrorCode::tetra_engine_failed,
                                                 .attempted = "filling the volume with tetrahedra (our own engine)",
                                                 .problem = std::to_string(result.new_points.size()) + " new points, limit " +
                                                            std::to_string(static_cast<std::int64_t>(options.max_new_points)),
                                                 .hint = "raise tetrahedra.max_new_points, or ask for larger tetrahedra"});
    const StageTimer timer(context, "tetrahedra/verify");
    verify_tetrahedra(input.boundary, result, context);
  } catch (const Error& error) {
    if (error.code() == ErrorCode::tetra_result_invalid) return failed(FailureKind::deterministic, error.info());
    throw;
  }
  return outcome;
}

}  // namespace sterna::volmesh
