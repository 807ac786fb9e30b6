// The adapter of TetGen: request out, helper run, reply in, answer proven. What is known of TetGen 1.5.0 as Debian builds it (all measured):
// - Its vertices must be farther apart than -T (default 1e-8) of the longest side of the box, which the farfield makes long; closer ones are merged, and
//   then it crashes. -M stops the merging: slabs of 1e-12 and wedges of 1e-8 radians in a box of 100 pass with it and crash without.
// - With -Y the boundary stays as it is, triangle for triangle, on everything tried so far; verify_tetrahedra() watches over it.
// - Self-intersecting, duplicate or degenerate facets make it crash, or answer with facets missing; it rarely reports them.
// - An open boundary gives 0 tetrahedra and no error; an index out of range is read as it is.
// - Points that it adds and removes again during boundary recovery are left out of the answer, but not with -J (pygeo_bwb).
// - Its tetrahedra are positive in CGNS order; two runs are identical to the bit.

#include <algorithm>
#include <bit>
#include <cmath>
#include <csignal>
#include <cstdio>
#include <cstring>
#include <sys/wait.h>

#include "geom/base/error.h"
#include "geom/base/parallel.h"
#include "geom/math/intersect.h"
#include "volmesh/tetra/boundary_check.h"
#include "volmesh/tetra/engine_process.h"
#include "volmesh/tetra/tetra.h"
#include "volmesh/tetra/verify.h"
#include "volmesh/tetra/wire.h"

namespace sterna::volmesh {
namespace {

constexpr const char* k_helper_name = "sterna-tet-tetgen";
constexpr std::size_t k_places_named = 10;
constexpr std::size_t k_crossings_kept = 1000;  ///< pairs of triangles in the geometry of an error

/// -p boundary, -q<ratio> quality, -Y keep the boundary, -M merge nothing, -F write no faces, -Q quiet,
/// -T tolerance below the rounding error of the box's size: never call a feature too small (error 4).
std::string switches(const TetraOptions& options) {
  std::array<char, sizeof(wire::RequestHeader::switches)> text{};
  std::snprintf(text.data(), text.size(), "pq%.9gYMFQT1e-16", options.radius_edge);
  return text.data();
}

/// Power of two that brings the largest coordinate into [1, 2).
double unit_scale(std::span<const Vec3> points) {
  double largest = 0.0;
  for (const Vec3& p : points) largest = std::max({largest, std::abs(p.x), std::abs(p.y), std::abs(p.z)});
  return std::ldexp(1.0, -std::ilogb(largest));
}

class Request {
 public:
  Request(const TetraBoundary& boundary, const TetraOptions& options, double scale, const RunContext& context)
      : block_("sterna tetra request", sizeof(wire::RequestHeader) + sizeof(Vec3) * (boundary.points.size() + boundary.hole_points.size()) + sizeof(boundary.triangles[0]) * boundary.triangles.size()) {
    wire::RequestHeader header;
    header.n_points = boundary.points.size();
    header.n_holes = boundary.hole_points.size();
    header.n_triangles = boundary.triangles.size();
    header.memory_limit = static_cast<std::uint64_t>(options.memory_limit);
    std::strncpy(header.switches, switches(options).c_str(), sizeof header.switches - 1);
    std::byte* at = block_.map();
    std::memcpy(at, &header, sizeof header);
    points_ = reinterpret_cast<Vec3*>(at + sizeof header);
    Vec3* const holes = points_ + header.n_points;
    parallel_for(context, header.n_points, [&](std::size_t i) { points_[i] = scale * boundary.points[i]; });
    for (std::size_t i = 0; i < header.n_holes; ++i) holes[i] = scale * boundary.hole_points[i];
    std::memcpy(static_cast<void*>(holes + header.n_holes), boundary.triangles.data(), boundary.triangles.size_bytes());
  }
  const SharedBlock& block() const { return block_; }
  const Vec3* points() const { return points_; }  ///< as TetGen got them

 private:
  SharedBlock block_;
  Vec3* points_ = nullptr;
};

ErrorInfo engine_failure(std::string problem, std::string hint = {}) {
  return {.code = ErrorCode::tetra_engine_failed, .attempted = "filling the volume with tetrahedra (TetGen)", .problem = std::move(problem), .hint = std::move(hint)};
}

std::string last_words(const HelperExit& exit) {
  std::string text = exit.output;
  while (!text.empty() && std::isspace(static_cast<unsigned char>(text.back()))) text.pop_back();
  constexpr std::size_t k_quoted = 500;
  if (text.size() > k_quoted) text.erase(0, text.size() - k_quoted);
  return text.empty() ? "" : "; its last words: \"" + text + "\"";
}

/// TetGen's codes as terminatetetgen() in tetgen.h names them.
std::string text_of_code(int code) {
  switch (code) {
    case 2: return "met an internal error";
    case 3: return "found that the boundary intersects itself";
    case 4: return "met a feature that is too small for it";
    case 5: return "met two facets that are too close for it";
    case 10: return "rejected its input";
    default: return "failed";
  }
}

std::string with_unit(double value, const char* unit) {
  std::array<char, 40> text{};
  std::snprintf(text.data(), text.size(), "%.6g %s", value, unit);
  return text.data();
}
std::string megabytes(double bytes) { return with_unit(std::round(bytes / 1e6), "MB"); }

/// Adds the places where the boundary crosses itself, the usual reason for a failure; or says that there are none.
void blame_boundary(ErrorInfo& error, const TetraBoundary& boundary, const RunContext& context) {
  const CrossingPairs crossings = find_crossings(boundary.points, boundary.triangles, context, k_crossings_kept);
  if (crossings.total == 0) {
    error.hint = "the boundary does not cross itself; look for features many orders of magnitude smaller than the farfield";
    return;
  }
  error.problem += "; the boundary crosses itself at " + std::to_string(crossings.total) + " pairs of triangles";
  error.hint = "remove the crossings";
  error.n_places = crossings.total;
  for (const auto& [a, b] : crossings.pairs) {
    if (error.places.size() < k_places_named) error.places.push_back(place_of_triangle(boundary, a, "crosses " + std::to_string(b)));
    add_triangle(error.geometry, boundary, a);
    add_triangle(error.geometry, boundary, b);
  }
}

/// The reply's header. \throws Error(tetra_engine_failed) when there is none or it says that the engine failed.
wire::ReplyHeader read_header(const SharedBlock& reply, const std::byte* data, const HelperExit& exit, const TetraBoundary& boundary, const TetraOptions& options,
                              const RunContext& context) {
  wire::ReplyHeader header;
  header.magic = 0;
  if (reply.size() >= sizeof header) std::memcpy(&header, data, sizeof header);
  const bool is_reply = header.magic == wire::k_reply_magic;
  if (exit.is_success() && is_reply && header.outcome == wire::Outcome::ok) return header;

  if (exit.is_time_over) {
    throw Error(engine_failure("stopped after the time limit of " + with_unit(options.time_limit, "s"), "raise tetrahedra.time_limit, or coarsen the surface"));
  }
  if (is_reply && header.outcome == wire::Outcome::out_of_memory) {
    throw Error(engine_failure("out of memory: the limit of the helper is " + megabytes(options.memory_limit) + ", it had used " + megabytes(header.peak_bytes),
                               "raise tetrahedra.memory_limit, or coarsen the surface"));
  }
  ErrorInfo error;
  if (WIFSIGNALED(exit.wait_status)) {
    const int signal = WTERMSIG(exit.wait_status);
    error = engine_failure("the helper died of signal " + std::to_string(signal) + " (" + strsignal(signal) + ")" + last_words(exit));
    if (signal == SIGKILL) {
      error.hint = "someone killed it, perhaps the system for lack of memory";
      throw Error(std::move(error));
    }
  } else if (is_reply && header.outcome == wire::Outcome::engine_code) {
    error = engine_failure("TetGen " + text_of_code(header.engine_code) + " (code " + std::to_string(header.engine_code) + ")" + last_words(exit));
  } else {
    error = engine_failure("the helper gave no answer, exit status " + std::to_string(WEXITSTATUS(exit.wait_status)) + last_words(exit),
                           "the helper may be of another version: build the target sterna-tet-tetgen again");
    throw Error(std::move(error));
  }
  blame_boundary(error, boundary, context);
  throw Error(std::move(error));
}

ErrorInfo invalid_reply(std::string problem) {
  return {.code = ErrorCode::tetra_result_invalid, .attempted = "reading the answer of TetGen", .problem = std::move(problem)};
}

TetraResult read_result(const wire::ReplyHeader& header, const SharedBlock& reply, const std::byte* data, const TetraBoundary& boundary, const Vec3* sent, double scale,
                        const RunContext& context) {
  const std::size_t n_boundary = boundary.points.size();
  const std::size_t expected = sizeof header + sizeof(Vec3) * header.n_points + sizeof(std::array<std::uint32_t, 4>) * header.n_tetrahedra;
  if (reply.size() != expected) throw Error(invalid_reply(std::to_string(reply.size()) + " bytes instead of " + std::to_string(expected)));
  if (header.n_points < n_boundary) throw Error(invalid_reply(std::to_string(header.n_points) + " points come back of " + std::to_string(n_boundary)));
  const auto* points = reinterpret_cast<const Vec3*>(data + sizeof header);
  for (std::size_t i = 0; i < n_boundary; ++i) {
    if (points[i] == sent[i]) continue;
    ErrorInfo error = invalid_reply("boundary point " + std::to_string(i) + " comes back in another place");
    error.places.push_back({boundary.points[i], "sent"});
    error.places.push_back({points[i] / scale, "came back"});
    throw Error(std::move(error));
  }
  TetraResult result;
  result.engine_seconds = header.engine_seconds;
  result.engine_peak_bytes = header.peak_bytes;
  result.new_points.resize(header.n_points - n_boundary);
  result.tetrahedra.resize(header.n_tetrahedra);
  parallel_for(context, result.new_points.size(), [&](std::size_t i) { result.new_points[i] = points[n_boundary + i] / scale; });
  if (header.n_tetrahedra > 0) std::memcpy(result.tetrahedra.data(), points + header.n_points, sizeof(result.tetrahedra[0]) * header.n_tetrahedra);
  return result;
}

}  // namespace

TetraResult fill_with_tetgen(const TetraBoundary& boundary, const TetraOptions& options, const RunContext& context) {
  check_boundary(boundary, context);
  const std::string helper = find_helper(k_helper_name, options.helper);
  const double scale = unit_scale(boundary.points);
  const Request request(boundary, options, scale, context);
  SharedBlock reply("sterna tetra reply", 0);
  const HelperExit exit = run_helper(helper, request.block(), reply, options.time_limit, context);
  if (!exit.output.empty()) context.debug("TetGen: " + exit.output);
  const std::byte* data = reply.map();
  const wire::ReplyHeader header = read_header(reply, data, exit, boundary, options, context);
  TetraResult result = read_result(header, reply, data, boundary, request.points(), scale, context);
  try {
    verify_tetrahedra(boundary, result, context);
  } catch (const Error& error) {
    if (error.code() != ErrorCode::tetra_result_invalid) throw;
    ErrorInfo info = error.info();
    const CrossingPairs crossings = find_crossings(boundary.points, boundary.triangles, context, 1);
    if (crossings.total > 0) blame_boundary(info, boundary, context);
    throw Error(std::move(info));
  }
  return result;
}

}  // namespace sterna::volmesh
