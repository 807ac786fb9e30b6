#include <algorithm>

#include "geom/base/error.h"
#include "geom/math/intersect.h"
#include "volmesh/tetra/boundary_check.h"
#include "volmesh/tetra/boundary_parts.h"
#include "volmesh/tetra/engine.h"
#include "volmesh/tetra/tetra.h"

namespace sterna::volmesh {
namespace {

constexpr std::size_t k_places_named = 10;
constexpr std::size_t k_crossings_kept = 1000;  ///< pairs of triangles in the geometry of an error

/// The engines in the order in which they are to be tried.
std::vector<EngineKind> rungs_of(const TetraOptions& options) {
  std::vector<EngineKind> rungs = {EngineKind::tetgen, EngineKind::hxt};
  if (options.engine == "hxt") std::ranges::reverse(rungs);
  else if (options.engine != "tetgen" && options.engine != "automatic") {
    throw Error({.code = ErrorCode::bad_argument,
                 .attempted = "choosing the tetrahedra engine",
                 .problem = "tetrahedra.engine is \"" + options.engine + "\"",
                 .hint = "one of automatic, tetgen, hxt"});
  }
  return rungs;
}

/// Whether another engine may follow after this failure.
bool may_go_on(const EngineFailure& failure, const TetraOptions& options) {
  switch (failure.kind) {
    case FailureKind::missing: return options.engine == "automatic";
    case FailureKind::deterministic: return options.try_other_engine;
    case FailureKind::limit: return options.try_other_engine && options.fall_back_on_limits;
  }
  return false;
}

/// Adds the places where the boundary crosses itself, the usual reason for a failure; or says that there are none. True when there are.
bool blame_boundary(ErrorInfo& error, const TetraBoundary& boundary, const RunContext& context) {
  const CrossingPairs crossings = find_crossings(boundary.points, boundary.triangles, context, k_crossings_kept);
  if (crossings.total == 0) {
    if (error.hint.empty()) error.hint = "the boundary does not cross itself; look for features many orders of magnitude smaller than the farfield";
    return false;
  }
  error.problem += "; the boundary crosses itself at " + std::to_string(crossings.total) + " pairs of triangles";
  error.hint = "remove the crossings";
  error.n_places = crossings.total;
  error.places.clear();
  error.geometry = {};
  for (const auto& [a, b] : crossings.pairs) {
    if (error.places.size() < k_places_named) error.places.push_back(place_of_triangle(boundary, a, "crosses " + std::to_string(b)));
    add_triangle(error.geometry, boundary, a);
    add_triangle(error.geometry, boundary, b);
  }
  return true;
}

}  // namespace

TetraResult fill(const TetraBoundary& boundary, const SizeField* size_field, const TetraOptions& options, const RunContext& context) {
  const std::vector<EngineKind> rungs = rungs_of(options);
  check_boundary(boundary, context);
  const BoundaryParts parts = find_parts(boundary, context);

  std::vector<EngineFailure> failures;
  for (const EngineKind kind : rungs) {
    if (!failures.empty()) context.warn("trying " + std::string(display_name(kind)));
    EngineOutcome outcome = run_engine(kind, {boundary, parts, size_field}, options, context);
    if (outcome.result) {
      for (const EngineFailure& failure : failures) {
        outcome.result->failures.push_back(failure.error.problem);
        outcome.result->is_reproducible &= failure.kind != FailureKind::limit;
      }
      return std::move(*outcome.result);
    }
    failures.push_back(std::move(outcome.failure));
    EngineFailure& failure = failures.back();
    context.warn(failure.error.attempted + ": " + failure.error.problem);
    const bool is_boundary_bad = failure.kind == FailureKind::deterministic && blame_boundary(failure.error, boundary, context);
    if (is_boundary_bad || !may_go_on(failure, options)) break;
  }
  // An engine that is not there explains less than one that failed.
  const auto telling = std::ranges::find_if(failures, [](const EngineFailure& f) { return f.kind != FailureKind::missing; });
  throw Error(telling == failures.end() ? failures.front().error : telling->error);
}

}  // namespace sterna::volmesh
