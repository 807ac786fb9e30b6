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

EngineKind engine_of(const TetraOptions& options) {
  if (options.engine == "hxt") return EngineKind::hxt;
  if (options.engine == "tetgen" || options.engine == "automatic") return EngineKind::tetgen;
  throw Error({.code = ErrorCode::bad_argument,
               .attempted = "choosing the tetrahedra engine",
               .problem = "tetrahedra.engine is \"" + options.engine + "\"",
               .hint = "one of automatic, tetgen, hxt"});
}

/// Adds the places where the boundary crosses itself, the usual reason for a failure; or says that there are none.
void blame_boundary(ErrorInfo& error, const TetraBoundary& boundary, const RunContext& context) {
  const CrossingPairs crossings = find_crossings(boundary.points, boundary.triangles, context, k_crossings_kept);
  if (crossings.total == 0) {
    if (error.hint.empty()) error.hint = "the boundary does not cross itself; look for features many orders of magnitude smaller than the farfield";
    return;
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
}

}  // namespace

TetraResult fill(const TetraBoundary& boundary, const TetraOptions& options, const RunContext& context) {
  const EngineKind kind = engine_of(options);
  check_boundary(boundary, context);
  const BoundaryParts parts = find_parts(boundary, context);
  EngineOutcome outcome = run_engine(kind, boundary, parts, options, context);
  if (outcome.result) return std::move(*outcome.result);
  if (outcome.failure.kind == FailureKind::deterministic) blame_boundary(outcome.failure.error, boundary, context);
  throw Error(std::move(outcome.failure.error));
}

}  // namespace sterna::volmesh
