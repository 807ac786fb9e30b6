// Bodies defined by a few numbers: bodies of revolution, booms, fairings and stings.
#include <cmath>
#include <numbers>

#include "geom/base/error.h"
#include "geom/base/number_text.h"
#include "geom/model/shapes.h"

namespace sterna {
namespace {

BodyFrame point_frame(double x) { return {.name = "x" + std::to_string(x), .center = {x, 0.0, 0.0}, .shape = FrameShape::loop, .loop = {{x, 0.0, 0.0}}}; }

BodyFrame frame(double x, double width, double height, double exponent = 2.0) {
  return {.name = "x" + std::to_string(x),
          .center = {x, 0.0, 0.0},
          .height = height,
          .width = width,
          .shape = FrameShape::ellipse,
          .n_points = 11,
          .exponent = exponent};
}

}  // namespace

Placement placement_along(const Point& from, const Point& to) {
  const Vec3 d = to - from;
  if (!(norm(d) > 0.0)) throw_bad_argument("placing a body", "the axis begins and ends at the same point, " + format_point(from));
  return {from, {0.0, -std::asin(std::min(1.0, std::max(-1.0, d.z / norm(d)))), d.x == 0.0 && d.y == 0.0 ? 0.0 : std::atan2(d.y, d.x)}};
}

Body body_of_revolution(const std::string& name, const Placement& placement, const std::vector<Uv>& profile, bool is_straight, ComponentKind kind) {
  const std::string attempted = "making body of revolution '" + name + "'";
  if (profile.size() < 2) throw_bad_argument(attempted, "the profile has " + std::to_string(profile.size()) + " points; at least 2 are needed");
  Body body{.name = name, .kind = kind, .placement = placement, .tangents = is_straight ? BodyTangents::linear : BodyTangents::monotone};
  for (std::size_t i = 0; i < profile.size(); ++i) {
    const std::string point =
        "point " + std::to_string(i + 1) + " of the profile (x = " + number_text(profile[i].u) + ", radius " + number_text(profile[i].v) + ")";
    const bool is_end = i == 0 || i + 1 == profile.size();
    if (i > 0 && !(profile[i].u > profile[i - 1].u)) throw_bad_argument(attempted, point + " does not lie behind the point before it");
    if (!(profile[i].v > 0.0) && !(is_end && profile[i].v == 0.0))
      throw_bad_argument(attempted, point + " needs a positive radius; only the end points may have radius 0");
    body.frames.push_back(profile[i].v == 0.0 ? point_frame(profile[i].u) : frame(profile[i].u, 2.0 * profile[i].v, 2.0 * profile[i].v));
  }
  return body;
}

Body boom_body(const std::string& name, const Point& from, const Point& to, const BoomOptions& o) {
  BoomOptions checked = o;
  require_options(options_of(checked), "making boom '" + name + "'");
  const double nose = is_automatic(o.nose_length) ? o.diameter : o.nose_length, tail = is_automatic(o.tail_length) ? 2.0 * o.diameter : o.tail_length;
  const double length = distance(from, to), radius = 0.5 * o.diameter;
  if (!(nose + tail < length))
    throw_bad_argument("making boom '" + name + "'", "the rounded ends are " + std::to_string(nose) + " m and " + std::to_string(tail) +
                                                         " m long; together they must be shorter than the boom, " + std::to_string(length) + " m");
  Body body = body_of_revolution(name, placement_along(from, to), {{nose, radius}, {length - tail, radius}}, true, ComponentKind::boom);
  body.nose = {CapShape::dome, nose / radius};
  body.tail = {CapShape::dome, tail / radius};
  return body;
}

Body fairing_body(const std::string& name, const Point& position, const FairingOptions& o) {
  FairingOptions checked = o;
  require_options(options_of(checked), "making fairing '" + name + "'");
  Body body{.name = name, .kind = ComponentKind::fairing, .placement = {position, {}}};
  const auto add = [&](double x, double size) {
    body.frames.push_back(size > 0.0 ? frame(x * o.length, size * o.width, size * o.height, o.exponent) : point_frame(x * o.length));
  };
  constexpr int k_front = 10, k_rear = 8;  // number of frames: a quarter ellipse up to the largest section, then a parabola to the point at the rear
  for (int i = 0; i < k_front; ++i) {
    const double a = 0.5 * std::numbers::pi * i / k_front;
    add(o.thickest * (1.0 - std::cos(a)), std::sin(a));
  }
  for (int i = 0; i <= k_rear; ++i) {
    const double t = static_cast<double>(i) / k_rear;
    add(o.thickest + t * (1.0 - o.thickest), 1.0 - t * t);
  }
  return body;
}

Body sting_body(const std::string& name, const Point& from, const Point& to, const StingOptions& o) {
  StingOptions checked = o;
  require_options(options_of(checked), "making sting '" + name + "'");
  const double length = distance(from, to), radius = 0.5 * o.diameter, end = is_automatic(o.end_diameter) ? radius : 0.5 * o.end_diameter;
  std::vector<Uv> profile{{0.0, radius}};
  if (!is_automatic(o.cone_start)) {
    if (!(o.cone_start < length))
      throw_bad_argument("making sting '" + name + "'",
                         "the cone starts at " + std::to_string(o.cone_start) + " m, but the sting is only " + std::to_string(length) + " m long");
    if (o.cone_start > 0.0) profile.push_back({o.cone_start, radius});
  } else if (end != radius) {
    throw_bad_argument("making sting '" + name + "'",
                       "the sting has an end_diameter (" + std::to_string(2.0 * end) + " m) but no cone_start, which is needed with it");
  }
  profile.push_back({length, end});
  return body_of_revolution(name, placement_along(from, to), profile, true, ComponentKind::sting);
}

}  // namespace sterna
