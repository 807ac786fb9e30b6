#include <algorithm>
#include <array>
#include <functional>
#include <optional>

#include "geom/base/alongside.h"
#include "geom/base/error.h"
#include "geom/base/number_text.h"
#include "geom/base/parallel.h"
#include "volmesh/tetra/boundary_check.h"
#include "volmesh/tetra/boundary_parts.h"
#include "volmesh/tetra/engine.h"
#include "volmesh/tetra/preflight.h"
#include "volmesh/tetra/size_supply.h"
#include "volmesh/tetra/tetra.h"
#include "volmesh/tetra/two_pass.h"

namespace sterna::volmesh {

/// One attempt: an engine, and its permission to split triangles.
struct LadderRung {
  EngineKind engine;
  SplitMode splits = SplitMode::none;
  bool is_two_pass = false;
  /// Returns true if the attempt requests splits from the engine. Leftover points are not requested, so they are no reason to skip the attempt.
  bool has_splits() const { return splits == SplitMode::recovery || splits == SplitMode::quality; }
};

namespace {

[[noreturn]] void throw_bad(const std::string& option, const std::string& value, std::string hint) {
  throw Error({.code = ErrorCode::bad_argument,
               .attempted = "choosing the tetrahedra engine",
               .problem = "tetrahedra." + option + " is \"" + value + "\"",
               .hint = std::move(hint)});
}

std::string text_of(const LadderRung& rung) {
  return std::string(display_name(rung.engine)) + (rung.has_splits() ? " with splits of boundary triangles" : "") + (rung.is_two_pass ? " in two passes" : "");
}

/// Corner angle (8 degrees) below which a boundary triangle counts as a sliver. Beside slivers sterna's own engine leaves somewhat more bad tetrahedra than
/// HXT.
constexpr double k_sliver_cosine = 0.990268;  // 8 degrees
/// Largest fraction of slivers for which sterna's own engine is at least as good as HXT (docs/tetrahedra.md).
constexpr double k_most_slivers = 0.02;

/// Limit for the fraction of flat and long tetrahedra on tops of wake sheets. Above it, the result of sterna's own engine is worse than that of HXT.
constexpr double k_most_stuck = 1e-3;

bool is_sliver(const Vec3& a, const Vec3& b, const Vec3& c) {
  const auto has_narrow_corner = [](const Vec3& p, const Vec3& q, const Vec3& r) {
    const Vec3 u = q - p, v = r - p;
    return dot(u, v) > k_sliver_cosine * norm(u) * norm(v);
  };
  return has_narrow_corner(a, b, c) || has_narrow_corner(b, c, a) || has_narrow_corner(c, a, b);
}

/// Returns true if sterna's own engine is tried first when the choice is automatic.
bool is_own_first(const TetraBoundary& boundary, const RunContext& context) {
  const std::size_t n = boundary.triangles.size();
  const auto count = [&](std::size_t begin, std::size_t end) {
    return std::ranges::count_if(boundary.triangles.subspan(begin, end - begin), [&](const std::array<std::uint32_t, 3>& triangle) {
      const auto& [a, b, c] = triangle;
      return is_sliver(boundary.points[a], boundary.points[b], boundary.points[c]);
    });
  };
  const std::ptrdiff_t n_slivers = parallel_reduce(context, n, std::ptrdiff_t{0}, count, std::plus());
  return static_cast<double>(n_slivers) <= k_most_slivers * static_cast<double>(n);
}

/// Returns the attempts in order.
std::vector<LadderRung> rungs_of(const TetraBoundary& boundary, bool has_sizes, const TetraOptions& options, SplitPermission splits,
                                 const RunContext& context) {
  std::vector<LadderRung> rungs = {{EngineKind::hxt}, {EngineKind::tetgen}};
  if (options.engine == "tetgen") std::ranges::reverse(rungs);
  else if (options.engine == "sterna") rungs.insert(rungs.begin(), {EngineKind::sterna});
  else if (options.engine == "automatic" && has_sizes) rungs.insert(is_own_first(boundary, context) ? rungs.begin() : rungs.end(), {EngineKind::sterna});
  else if (options.engine != "hxt" && options.engine != "automatic") throw_bad("engine", options.engine, "use one of automatic, sterna, tetgen, hxt");
  if (options.two_pass) {
    if (options.engine == "hxt" || options.engine == "sterna")
      throw_bad("two_pass", "true\" with engine \"" + options.engine, "only TetGen has two passes: set engine = \"automatic\" or \"tetgen\"");
    rungs = {{EngineKind::tetgen, SplitMode::none, true}, {EngineKind::hxt}};
  }
  if (boundary.traits.has_baffles && options.boundary_splits == "always")
    throw_bad("boundary_splits", "always", "triangles beside baffles (actuator discs) cannot be split");
  if (options.boundary_splits == "always") {
    if (options.engine == "hxt" || options.engine == "sterna")
      throw_bad(
          "boundary_splits", "always",
          (options.engine == "hxt" ? "HXT" : "the built-in engine") + std::string(" cannot split the boundary: set engine = \"automatic\" or \"tetgen\""));
    if (splits == SplitPermission::never)
      throw_bad("boundary_splits", "always",
                "the boundary cannot be split if walls end on other patches, sides are periodic, ridges are opened or there are wake sheets: set "
                "boundary_splits = \"ladder\"");
    return {{EngineKind::tetgen, SplitMode::quality, options.two_pass}, {EngineKind::hxt}};
  }
  if (options.boundary_splits == "ladder") {
    if (splits == SplitPermission::permitted) {
      for (LadderRung& rung : rungs)
        if (rung.engine == EngineKind::tetgen && !rung.is_two_pass) rung.splits = SplitMode::leftovers;
      rungs.push_back({EngineKind::tetgen, SplitMode::recovery});
    }
  } else if (options.boundary_splits != "never") {
    throw_bad("boundary_splits", options.boundary_splits, "use one of never, ladder, always");
  }
  return rungs;
}

/// Returns true if this attempt may follow after these failures. The last failure of an available engine decides this. If an engine exceeded its time, there is
/// no time left for splits: then only the other engine is tried, unless fall_back_on_limits is set.
bool may_follow(const LadderRung& rung, const std::vector<EngineFailure>& failures, const TetraOptions& options) {
  const auto last = std::find_if(failures.rbegin(), failures.rend(), [](const EngineFailure& f) { return f.kind != FailureKind::missing; });
  if (last == failures.rend()) return !rung.has_splits() && options.engine == "automatic";
  const bool is_over = last->kind == FailureKind::limit && !options.fall_back_on_limits;
  if (rung.has_splits()) return !is_over;
  return options.try_other_engine && (!is_over || last->is_own_limit);
}

/// Runs an engine once or twice.
EngineOutcome run(const LadderRung& rung, const TetraBoundary& boundary, const JoinedBoundary* joined, const BoundaryParts& parts, SizeSupply* sizes,
                  const TetraOptions& options, const RunContext& context) {
  if (!rung.is_two_pass) return run_engine(rung.engine, {boundary, parts, sizes, rung.splits, joined}, options, context);
  TetraOptions coarse = options;
  coarse.radius_edge = std::max(options.radius_edge, k_coarse_radius_edge);
  EngineOutcome first = run_engine(rung.engine, {.boundary = boundary, .parts = parts, .joined = joined}, coarse, context);
  if (!first.result) return first;
  context.info("first pass: " + std::to_string(first.result->tetrahedra.size()) + " tetrahedra");
  const SizeSource samples = nodal_sizes(boundary, *first.result, context);
  if (samples.points.empty())
    // There are no nodes in the volume from which sizes could be taken.
    return run_engine(rung.engine, {boundary, parts, sizes, rung.splits, joined}, options, context);
  const SizeField field = sizes ? sizes->with(samples, boundary, context) : build_size_field(boundary, std::span(&samples, 1), {}, context);
  SizeSupply second_sizes(field);
  EngineOutcome second = run_engine(rung.engine, {boundary, parts, &second_sizes, rung.splits, joined}, options, context);
  if (!second.result) return second;
  second.result->is_two_pass = true;
  second.result->engine_seconds += first.result->engine_seconds;
  second.result->engine_peak_bytes = std::max(second.result->engine_peak_bytes, first.result->engine_peak_bytes);
  return second;
}

/// Adds the result of each attempt, and the remedy, to the error.
void report_all(const std::vector<EngineFailure>& failures, ErrorInfo& error) {
  error.attempted = "filling the volume with tetrahedra";
  error.problem = "all engines failed";
  for (const EngineFailure& failure : failures) error.problem += "; " + failure.error.attempted + ": " + failure.error.problem;
  error.hint =
      "re-mesh the surface where triangles are slivers, folded or close to other triangles (`sterna inspect` lists them), use fewer and lower layers, or set a "
      "larger tetrahedra.time_limit (seconds)";
}

/// Checks the boundary for the engines, and finds its parts. \throws Error for a boundary that is not closed, not manifold or intersects itself
BoundaryParts checked_parts(const TetraBoundary& boundary, const std::optional<JoinedBoundary>& joined, PreflightReport& seen, const RunContext& context) {
  const StageTimer timer(context, "tetrahedra/boundary");
  const TetraBoundary closed =
      joined ? TetraBoundary{.points = joined->points, .triangles = joined->triangles(), .hole_points = boundary.hole_points} : boundary;
  const auto baffles = joined ? joined->baffles() : std::span<const std::array<std::uint32_t, 3>>();
  check_boundary(closed, context, baffles);
  if (!boundary.clear.is_given()) judge(seen = preflight(boundary, {}, context), boundary, context);
  return find_parts(boundary, joined ? &*joined : nullptr, context);
}

}  // namespace

struct TetraLadder::State {
  State(const TetraBoundary& of, SizeSupply* size_supply, const TetraOptions& tetra_options, SplitPermission splits, const RunContext& run_context)
      : boundary(of),
        sizes(size_supply),
        options(tetra_options),
        context(run_context),
        rungs(rungs_of(of, size_supply != nullptr, tetra_options, splits, run_context)),
        joined(of.traits.has_baffles ? std::optional(join_baffles(of, run_context)) : std::nullopt),
        parts(checked_parts(of, joined, seen, run_context)) {
    // If the boundary is proved to be clear, the preflight check only reports what is difficult for engines. It can run in parallel with the first engine.
    if (!boundary.clear.is_given()) return;
    look.emplace(context, [this](const RunContext& side) {
      if (sizes) sizes->wait();  // the check waits, because the engine needs the sizes sooner
      return preflight(boundary, {.searches_crossings = false}, side);
    });
  }

  TetraResult next() {
    for (; next_rung < rungs.size(); ++next_rung) {
      const LadderRung& rung = rungs[next_rung];
      if (!failures.empty()) {
        if (!may_follow(rung, failures, options)) continue;
        context.warn("trying " + text_of(rung));
      }
      EngineOutcome outcome = run(rung, boundary, joined ? &*joined : nullptr, parts, sizes, options, context);
      if (look) judge(seen = std::move(*look).take(), boundary, context);
      look.reset();
      if (!outcome.result) {
        add(std::move(outcome.failure));
        if (!second_best) continue;
        context.warn("using the tetrahedra of the built-in engine unchanged");
        return taken(std::move(*second_best));
      }
      if (is_stuck(rung, outcome)) {
        add(stuck(outcome.stuck_share));
        second_best = std::move(*outcome.result);
        continue;
      }
      return taken(std::move(*outcome.result));
    }
    throw_failures();
  }

  /// Returns the result, with the failures of the attempts before it.
  TetraResult taken(TetraResult result) {
    ++next_rung;
    second_best.reset();
    for (const EngineFailure& failure : failures) {
      result.failures.push_back(failure.error.problem);
      result.is_reproducible &= failure.kind != FailureKind::limit;
    }
    return result;
  }

  /// Returns true if another engine should be tried although there is a result, because refinement got stuck.
  bool is_stuck(const LadderRung& rung, const EngineOutcome& outcome) const {
    return rung.engine == EngineKind::sterna && boundary.traits.has_wakes && outcome.stuck_share > k_most_stuck && options.engine == "automatic" &&
           options.try_other_engine && next_rung + 1 < rungs.size();
  }

  static EngineFailure stuck(double share) {
    return {FailureKind::deterministic,
            {.code = ErrorCode::tetra_engine_failed,
             .attempted = "filling the volume with tetrahedra (built-in engine)",
             .problem = "refinement stopped early on the tops of wake sheets: " + number_text(100.0 * share, 2) +
                        " % of the tetrahedra are flat and cover many triangles, limit " + number_text(100.0 * k_most_stuck, 2) + " %"}};
  }

  void add(EngineFailure failure) {
    failures.push_back(std::move(failure));
    context.warn(failures.back().error.attempted + ": " + failures.back().error.problem);
  }

  [[noreturn]] void throw_failures() const {
    // An engine that failed gives more information than an engine that is missing.
    const auto telling = std::ranges::find_if(failures, [](const EngineFailure& f) { return f.kind != FailureKind::missing; });
    std::vector<std::string> problems;
    for (const EngineFailure& failure : failures) problems.push_back(failure.error.problem);
    const bool is_repeatable = telling != failures.end() && std::ranges::none_of(failures, [](const EngineFailure& f) { return f.kind == FailureKind::limit; });
    ErrorInfo error = telling == failures.end() ? failures.front().error : telling->error;
    const bool has_no_end = std::ranges::any_of(failures, &EngineFailure::is_own_limit);
    if (is_repeatable || has_no_end) add_suspects(seen, boundary, error);
    if (has_no_end) report_all(failures, error);
    throw FillError(std::move(error), is_repeatable, std::move(problems));
  }

  const TetraBoundary boundary;
  SizeSupply* sizes;
  const TetraOptions options;
  RunContext context;
  std::vector<LadderRung> rungs;
  std::size_t next_rung = 0;
  PreflightReport seen;
  std::optional<JoinedBoundary> joined;  // joined boundary: for the engines the two sides of a sheet are one
  BoundaryParts parts;
  std::optional<Alongside<PreflightReport>> look;
  std::vector<EngineFailure> failures;
  std::optional<TetraResult> second_best;  ///< a valid result whose refinement got stuck; it is kept until another engine has a result
};

TetraLadder::TetraLadder(const TetraBoundary& boundary, SizeSupply* sizes, const TetraOptions& options, SplitPermission splits, const RunContext& context)
    : state_(std::make_unique<State>(boundary, sizes, options, splits, context)) {}
TetraLadder::~TetraLadder() = default;

ClearProof TetraLadder::proof() const { return state_->boundary.clear.is_given() ? state_->boundary.clear : state_->seen.clear; }
bool TetraLadder::begins_here() const { return state_->rungs.front().engine == EngineKind::sterna; }
TetraResult TetraLadder::next() { return state_->next(); }

void TetraLadder::reject(const Error& reason) {
  if (reason.code() == ErrorCode::cancelled) throw reason;
  state_->add({FailureKind::deterministic, reason.info()});
}

TetraResult fill(const TetraBoundary& boundary, SizeSupply& sizes, const TetraOptions& options, const RunContext& context) {
  return TetraLadder(boundary, &sizes, options, SplitPermission::never, context).next();
}

TetraResult fill(const TetraBoundary& boundary, const SizeField* size_field, const TetraOptions& options, const RunContext& context) {
  if (!size_field) return TetraLadder(boundary, nullptr, options, SplitPermission::never, context).next();
  SizeSupply sizes(*size_field);
  return fill(boundary, sizes, options, context);
}

}  // namespace sterna::volmesh
