#include "volmesh/tetra/engine.h"

#include <sys/wait.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <csignal>
#include <cstdio>
#include <cstring>

#include "geom/base/parallel.h"
#include "volmesh/tetra/boundary_check.h"
#include "volmesh/tetra/boundary_splits.h"
#include "volmesh/tetra/engine_process.h"
#include "volmesh/tetra/own_engine.h"
#include "volmesh/tetra/size_supply.h"
#include "volmesh/tetra/verify.h"
#include "volmesh/tetra/wire.h"

namespace sterna::volmesh {
namespace {

/// Returns the power of two that scales the largest coordinate into [1, 2).
double unit_scale(std::span<const Vec3> points) {
  double largest = 0.0;
  for (const Vec3& p : points) largest = std::max({largest, std::abs(p.x), std::abs(p.y), std::abs(p.z)});
  return std::ldexp(1.0, -std::ilogb(largest));
}

// Default limit of an engine's computing time. The slowest runs of docs/tetrahedra.md made 67 000 tetrahedra in a second. Long, thin triangles cost 25 s more,
// whatever their number. A run that takes seven times as long is treated as endless.
constexpr double k_least_seconds = 60.0;
constexpr double k_seconds_per_tetrahedron = 1e-4;
/// Ratio of tetrahedra to triangles on clean surfaces. The tetrahedra that sources require are estimated from the size field.
constexpr double k_tetrahedra_per_triangle = 10.0;
/// Ratio of tetrahedra to leaves of the size field (docs/tetrahedra.md).
constexpr double k_tetrahedra_per_leaf = 30.0;
/// With splits for quality the number of triangles increases by up to about this factor.
constexpr double k_splits_factor = 10.0;

/// Points and facets in the form in which they are sent to the engine.
struct Sent {
  explicit Sent(const EngineInput& input)
      : points(input.joined ? std::span<const Vec3>(input.joined->points) : input.boundary.points),
        facets(input.joined ? std::span<const std::array<std::uint32_t, 3>>(input.joined->facets) : input.boundary.triangles) {}
  std::span<const Vec3> points;
  std::span<const std::array<std::uint32_t, 3>> facets;
};

/// The request in shared memory, with the layout of wire.h.
class Request {
 public:
  Request(const EngineInput& input, const TetraOptions& options, const RunContext& context)
      : scale_(unit_scale(input.boundary.points)), block_("sterna tetra request", size_of(input), engine_task()) {
    const Sent sent(input);
    const BoundaryParts& parts = input.parts;
    const std::span<const Vec3> hole_points = input.boundary.hole_points;
    wire::RequestHeader header;
    header.is_recovery_only = input.is_recovery_only ? 1 : 0;
    n_points_ = header.n_points = sent.points.size();
    header.n_holes = hole_points.size();
    header.n_triangles = sent.facets.size();
    header.n_surfaces = parts.n_surfaces();
    header.n_baffle_surfaces = parts.n_baffle_surfaces;
    header.has_size_field = input.sizes ? 1 : 0;
    header.memory_limit = static_cast<std::uint64_t>(options.memory_limit);
    header.scale = scale_;
    header.radius_edge = options.radius_edge;
    header.improve_below = options.hxt_improve_below;
    if (is_automatic(options.time_limit)) {
      const double factor = input.splits == SplitMode::quality ? k_splits_factor : 1.0;
      header.processor_seconds = factor * (k_least_seconds + k_seconds_per_tetrahedron * k_tetrahedra_per_triangle * static_cast<double>(header.n_triangles));
      header.seconds_per_leaf = factor * k_seconds_per_tetrahedron * k_tetrahedra_per_leaf;
    }
    header.splits = input.splits;
    std::byte* at = block_.map();
    const auto put = [&](const void* data, std::size_t size) {
      if (size > 0) std::memcpy(at, data, size);
      at += size;
    };
    put(&header, sizeof header);
    points_ = reinterpret_cast<Vec3*>(at);
    Vec3* const holes = points_ + header.n_points;
    parallel_for(context, header.n_points, [&](std::size_t i) { points_[i] = scale_ * sent.points[i]; });
    for (std::size_t i = 0; i < header.n_holes; ++i) holes[i] = scale_ * hole_points[i];
    at = reinterpret_cast<std::byte*>(holes + header.n_holes);
    put(sent.facets.data(), sent.facets.size_bytes());
    put(parts.triangle2surface.data(), sizeof(std::int32_t) * parts.triangle2surface.size());
    put(parts.surface2region.data(), sizeof(std::int32_t) * parts.surface2region.size());
    put(parts.surface2second.data(), sizeof(std::int32_t) * parts.surface2second.size());
  }
  const SharedBlock& block() const { return block_; }
  std::span<const Vec3> points() const { return {points_, n_points_}; }  ///< points in the form that the engine receives
  double scale() const { return scale_; }

 private:
  static std::size_t size_of(const EngineInput& input) {
    const Sent sent(input);
    return sizeof(wire::RequestHeader) + sizeof(Vec3) * (sent.points.size() + input.boundary.hole_points.size()) +
           (sizeof(sent.facets[0]) + sizeof(std::int32_t)) * sent.facets.size() + 2 * sizeof(std::int32_t) * input.parts.n_surfaces();
  }
  double scale_;
  SharedBlock block_;
  Vec3* points_ = nullptr;
  std::size_t n_points_ = 0;
};

/// Returns the name of a TetGen error code, as in terminatetetgen() of tetgen.h. The other engines have no codes.
std::string text_of_code(EngineKind kind, int code) {
  if (kind != EngineKind::tetgen) return "failed";
  const std::string number = " (code " + std::to_string(code) + ")";
  switch (code) {
    case 2: return "stopped with an internal error" + number;
    case 3: return "found that the boundary intersects itself" + number;
    case 4: return "found a feature that is too small" + number;
    case 5: return "found two facets that are too close to each other" + number;
    case 10: return "rejected its input" + number;
    default: return "failed" + number;
  }
}

std::string with_unit(double value, const char* unit) {
  std::array<char, 40> text{};
  std::snprintf(text.data(), text.size(), "%.6g %s", value, unit);
  return text.data();
}
std::string megabytes(double bytes) { return with_unit(std::round(bytes / 1e6), "MB"); }

std::string attempt(EngineKind kind) { return "filling the volume with tetrahedra (" + std::string(display_name(kind)) + ")"; }

constexpr const char* k_hint = "the boundary has no self-intersections; search for features many orders of magnitude smaller than the farfield";

EngineFailure failure(FailureKind failure_kind, EngineKind kind, std::string problem, std::string hint = k_hint) {
  return {failure_kind, {.code = ErrorCode::tetra_engine_failed, .attempted = attempt(kind), .problem = std::move(problem), .hint = std::move(hint)}};
}

/// Returns the reason why a helper process returned no mesh; nothing if it returned one.
std::optional<EngineFailure> judge_exit(EngineKind kind, const HelperExit& exit, const wire::ReplyHeader& header, const TetraOptions& options) {
  const bool is_reply = header.magic == wire::k_reply_magic;
  if (exit.is_success() && is_reply && header.outcome == wire::Outcome::ok) return std::nullopt;
  if (exit.is_time_over) {
    return failure(FailureKind::limit, kind, "stopped after the time limit of " + with_unit(options.time_limit, "s"),
                   "raise tetrahedra.time_limit, or coarsen the surface");
  }
  if (is_reply && header.outcome == wire::Outcome::out_of_time) {
    EngineFailure over =
        failure(FailureKind::limit, kind,
                "stopped after " + with_unit(header.engine_seconds, "s") + " of processor time, several times the usual time for a boundary of this size",
                "re-mesh the surface where triangles are slivers or folded; or set a larger tetrahedra.time_limit (seconds)");
    over.is_own_limit = true;
    return over;
  }
  if (is_reply && header.outcome == wire::Outcome::out_of_memory) {
    return failure(FailureKind::limit, kind,
                   "out of memory: the limit of the helper is " + megabytes(options.memory_limit) + ", its use was " + megabytes(header.peak_bytes),
                   "raise tetrahedra.memory_limit, or coarsen the surface");
  }
  const std::string name(display_name(kind));
  if (WIFSIGNALED(exit.wait_status)) {
    const int signal = WTERMSIG(exit.wait_status);
    const std::string problem = "the helper died of signal " + std::to_string(signal) + " (" + strsignal(signal) + ")" + last_words(exit);
    if (signal == SIGKILL) return failure(FailureKind::limit, kind, problem, "the helper was killed, perhaps by the system for lack of memory");
    return failure(FailureKind::deterministic, kind, problem);
  }
  if (is_reply && header.outcome == wire::Outcome::engine_code) {
    return failure(FailureKind::deterministic, kind, name + " " + text_of_code(kind, header.engine_code) + last_words(exit));
  }
  return failure(FailureKind::deterministic, kind,
                 "the helper returned no result, exit status " + std::to_string(WEXITSTATUS(exit.wait_status)) + last_words(exit),
                 "the helper may have another version: build the target sterna-tet-" + std::string(to_string(kind)) + " again");
}

/// Returns a failure for a mesh with more points than the user allows.
std::optional<EngineFailure> judge_count(EngineKind kind, const wire::ReplyHeader& header, const Request& request, const TetraOptions& options) {
  const double n_new = static_cast<double>(header.n_points) - static_cast<double>(request.points().size());
  if (is_automatic(options.max_new_points) || n_new <= options.max_new_points) return std::nullopt;
  return failure(FailureKind::deterministic, kind, with_unit(n_new, "new points") + ", limit " + with_unit(options.max_new_points, ""),
                 "raise tetrahedra.max_new_points, or request larger tetrahedra");
}

[[noreturn]] void throw_invalid_reply(EngineKind kind, std::string problem, std::vector<ErrorLocation> locations = {}) {
  throw Error({.code = ErrorCode::tetra_result_invalid,
               .attempted = "reading the result of " + std::string(display_name(kind)),
               .problem = std::move(problem),
               .locations = std::move(locations)});
}

/// Stores the splits. Boundary points come directly after the input's boundary points, in the engine's order. Points in the volume follow.
void adopt_splits(const TetraBoundary& boundary, std::span<const std::array<std::uint32_t, 3>> triangles, std::span<const std::uint32_t> parents,
                  TetraResult& result) {
  const std::size_t n_old = boundary.points.size();
  const std::size_t n_new = result.new_points.size();
  std::vector<std::uint8_t> is_on_boundary(n_new, 0);
  for (const auto& t : triangles)
    for (const std::uint32_t v : t)
      if (v >= n_old && v - n_old < n_new) is_on_boundary[v - n_old] = 1;
  std::vector<std::uint32_t> old2new(n_new);
  std::vector<Vec3> points(boundary.points.begin(), boundary.points.end()), inner;
  for (std::size_t i = 0; i < n_new; ++i) {
    if (!is_on_boundary[i]) continue;
    old2new[i] = static_cast<std::uint32_t>(points.size());
    points.push_back(result.new_points[i]);
  }
  for (std::size_t i = 0; i < n_new; ++i) {
    if (is_on_boundary[i]) continue;
    old2new[i] = static_cast<std::uint32_t>(points.size() + inner.size());
    inner.push_back(result.new_points[i]);
  }
  const auto renumber = [&](auto& nodes) {
    for (std::uint32_t& v : nodes)
      if (v >= n_old && v - n_old < n_new) v = old2new[v - n_old];
  };
  std::vector<std::array<std::uint32_t, 3>> renumbered(triangles.begin(), triangles.end());
  for (auto& t : renumbered) renumber(t);
  for (auto& t : result.tetrahedra) renumber(t);
  result.new_points = std::move(inner);
  result.splits = find_splits(boundary, points, renumbered, parents);
}

TetraResult read_result(EngineKind kind, const wire::ReplyHeader& header, const SharedBlock& reply, const std::byte* data, const EngineInput& input,
                        const Request& request, const RunContext& context) {
  const std::size_t n_boundary = request.points().size();
  const std::size_t expected = sizeof header + sizeof(Vec3) * header.n_points + sizeof(std::array<std::uint32_t, 4>) * header.n_tetrahedra +
                               sizeof(std::array<std::uint32_t, 4>) * header.n_triangles;
  if (reply.size() != expected) throw_invalid_reply(kind, std::to_string(reply.size()) + " bytes instead of " + std::to_string(expected));
  if (header.n_points < n_boundary) throw_invalid_reply(kind, std::to_string(header.n_points) + " points returned of " + std::to_string(n_boundary));
  const auto* points = reinterpret_cast<const Vec3*>(data + sizeof header);
  for (std::size_t i = 0; i < n_boundary; ++i) {
    if (points[i] == request.points()[i]) continue;
    throw_invalid_reply(kind, "boundary point " + std::to_string(i) + " was returned at another location",
                        {{request.points()[i] / request.scale(), "sent"}, {points[i] / request.scale(), "returned"}});
  }
  TetraResult result;
  result.engine = to_string(kind);
  result.engine_seconds = header.engine_seconds;
  result.engine_peak_bytes = header.peak_bytes;
  result.new_points.resize(header.n_points - n_boundary);
  result.tetrahedra.resize(header.n_tetrahedra);
  parallel_for(context, result.new_points.size(), [&](std::size_t i) { result.new_points[i] = points[n_boundary + i] / request.scale(); });
  if (header.n_tetrahedra > 0) std::memcpy(result.tetrahedra.data(), points + header.n_points, sizeof(result.tetrahedra[0]) * header.n_tetrahedra);
  if (header.n_triangles > 0) {
    const auto* triangles = reinterpret_cast<const std::array<std::uint32_t, 3>*>(data + sizeof header + sizeof(Vec3) * header.n_points +
                                                                                  sizeof(result.tetrahedra[0]) * header.n_tetrahedra);
    adopt_splits(input.boundary, {triangles, header.n_triangles}, {reinterpret_cast<const std::uint32_t*>(triangles + header.n_triangles), header.n_triangles},
                 result);
  }
  if (input.joined) part_baffles(input.boundary, *input.joined, result);
  return result;
}

/// Verifies the result like verify.h, for the boundary as the engine split it.
void verify(const TetraBoundary& boundary, const TetraResult& result, const RunContext& context) {
  if (result.splits.empty()) return verify_tetrahedra(boundary, result, context);
  std::vector<Vec3> points(boundary.points.begin(), boundary.points.end());
  points.insert(points.end(), result.splits.points.begin(), result.splits.points.end());
  const TetraBoundary split{.points = points, .triangles = result.splits.triangles, .hole_points = {}};
  try {
    check_boundary(split, context);
  } catch (const Error& error) {
    if (error.code() == ErrorCode::cancelled) throw;
    ErrorInfo info = error.info();
    info.code = ErrorCode::tetra_result_invalid;
    info.attempted = "checking the boundary split by the engine";
    throw Error(std::move(info));
  }
  verify_tetrahedra(split, result, context);
}

EngineOutcome failed(EngineFailure failure) { return {std::nullopt, std::move(failure)}; }

}  // namespace

std::string_view to_string(EngineKind kind) { return kind == EngineKind::tetgen ? "tetgen" : kind == EngineKind::hxt ? "hxt" : "sterna"; }
std::string_view display_name(EngineKind kind) { return kind == EngineKind::tetgen ? "TetGen" : kind == EngineKind::hxt ? "HXT" : "built-in engine"; }

EngineOutcome run_engine(EngineKind kind, const EngineInput& input, const TetraOptions& options, const RunContext& context) {
  if (kind == EngineKind::sterna) return run_own_engine(input, options, context);
  try {
    const std::string helper = find_helper("sterna-tet-" + std::string(to_string(kind)), options.helper_folder);
    std::optional<StageTimer> transfer(std::in_place, context, "tetrahedra/transfer");
    const Request request(input, options, context);
    SharedBlock reply("sterna tetra reply", 0, engine_task());
    transfer.reset();
    const HelperExit exit = [&] {
      const StageTimer timer(context, "tetrahedra/helper");
      LateData size_field;
      if (input.sizes) size_field = [&] { return input.sizes->is_ready() ? input.sizes->get().bytes() : std::span<const std::byte>(); };
      return run_helper({.task = engine_task(), .path = helper, .arguments = {}, .late = size_field, .time_limit = options.time_limit},
                        request.block().descriptor(), reply.descriptor(), context);
    }();
    transfer.emplace(context, "tetrahedra/transfer");
    if (!exit.output.empty()) context.debug(std::string(display_name(kind)) + ": " + exit.output);
    const std::byte* data = reply.map();
    wire::ReplyHeader header;
    header.magic = 0;
    if (reply.size() >= sizeof header) std::memcpy(&header, data, sizeof header);
    if (std::optional<EngineFailure> reason = judge_exit(kind, exit, header, options)) return failed(std::move(*reason));
    if (std::optional<EngineFailure> reason = judge_count(kind, header, request, options)) return failed(std::move(*reason));
    TetraResult result = read_result(kind, header, reply, data, input, request, context);
    transfer.reset();
    if (input.is_recovery_only) return {std::move(result), {}};
    const StageTimer timer(context, "tetrahedra/verify");
    verify(input.boundary, result, context);
    return {std::move(result), {}};
  } catch (const Error& error) {
    if (error.code() == ErrorCode::tetra_engine_missing) return failed({FailureKind::missing, error.info()});
    if (error.code() == ErrorCode::tetra_result_invalid) return failed({FailureKind::deterministic, error.info()});
    throw;
  }
}

}  // namespace sterna::volmesh
