#include "geom/delaunay/face_state.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "geom/base/error.h"

namespace sterna::delaunay {
namespace {

/// Squared sine between du and dv below which a normal is not trusted: rounding of derivatives near poles is 1e-16 of their size.
constexpr double k_min_sine2 = 1e-16;
/// Maximum number of Newton steps: start values are close, two steps are usual.
constexpr int k_max_steps = 4;

}  // namespace

SurfaceSample sample(const Surface& surface, Uv at) {
  const SurfaceDerivatives d = surface.derivatives(at);
  const Vec3 normal = cross(d.du, d.dv);
  const double length2 = norm2(normal);
  SurfaceSample result{d.point, {d.du, d.dv, {}}};
  if (length2 > k_min_sine2 * norm2(d.du) * norm2(d.dv)) result.frame.normal = normal / std::sqrt(length2);
  return result;
}

double target_size(const FaceState& state, Uv at, const Point& point) {
  const double size = state.requested(at, point);
  if (!(size > 0.0)) {
    ErrorInfo info{.code = ErrorCode::bad_argument,
                   .attempted = "meshing a face",
                   .problem = "the target edge length is " + std::to_string(size) + " m, must be positive"};
    info.locations.push_back({point, "here"});
    throw Error(std::move(info));
  }
  return std::max(state.options.min_edge, size);
}

Uv parameter_step(const SurfaceFrame& frame, const Vec3& step) {
  const double e = norm2(frame.du), f = dot(frame.du, frame.dv), g = norm2(frame.dv);
  const double area2 = e * g - f * f;
  const double along_u = dot(frame.du, step), along_v = dot(frame.dv, step);
  if (!(area2 > k_min_sine2 * e * g)) return {e > 0.0 ? along_u / e : 0.0, g > 0.0 ? along_v / g : 0.0};
  return {(g * along_u - f * along_v) / area2, (e * along_v - f * along_u) / area2};
}

Uv approach(const FaceState& state, const Point& target, Uv guess, double tolerance, SurfaceSample& at_result) {
  const auto hold = [&](Uv at) { return Uv{std::clamp(at.u, state.box.u.from, state.box.u.to), std::clamp(at.v, state.box.v.from, state.box.v.to)}; };
  Uv at = hold(guess);
  at_result = sample(state.surface, at);
  for (int step = 0; step < k_max_steps; ++step) {
    Vec3 off = target - at_result.point;
    const Vec3& normal = at_result.frame.normal;
    off -= dot(off, normal) * normal;
    if (norm2(off) <= tolerance * tolerance) break;
    const Uv change = parameter_step(at_result.frame, off);
    const Uv moved = hold(at + change);
    if (moved == at) break;
    const SurfaceSample there = sample(state.surface, moved);
    // A step that increases the distance is rejected: the result remains a point of the surface, only less near to its target.
    if (!(norm2(target - there.point) < norm2(target - at_result.point))) break;
    at = moved;
    at_result = there;
  }
  return at;
}

}  // namespace sterna::delaunay
