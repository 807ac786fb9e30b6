#include <algorithm>
#include <optional>

#include "geom/base/alongside.h"
#include "geom/base/error.h"
#include "volmesh/tetra/boundary_check.h"
#include "volmesh/tetra/boundary_parts.h"
#include "volmesh/tetra/engine.h"
#include "volmesh/tetra/preflight.h"
#include "volmesh/tetra/tetra.h"

namespace sterna::volmesh {
namespace {

/// The engines in the order in which they are to be tried.
std::vector<EngineKind> rungs_of(const TetraOptions& options) {
  std::vector<EngineKind> rungs = {EngineKind::hxt, EngineKind::tetgen};
  if (options.engine == "tetgen") std::ranges::reverse(rungs);
  else if (options.engine != "hxt" && options.engine != "automatic") {
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

}  // namespace

TetraResult fill(const TetraBoundary& boundary, const SizeField* size_field, const TetraOptions& options, const RunContext& context) {
  const std::vector<EngineKind> rungs = rungs_of(options);
  const BoundaryParts parts = [&] {
    const StageTimer timer(context, "tetrahedra/boundary");
    check_boundary(boundary, context);
    if (!boundary.is_clear) judge(preflight(boundary, {}, context), boundary, context);
    return find_parts(boundary, context);
  }();

  // Of a boundary that is known to be clear, preflight can only say what engines find hard: that can wait until one has run.
  std::optional<Alongside<PreflightReport>> look;
  if (boundary.is_clear) look.emplace(context, [&](const RunContext& side) { return preflight(boundary, {.is_clear = true}, side); });

  std::vector<EngineFailure> failures;
  for (const EngineKind kind : rungs) {
    if (!failures.empty()) context.warn("trying " + std::string(display_name(kind)));
    EngineOutcome outcome = run_engine(kind, {boundary, parts, size_field}, options, context);
    if (look) judge(look->take(), boundary, context);
    look.reset();
    if (outcome.result) {
      for (const EngineFailure& failure : failures) {
        outcome.result->failures.push_back(failure.error.problem);
        outcome.result->is_reproducible &= failure.kind != FailureKind::limit;
      }
      return std::move(*outcome.result);
    }
    failures.push_back(std::move(outcome.failure));
    const EngineFailure& failure = failures.back();
    context.warn(failure.error.attempted + ": " + failure.error.problem);
    if (!may_go_on(failure, options)) break;
  }
  // An engine that is not there explains less than one that failed.
  const auto telling = std::ranges::find_if(failures, [](const EngineFailure& f) { return f.kind != FailureKind::missing; });
  throw Error(telling == failures.end() ? failures.front().error : telling->error);
}

}  // namespace sterna::volmesh
