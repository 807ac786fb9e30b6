#include "volmesh/tetra/own_engine.h"

#include <algorithm>
#include <array>
#include <chrono>
#include <condition_variable>
#include <cstdio>
#include <mutex>
#include <optional>
#include <stop_token>
#include <thread>
#include <utility>

#include "geom/tets/recover.h"
#include "geom/tets/refine.h"
#include "geom/tets/tet_mesh.h"
#include "volmesh/tetra/size_supply.h"
#include "volmesh/tetra/verify.h"

namespace sterna::volmesh {
namespace {

// Fractions of the time at the ends of the steps. On a single thread the sizes are made before the recovery and not in parallel with other steps.
constexpr double k_begins = 0.15, k_begins_alone = 0.45, k_recovery = 0.12, k_refinement_ends = 0.97;
/// Expected number of tetrahedra per leaf of the size field, a third more than the mean (docs/tetrahedra.md). Unused capacity costs no memory.
constexpr double k_locations_per_leaf = 40.0;
constexpr double k_most_locations = 5e7;  ///< upper limit of the initial capacity

EngineOutcome failed(FailureKind kind, ErrorInfo error) { return {std::nullopt, {kind, std::move(error)}}; }

EngineOutcome no_sizes() {
  return failed(FailureKind::deterministic, {.code = ErrorCode::tetra_engine_failed,
                                             .attempted = "filling the volume with tetrahedra (built-in engine)",
                                             .problem = "there is no size field, which the built-in engine needs to place points in the volume"});
}

/// Returns the points of the boundary, and the points that the recovery added in the volume.
std::vector<Vec3> all_points(const TetraBoundary& boundary, const TetraResult& result) {
  std::vector<Vec3> points(boundary.points.begin(), boundary.points.end());
  points.insert(points.end(), result.new_points.begin(), result.new_points.end());
  return points;
}

/// Recovers the boundary with sterna's own kernel. If there is no mesh, the reason is logged and added to `failures`.
std::optional<tets::TetMesh> recover_here(const EngineInput& input, std::vector<std::string>& failures, const RunContext& context) {
  const StageTimer timer(context, "tetrahedra/recovery");
  const TetraBoundary& boundary = input.boundary;
  const JoinedBoundary* const joined = input.joined;
  const std::span<const Vec3> points = joined ? std::span<const Vec3>(joined->points) : boundary.points;
  tets::Recovery recovery =
      tets::recover(points, joined ? joined->triangles() : boundary.triangles, joined ? joined->baffles() : std::span<const tets::Facet>(), context);
  const tets::RecoverReport& report = recovery.report;
  if (recovery.mesh.nodes.empty()) {
    const std::vector<Vec3>& locations = recovery.failure.locations;
    failures.push_back("recovery of the boundary: " + recovery.failure.problem + (locations.empty() ? "" : ", the first at " + format_point(locations[0])));
    context.warn(failures.back());
    return std::nullopt;
  }
  context.debug("recovery: " + std::to_string(report.n_missing_edges) + " of " + std::to_string(report.n_edges) + " edges and " +
                std::to_string(report.n_missing_facets) + " of " + std::to_string(report.n_facets) + " triangles were missing, " +
                std::to_string(report.n_points) + " points were added in the volume to recover them");
  if (!joined) return std::move(recovery.mesh);
  TetraResult result;
  result.new_points.assign(recovery.mesh.points.begin() + static_cast<std::ptrdiff_t>(points.size()), recovery.mesh.points.end());
  result.tetrahedra = std::move(recovery.mesh.nodes);
  part_baffles(boundary, *joined, result);
  return tets::connect(all_points(boundary, result), result.tetrahedra, context);
}

/// Recovers the boundary with another engine. Returns the result of the first engine that succeeds, otherwise the first informative failure.
EngineOutcome recover_elsewhere(const EngineInput& input, const TetraOptions& options, const RunContext& context) {
  const StageTimer timer(context, "tetrahedra/recovery");
  const EngineInput recovery{.boundary = input.boundary, .parts = input.parts, .joined = input.joined, .is_recovery_only = true};
  EngineOutcome first = run_engine(EngineKind::hxt, recovery, options, context);
  if (first.result || first.failure.kind == FailureKind::limit) return first;  // time and memory limits must not determine the choice of the engine
  context.warn("recovery of the boundary: " + first.failure.error.attempted + ": " + first.failure.error.problem + "; trying TetGen");
  EngineOutcome second = run_engine(EngineKind::tetgen, recovery, options, context);
  if (second.result) second.result->failures.push_back("recovery of the boundary: " + first.failure.error.problem);
  return second.result || first.failure.kind == FailureKind::missing ? std::move(second) : std::move(first);
}

std::string summary_of(const tets::RefineReport& report, std::size_t n_tets, double recovery_seconds, double seconds) {
  char text[300];
  std::snprintf(text, sizeof text,
                "refinement: %lld points in %d rounds, %zu tetrahedra; %lld larger than the target size, %lld of them flat and long; %.0f bytes for each; "
                "recovery %.2f s, refinement %.2f s",
                static_cast<long long>(report.n_inserted), report.rounds, n_tets, static_cast<long long>(report.n_left), static_cast<long long>(report.n_far),
                report.bytes / static_cast<double>(std::max<std::size_t>(n_tets, 1)), recovery_seconds, seconds);
  return text;
}

/// A context that is also stopped after some time. Without a limit it is the caller's context.
class Deadline {
 public:
  Deadline(double seconds, const RunContext& context) : outer_(context), context_(context) {
    if (is_automatic(seconds)) return;
    context_ = context.beside(context.threads(), source_.get_token());
    clock_ = std::jthread([this, seconds](const std::stop_token& stop) {
      std::mutex mutex;
      std::unique_lock lock(mutex);
      std::condition_variable_any end;
      if (!end.wait_for(lock, stop, std::chrono::duration<double>(seconds), [] { return false; }) && !stop.stop_requested()) source_.request_stop();
    });
  }
  const RunContext& context() const { return context_; }
  /// Returns true if the deadline caused the stop, and not the user.
  bool is_over() const { return source_.stop_requested() && !outer_.stop_token().stop_requested(); }

 private:
  RunContext outer_, context_;
  std::stop_source source_;
  std::jthread clock_;  ///< must be the last member, because it must end before the members that it uses
};

EngineOutcome over_limit(std::string problem, const char* option) {
  return failed(FailureKind::limit, {.code = ErrorCode::tetra_engine_failed,
                                     .attempted = "filling the volume with tetrahedra (built-in engine)",
                                     .problem = std::move(problem),
                                     .hint = std::string("raise tetrahedra.") + option + ", or coarsen the surface"});
}

std::string rounded(double value, const char* unit) {
  std::array<char, 40> text{};
  std::snprintf(text.data(), text.size(), "%.6g %s", value, unit);
  return text.data();
}

double seconds_since(std::chrono::steady_clock::time_point start) { return std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count(); }

/// Refines the mesh of the boundary with points in the volume. Returns false if this would need more than `most_bytes`.
bool refine_mesh(const EngineInput& input, tets::TetMesh mesh, double most_bytes, EngineOutcome& outcome, const RunContext& context) {
  const StageTimer timer(context, "tetrahedra/refinement");
  const auto start = std::chrono::steady_clock::now();
  const std::size_t n_boundary = input.boundary.points.size();
  const SizeField& field = input.sizes->get();
  const double expected = k_locations_per_leaf * static_cast<double>(field.view().header().n_leaves);
  const tets::RefineReport report =
      tets::refine(mesh, static_cast<std::uint32_t>(n_boundary), field, context, most_bytes, static_cast<std::size_t>(std::min(expected, k_most_locations)));
  if (report.is_over_limit) return false;
  TetraResult& result = *outcome.result;
  outcome.stuck_share = static_cast<double>(report.n_far) / static_cast<double>(std::max<std::size_t>(mesh.nodes.size(), 1));
  const double seconds = seconds_since(start);
  context.debug(summary_of(report, mesh.nodes.size(), result.engine_seconds, seconds));
  result.new_points.assign(mesh.points.begin() + static_cast<std::ptrdiff_t>(n_boundary), mesh.points.end());
  result.tetrahedra = std::move(mesh.nodes);
  result.engine = to_string(EngineKind::sterna);
  result.engine_seconds += seconds;
  result.engine_peak_bytes = std::max<double>(result.engine_peak_bytes, report.bytes);
  return true;
}

}  // namespace

EngineOutcome run_own_engine(const EngineInput& input, const TetraOptions& options, const RunContext& context) {
  if (!input.sizes) return no_sizes();
  EngineOutcome outcome;
  std::vector<std::string> failures;
  const Deadline deadline(options.time_limit, context);
  const double begins = context.threads() == 1 ? k_begins_alone : k_begins, refinement_begins = begins + k_recovery;
  try {
    const auto start = std::chrono::steady_clock::now();
    std::optional<tets::TetMesh> mesh = recover_here(input, failures, deadline.context().part("recovery", begins, refinement_begins));
    if (mesh) {
      outcome.result.emplace().engine_seconds = seconds_since(start);
    } else {
      outcome = recover_elsewhere(input, options, deadline.context());
      if (!outcome.result) return outcome;
      mesh = tets::connect(all_points(input.boundary, *outcome.result), outcome.result->tetrahedra, context);
      outcome.result->tetrahedra = {};
    }
    TetraResult& result = *outcome.result;
    result.failures.insert(result.failures.begin(), failures.begin(), failures.end());
    if (!refine_mesh(input, std::move(*mesh), options.memory_limit, outcome, deadline.context().part("refinement", refinement_begins, k_refinement_ends)))
      return over_limit("out of memory: the limit is " + rounded(options.memory_limit / 1e6, "MB"), "memory_limit");
    if (!is_automatic(options.max_new_points) && static_cast<double>(result.new_points.size()) > options.max_new_points)
      return failed(FailureKind::deterministic, {.code = ErrorCode::tetra_engine_failed,
                                                 .attempted = "filling the volume with tetrahedra (built-in engine)",
                                                 .problem = std::to_string(result.new_points.size()) + " new points, limit " +
                                                            std::to_string(static_cast<std::int64_t>(options.max_new_points)),
                                                 .hint = "raise tetrahedra.max_new_points, or request larger tetrahedra"});
    const StageTimer timer(context, "tetrahedra/verify");
    verify_tetrahedra(input.boundary, result, context);
  } catch (const Error& error) {
    if (error.code() == ErrorCode::cancelled && deadline.is_over())
      return over_limit("stopped after the time limit of " + rounded(options.time_limit, "s"), "time_limit");
    if (error.code() == ErrorCode::tetra_result_invalid) return failed(FailureKind::deterministic, error.info());
    throw;
  }
  return outcome;
}

}  // namespace sterna::volmesh
