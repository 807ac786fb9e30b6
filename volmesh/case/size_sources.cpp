#include "volmesh/case/size_sources.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <numbers>

namespace sterna::volmesh {
namespace {

constexpr double k_nowhere = std::numeric_limits<double>::infinity();

double distance_to_segment(const Vec3& p, const Vec3& a, const Vec3& b) {
  const Vec3 ab = b - a;
  const double length2 = norm2(ab);
  const double t = length2 > 0.0 ? std::clamp(dot(p - a, ab) / length2, 0.0, 1.0) : 0.0;
  return distance(p, a + t * ab);
}

double distance_to_box(const Vec3& p, const Vec3& a, const Vec3& b) {
  Vec3 away;
  for (std::size_t axis = 0; axis < 3; ++axis) away[axis] = std::max({std::min(a[axis], b[axis]) - p[axis], p[axis] - std::max(a[axis], b[axis]), 0.0});
  return norm(away);
}

double distance_to_cylinder(const Vec3& p, const Vec3& a, const Vec3& b, double radius) {
  const double length = distance(a, b);
  const Vec3 axis = (b - a) / length;
  const double along = dot(p - a, axis);
  const double beside = std::max(norm(p - a - along * axis) - radius, 0.0);
  const double beyond = std::max({-along, along - length, 0.0});
  return std::hypot(beside, beyond);
}

/// Returns the edge length in the frame of the wake: s along the direction, c across it along the edge, z out of its plane. The section at s is a rectangle.
double size_of_wake(const SizeSource& wake, const Vec3& p, double slope) {
  const Vec3 stream = normalized(wake.direction);
  const Vec3 edge = wake.to - wake.from;
  const Vec3 normal = normalized(cross(stream, edge));
  const Vec3 across = cross(normal, stream);
  const Vec3 r = p - wake.from;
  const double c = dot(r, across);
  const double span = dot(edge, across);
  // The wake of a swept edge starts farther downstream at the other end of the edge.
  const double start = dot(edge, stream) * (span > 0.0 ? std::clamp(c / span, 0.0, 1.0) : 0.0);
  const double s = dot(r, stream) - start;
  const double inside = std::clamp(s, 0.0, wake.length);
  const double half_height = 0.5 * wake.height + wake.spread * inside;
  const double beyond = std::abs(s - inside);
  const double beside = std::max({-c, c - span, 0.0});
  const double above = std::max(std::abs(dot(r, normal)) - half_height, 0.0);
  const double end = wake.size_end > 0.0 ? wake.size_end : wake.size;
  return wake.size + (end - wake.size) * inside / wake.length + slope * std::hypot(beyond, beside, above);
}

}  // namespace

std::string_view to_string(SourceKind kind) {
  constexpr std::array<std::string_view, 7> k_names = {"point", "line", "box", "sphere", "cylinder", "wake", "samples"};
  return k_names[static_cast<std::size_t>(kind)];
}

std::string problem_of(const SizeSource& source, double growth) {
  const auto positive = [](double value) { return value > 0.0 && std::isfinite(value); };
  if (!is_finite(source.from) || !is_finite(source.to) || !is_finite(source.direction)) return "coordinates must be finite";
  if (source.kind == SourceKind::samples) {
    if (source.points.empty()) return "there are no samples";
    if (source.points.size() != source.sizes.size()) return "each sample needs one size";
    if (!std::ranges::all_of(source.sizes, positive)) return "sizes of samples must be positive";
    if (!std::ranges::all_of(source.points, is_finite)) return "coordinates must be finite";
    return "";
  }
  if (!positive(source.size)) return "size must be positive";
  if (source.radius < 0.0 || !std::isfinite(source.radius)) return "radius must not be negative";
  if (source.kind == SourceKind::sphere && source.radius == 0.0) return "a sphere needs a radius";
  if (source.kind == SourceKind::cylinder && (source.radius == 0.0 || source.from == source.to)) return "a cylinder needs a radius and two different points";
  if (source.kind != SourceKind::wake) return "";
  if (!positive(source.length)) return "a wake needs a length";
  if (!(source.height >= 0.0) || !(source.spread >= 0.0) || !std::isfinite(source.height + source.spread)) return "height and spread must not be negative";
  if (!(norm(cross(source.direction, source.to - source.from)) > 0.0)) return "direction must not lie along the edge of the wake";
  if (source.size_end < 0.0 || !std::isfinite(source.size_end)) return "size_end must be positive";
  if (source.size_end > 0.0 && std::abs(source.size_end - source.size) > (growth - 1.0) * source.length)
    return "size_end differs from size by more than growth allows over this length";
  return "";
}

double volume_of(const SizeSource& source) {
  const Vec3 d = source.to - source.from;
  const double r = source.radius;
  const double ball = 4.0 / 3.0 * std::numbers::pi * r * r * r;
  const double disc = std::numbers::pi * r * r;
  switch (source.kind) {
    case SourceKind::point: return 0.0;
    case SourceKind::line: return ball + disc * norm(d);
    case SourceKind::box: return std::abs(d.x * d.y * d.z);
    case SourceKind::sphere: return ball;
    case SourceKind::cylinder: return disc * norm(d);
    case SourceKind::wake: return norm(cross(normalized(source.direction), d)) * source.length * (source.height + source.spread * source.length);
    case SourceKind::samples: return 0.0;
  }
  return 0.0;
}

double size_of(const SizeSource& source, const Vec3& p, double slope) {
  switch (source.kind) {
    case SourceKind::point: return source.size + slope * distance(p, source.from);
    case SourceKind::line: return source.size + slope * std::max(distance_to_segment(p, source.from, source.to) - source.radius, 0.0);
    case SourceKind::box: return source.size + slope * distance_to_box(p, source.from, source.to);
    case SourceKind::sphere: return source.size + slope * std::max(distance(p, source.from) - source.radius, 0.0);
    case SourceKind::cylinder: return source.size + slope * distance_to_cylinder(p, source.from, source.to, source.radius);
    case SourceKind::wake: return size_of_wake(source, p, slope);
    case SourceKind::samples: return k_nowhere;
  }
  return k_nowhere;
}

}  // namespace sterna::volmesh
