#include "geom/model/section_rows.h"

#include <algorithm>
#include <cmath>
#include <functional>
#include <numbers>

#include "geom/base/error.h"
#include "geom/model/airfoil.h"
#include "geom/model/spline.h"
#include "geom/model/winglet_blend.h"

namespace sterna {
namespace {

/// Number of samples for the length of a side. The resulting fractions are even to 1e-6; the points lie on the curve in any case.
constexpr std::size_t k_length_samples = 2000;
/// A frame is a point if its size is below this fraction of a metre, or of its distance from the origin.
constexpr double k_point_size = 1e-9;

[[noreturn]] void refuse_section(ErrorCode code, const std::string& problem, std::vector<ErrorLocation> locations = {}) {
  throw Error({.code = code, .attempted = "making a cross section", .problem = problem, .locations = std::move(locations)});
}

/// Returns points of a curve between two parameters at fractions of the length.
std::vector<Point> at_fractions(const std::function<Point(double)>& curve, double from, double to, const std::vector<double>& fractions) {
  std::vector<double> length{0.0};
  const auto parameter = [&](double part) { return from + part * (to - from); };
  Point last = curve(from);
  for (std::size_t i = 1; i <= k_length_samples; ++i) {
    const Point next = curve(parameter(static_cast<double>(i) / k_length_samples));
    length.push_back(length.back() + distance(last, next));
    last = next;
  }
  std::vector<Point> points;
  for (const double fraction : fractions) {
    const double target = fraction * length.back();
    const auto above = std::upper_bound(length.begin() + 1, length.end() - 1, target);
    const auto i = static_cast<std::size_t>(above - length.begin());
    const double step = length[i] - length[i - 1];
    const double part = (static_cast<double>(i - 1) + (step > 0.0 ? (target - length[i - 1]) / step : 0.0)) / k_length_samples;
    points.push_back(curve(parameter(std::clamp(part, 0.0, 1.0))));
  }
  return points;
}

/// Returns the right half of a section given by a formula, unit half width and height, angle 0 at the bottom, pi at the top.
std::function<Uv(double)> shape_of(const BodyFrame& frame) {
  const auto power = [](double value, double exponent) { return value <= 0.0 ? 0.0 : std::pow(value, exponent); };
  switch (frame.shape) {
    case FrameShape::circle:
    case FrameShape::ellipse: {
      const double e = frame.shape == FrameShape::circle ? 1.0 : 2.0 / frame.exponent;
      return [=](double a) { return Uv{power(std::sin(a), e), -std::copysign(power(std::abs(std::cos(a)), e), std::cos(a))}; };
    }
    case FrameShape::double_ellipse:
      return [offset = frame.offset](double a) {
        const double c = -std::cos(a);
        return Uv{std::max(std::sin(a), 0.0), offset + c * (c < 0.0 ? 1.0 + offset : 1.0 - offset)};
      };
    case FrameShape::egg: {  // y2 = (1 - z2) / (1 + d z), scaled to unit half width
      const auto raw = [d = frame.distortion](double z) { return std::sqrt(std::max(0.0, 1.0 - z * z) / (1.0 + d * z)); };
      double widest = 0.0;
      for (int i = 0; i <= 4000; ++i) widest = std::max(widest, raw(-1.0 + i / 2000.0));
      return [=](double a) { return Uv{raw(-std::cos(a)) / widest, -std::cos(a)}; };
    }
    default: refuse_section(ErrorCode::unsupported_format, "frame '" + frame.name + "': Isikveren's sections have no documented formula and are not supported");
  }
}

std::vector<Point> closed(std::vector<Point> right, const std::vector<Point>& left) {
  right.insert(right.end(), left.begin() + 1, left.end());
  right.back() = right.front();
  return right;
}

std::vector<double> even_fractions(std::size_t m) {
  std::vector<double> fractions;
  for (std::size_t i = 0; i <= m; ++i) fractions.push_back(static_cast<double>(i) / static_cast<double>(m));
  return fractions;
}

/// Returns both halves of a smooth closed curve through points, split at point `top`.
std::vector<Point> halves_of(std::vector<Point> loop, std::size_t top, std::size_t m) {
  loop.push_back(loop.front());
  const std::vector<double> at = spline_parameters(loop, SplineParameters::chord_length);
  const CurvePtr curve = spline_curve(loop, {.tangents = SplineTangents::periodic, .at = at});
  const auto point = [&](double t) { return curve->point(t); };
  const std::vector<double> fractions = even_fractions(m);
  return closed(at_fractions(point, 0.0, at[top], fractions), at_fractions(point, at[top], 1.0, fractions));
}

}  // namespace

std::vector<double> airfoil_stations(std::size_t n) {
  std::vector<double> stations;
  for (std::size_t k = 0; k <= n; ++k) stations.push_back(0.5 * (1.0 - std::cos(std::numbers::pi * static_cast<double>(k) / static_cast<double>(n))));
  stations.back() = 1.0;
  return stations;
}

std::vector<double> row_parameters(std::size_t n) {
  std::vector<double> parameters = airfoil_stations(n);
  for (std::size_t k = n; k-- > 0;) parameters.push_back(2.0 - parameters[k]);
  return parameters;
}

namespace {

CurvePtr curve_of(const std::vector<Point>& row) { return spline_curve(row, {.tangents = SplineTangents::not_a_knot, .at = row_parameters(row.size() / 2)}); }

}  // namespace

std::optional<RowCrossing> row_at_distance(const std::vector<Point>& row, const RowCrossing& from, const Point& center, double radius, bool is_forward) {
  const CurvePtr curve = curve_of(row);
  const auto find = [&](double start, bool is_upper) -> std::optional<double> {
    const auto is_far = [&](double u) { return distance(curve->point(is_upper ? u : 2.0 - u), center) > radius; };
    double near = start, far = is_forward ? 1.0 : 0.0;
    if (!is_far(far)) return std::nullopt;
    for (int i = 0; i < 60; ++i) {
      const double u = 0.5 * (near + far);
      (is_far(u) ? far : near) = u;
    }
    return 0.5 * (near + far);
  };
  const std::optional<double> upper = find(from.upper, true), lower = find(from.lower, false);
  if (!upper || !lower) return std::nullopt;
  return RowCrossing{*upper, *lower};
}

std::pair<Point, Point> points_at(const std::vector<Point>& row, const RowCrossing& crossing) {
  const CurvePtr curve = curve_of(row);
  return {curve->point(crossing.upper), curve->point(2.0 - crossing.lower)};
}

RowCrossing row_crossing(const std::vector<Point>& row, double fraction) {
  if (fraction <= 0.0) return {1.0, 1.0};
  if (fraction >= 1.0) return {0.0, 0.0};
  const std::size_t n = row.size() / 2;
  const CurvePtr curve = curve_of(row);
  const Vec3 chord = 0.5 * (row.front() + row.back()) - row[n];
  const auto crossing = [&](bool is_upper) {
    double behind = 0.0, before = 1.0;  // bisection: the fraction decreases from the trailing to the leading edge
    for (int i = 0; i < 60; ++i) {
      const double u = 0.5 * (behind + before);
      (dot(curve->point(is_upper ? u : 2.0 - u) - row[n], chord) > fraction * norm2(chord) ? behind : before) = u;
    }
    return 0.5 * (behind + before);
  };
  return {crossing(true), crossing(false)};
}

std::vector<Point> section_loop(const WingSection& section, const std::optional<double>& trailing_edge) {
  std::vector<Point> loop = section.loop;
  if (loop.empty()) {
    std::vector<Uv> points = section.points;
    if (points.empty() && !section.naca.empty()) points = naca_airfoil(section.naca).points;
    if (points.size() < 5)
      refuse_section(ErrorCode::bad_argument, "section '" + section.name + "' has " + std::to_string(points.size()) + " airfoil points; at least 5 are needed");
    const Transform location = transform_of({section.leading_edge, {section.dihedral, section.twist, section.yaw}});
    const double up = section.is_reversed ? -section.chord : section.chord;
    for (const Uv p : points) loop.push_back(location.point({section.chord * p.u, 0.0, up * p.v}));
    if (section.is_reversed) std::reverse(loop.begin(), loop.end());
  }
  if (!trailing_edge) return loop;
  const Point upper = loop.front(), lower = loop.back(), middle = 0.5 * (upper + lower);
  const auto nose = std::max_element(loop.begin(), loop.end(), [&](const Point& a, const Point& b) { return distance(a, middle) < distance(b, middle); });
  const auto n_upper = nose - loop.begin();
  const Point leading = *nose;
  const Vec3 chord = middle - leading;
  Vec3 gap = upper - lower;
  if (*trailing_edge > 0.0 && norm(gap) <= k_point_size * norm(chord)) {  // the airfoil is sharp: open its edge towards the upper side
    Vec3 up;
    for (std::ptrdiff_t i = 0; i < n_upper; ++i) up += loop[static_cast<std::size_t>(i)] - leading;
    for (auto i = static_cast<std::size_t>(n_upper); i < loop.size(); ++i) up -= loop[i] - leading;
    gap = up - dot(up, chord) / norm2(chord) * chord;
  }
  const Vec3 half = 0.5 * *trailing_edge * normalized(gap);
  const Vec3 move_upper = middle + half - upper, move_lower = middle - half - lower;
  for (std::size_t i = 0; i < loop.size(); ++i) {
    const double part = std::clamp(dot(loop[i] - leading, chord) / norm2(chord), 0.0, 1.0);
    loop[i] += part * (static_cast<std::ptrdiff_t>(i) < n_upper ? move_upper : move_lower);
  }
  loop.front() = middle + half;
  loop.back() = *trailing_edge > 0.0 ? middle - half : loop.front();
  return loop;
}

AirfoilRow airfoil_row(const std::vector<Point>& loop, std::size_t n, const std::string& name) {
  const std::vector<double> at = spline_parameters(loop, SplineParameters::centripetal);
  const CurvePtr curve = spline_curve(loop, {.tangents = SplineTangents::not_a_knot, .at = at});
  const Point middle = 0.5 * (loop.front() + loop.back());
  // The leading edge is the point of the curve farthest from the trailing edge; it is near the farthest point of the list.
  std::size_t best = 0;
  for (std::size_t i = 0; i < loop.size(); ++i)
    if (distance(loop[i], middle) > distance(loop[best], middle)) best = i;
  if (best == 0 || best + 1 == loop.size())
    refuse_section(ErrorCode::bad_argument, "section '" + name + "' has no leading edge between its ends", {{loop[best], "farthest point"}});
  double low = at[best - 1], high = at[best + 1];
  constexpr double k_golden = 0.6180339887498949;
  for (int i = 0; i < 80; ++i) {
    const double a = high - k_golden * (high - low), b = low + k_golden * (high - low);
    if (distance(curve->point(a), middle) > distance(curve->point(b), middle)) high = b;
    else low = a;
  }
  // If the farthest point is a point of the list, use that point.
  const double nose = distance(curve->point(0.5 * (low + high)), middle) > distance(loop[best], middle) * (1.0 + 1e-12) ? 0.5 * (low + high) : at[best];
  const auto point = [&](double t) { return curve->point(t); };
  const std::vector<double> stations = airfoil_stations(n);
  AirfoilRow row{at_fractions(point, 0.0, nose, stations)};
  std::vector<Point> lower = at_fractions(point, 1.0, nose, stations);
  row.points.insert(row.points.end(), lower.rbegin() + 1, lower.rend());
  row.points.front() = loop.front();
  row.points.back() = loop.back();
  return row;
}

WingRows wing_rows(const Wing& wing) {
  /// Trailing edges thinner than this fraction of the chord are sharp, because files have 6 digits.
  constexpr double k_sharp = 1e-6;
  WingRows result;
  std::optional<double> thickness = wing.trailing_edge;
  for (const bool is_first_try : {true, false}) {  // in the second try all edges are sharp, if any of them is
    result = {};
    for (const WingSection& section : wing.sections) {
      if (section.is_row) result.rows.push_back(section.loop);
      else result.rows.push_back(airfoil_row(section_loop(section, thickness), k_wing_side_points, section.name).points);
      std::vector<Point>& row = result.rows.back();
      if (distance(row.front(), row.back()) <= k_sharp * distance(row.front(), row[k_wing_side_points])) result.is_blunt = false;
    }
    if (result.is_blunt || !is_first_try) break;
    thickness = 0.0;
  }
  if (!result.is_blunt)
    for (std::vector<Point>& row : result.rows) row.front() = row.back() = 0.5 * (row.front() + row.back());
  for (const WingSection& section : wing.sections) {
    result.is_break.push_back(section.is_break || !wing.is_cubic);
    result.is_sampled.push_back(section.is_row);
  }
  if (wing.has_winglet) blend_winglets(result, !wing.is_symmetric);
  if (wing.is_symmetric) {
    result.is_break.back() = true;
    for (std::size_t i = result.rows.size() - 1; i-- > 0;) {
      result.is_break.push_back(result.is_break[i]);
      result.is_sampled.push_back(result.is_sampled[i]);
      result.rows.push_back(result.rows[i]);
      for (Point& p : result.rows.back()) p.y = -p.y;
    }
  }
  result.is_break.front() = result.is_break.back() = true;
  return result;
}

bool WingRows::is_sampled_between(std::size_t first_row, std::size_t last_row) const {
  for (std::size_t i = first_row + 1; i < last_row; ++i)
    if (!is_sampled[i]) return false;
  return true;
}

double WingPanel::v(double location) const {
  const double local = location - static_cast<double>(first_row), whole = std::floor(local);
  const auto i = static_cast<std::size_t>(whole);
  return local == whole ? v_of_row[i] : v_of_row[i] + (local - whole) * (v_of_row[i + 1] - v_of_row[i]);
}

WingPanel wing_panel(const std::vector<std::vector<Point>>& rows, std::size_t first_row, std::size_t last_row, bool is_sampled) {
  const std::size_t n = last_row - first_row + 1;
  PointGrid grid{rows.front().size(), n, {}};
  for (std::size_t i = 0; i < grid.n_u; ++i)
    for (std::size_t row = first_row; row <= last_row; ++row) grid.points.push_back(rows[row][i]);
  const SplineOptions around{.tangents = SplineTangents::not_a_knot, .at = row_parameters(grid.n_u / 2)};
  WingPanel panel{{}, first_row, {}};
  if (is_sampled && n >= 4) {
    for (std::size_t row = first_row; row <= last_row; ++row)
      panel.v_of_row.push_back(row == first_row ? 0.0
                                                : panel.v_of_row.back() + distance(rows[row - 1].front(), rows[row].front()) +
                                                      distance(rows[row - 1][grid.n_u / 2], rows[row][grid.n_u / 2]));
    const double length = panel.v_of_row.back();
    for (double& v : panel.v_of_row) v /= length;
    panel.form = spline_surface_form(grid, around, {.tangents = SplineTangents::not_a_knot, .at = panel.v_of_row});
    return panel;
  }
  panel.form = spline_surface_form(grid, around, {.tangents = n == 2 ? SplineTangents::linear : SplineTangents::natural});
  panel.v_of_row = panel.form.knots_v;  // natural and linear splines have a knot at every row
  panel.v_of_row.erase(std::unique(panel.v_of_row.begin(), panel.v_of_row.end()), panel.v_of_row.end());
  return panel;
}

std::vector<WingPanel> wing_panels(const WingRows& rows) {
  std::vector<WingPanel> panels;
  std::size_t from = 0;
  for (std::size_t i = 1; i < rows.rows.size(); ++i) {
    if (!rows.is_break[i]) continue;
    panels.push_back(wing_panel(rows.rows, from, i, rows.is_sampled_between(from, i)));
    from = i;
  }
  return panels;
}

std::vector<Point> frame_row(const BodyFrame& frame, std::size_t m) {
  if (frame.shape == FrameShape::loop) {
    double size = 0.0;
    for (const Point& p : frame.loop) size = std::max(size, distance(p, frame.loop.front()));
    if (size <= k_point_size * std::max(1.0, norm(frame.loop.front()))) return std::vector<Point>(2 * m + 1, frame.loop.front());
    std::size_t top = 0;
    for (std::size_t i = 1; i < frame.loop.size(); ++i) {
      const double higher = frame.loop[i].z - frame.loop[top].z;
      if (higher > k_point_size * size ||
          (higher > -k_point_size * size && std::abs(frame.loop[i].y - frame.center.y) < std::abs(frame.loop[top].y - frame.center.y)))
        top = i;
    }
    if (top == 0)
      refuse_section(ErrorCode::bad_argument, "frame '" + frame.name + "' has its highest point at its first point, which must be at the bottom",
                     {{frame.loop.front(), "first point"}});
    return halves_of(frame.loop, top, m);
  }
  if (!(frame.width > 0.0 && frame.height > 0.0))
    refuse_section(ErrorCode::bad_argument, "frame '" + frame.name + "' is " + std::to_string(frame.width) + " m wide and " + std::to_string(frame.height) +
                                                " m high; both must be positive");
  const auto location = [&](Uv p) { return frame.center + Vec3{0.0, 0.5 * frame.width * p.u, 0.5 * frame.height * p.v}; };
  if (frame.shape == FrameShape::points) {
    std::vector<Point> loop;
    for (const Uv p : frame.points) loop.push_back(location(p));
    const std::size_t top = loop.size() - 1;
    for (std::size_t i = top; i-- > 0;)
      if (i > 0 || frame.points[0].u != 0.0) loop.push_back(location({-frame.points[i].u, frame.points[i].v}));
    return halves_of(loop, top, m);
  }
  const std::function<Uv(double)> shape = shape_of(frame);
  const std::vector<double> fractions = even_fractions(m);
  std::vector<Point> right = at_fractions([&](double a) { return location(shape(a)); }, 0.0, std::numbers::pi, fractions);
  right.front().y = right.back().y = frame.center.y;
  std::vector<Point> left;
  for (std::size_t i = right.size(); i-- > 0;) left.push_back({right[i].x, 2.0 * frame.center.y - right[i].y, right[i].z});
  return closed(std::move(right), left);
}

}  // namespace sterna
