#include "geom/model/shapes.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>
#include <optional>

#include "geom/base/error.h"
#include "geom/model/airfoil.h"
#include "geom/model/analytic_surfaces.h"
#include "geom/model/curves.h"
#include "geom/model/model_builder.h"
#include "geom/model/nurbs_curve.h"
#include "geom/model/nurbs_surface.h"
#include "geom/model/section_rows.h"

namespace sterna {
namespace {

/// Station of a duct with rectangular sections. The walls between stations are cubics, straight or parallel to x at both ends; the ends of the duct are flat.
struct DuctStation {
  double x, half_width, half_height;
  bool is_level = false;  ///< the part that begins here has walls parallel to x at both ends
};

class DuctBuilder {
 public:
  DuctBuilder(const std::vector<DuctStation>& stations, const Component& component) : stations_(stations), builder_(component) {}

  Model build(const std::string& wall, FaceRole wall_role, const std::string& first, FaceRole first_role, const std::string& last, FaceRole last_role) {
    for (const DuctStation& s : stations_) add_station(s);
    constexpr std::array<const char*, 4> k_sides = {"_floor", "_right", "_ceiling", "_left"};
    std::array<std::string, 4> names;
    for (std::size_t k = 0; k < 4; ++k) names[k] = wall + k_sides[k];
    for (std::size_t i = 0; i + 1 < stations_.size(); ++i) add_walls(i, names, wall_role);
    builder_.plane({rings_.front().begin(), rings_.front().end()}, first_role, first);
    builder_.plane({rings_.back().begin(), rings_.back().end()}, last_role, last);
    return builder_.closed_solid(wall);
  }

 private:
  using Corners = std::array<CornerId, 4>;
  static Point corner_point(const DuctStation& s, std::size_t k) {
    constexpr std::array<std::array<double, 2>, 4> k_sides{{{-1.0, -1.0}, {1.0, -1.0}, {1.0, 1.0}, {-1.0, 1.0}}};
    return {s.x, k_sides[k][0] * s.half_width, k_sides[k][1] * s.half_height};
  }
  void add_station(const DuctStation& s) {
    Corners corners;
    std::array<EdgeId, 4> ring;
    for (std::size_t k = 0; k < 4; ++k) corners[k] = builder_.corner(corner_point(s, k));
    for (std::size_t k = 0; k < 4; ++k) ring[k] = builder_.straight_edge(corners[k], corners[(k + 1) % 4]);
    corners_.push_back(corners);
    rings_.push_back(ring);
  }
  void add_walls(std::size_t i, const std::array<std::string, 4>& names, FaceRole role) {
    const DuctStation &a = stations_[i], &b = stations_[i + 1];
    const double arm = a.is_level ? 0.5 * (b.x - a.x) : 0.0;
    std::array<std::vector<Point>, 4> poles;
    std::array<EdgeId, 4> edges;
    for (std::size_t k = 0; k < 4; ++k) {
      const Point p = corner_point(a, k), q = corner_point(b, k);
      if (a.is_level) poles[k] = {p, p + Vec3{arm, 0.0, 0.0}, q - Vec3{arm, 0.0, 0.0}, q};
      else poles[k] = {p, p + (q - p) / 3.0, q - (q - p) / 3.0, q};
      edges[k] = builder_.edge(std::make_shared<NurbsCurve>(NurbsCurveForm<Point>{3, k_bezier, poles[k], {}}), {0.0, 1.0}, corners_[i][k], corners_[i + 1][k]);
    }
    for (std::size_t k = 0; k < 4; ++k) {
      const std::size_t next = (k + 1) % 4;
      NurbsSurfaceForm form{1, 3, {0.0, 0.0, 1.0, 1.0}, k_bezier, 2, 4, poles[k], {}};
      form.poles.insert(form.poles.end(), poles[next].begin(), poles[next].end());
      builder_.patch(std::make_shared<NurbsSurface>(form), {{0.0, 1.0}, {0.0, 1.0}}, {rings_[i][k], edges[next], rings_[i + 1][k], edges[k]}, role, names[k]);
    }
  }

  inline static const std::vector<double> k_bezier{0.0, 0.0, 0.0, 0.0, 1.0, 1.0, 1.0, 1.0};
  const std::vector<DuctStation>& stations_;
  ModelBuilder builder_;
  std::vector<Corners> corners_;
  std::vector<std::array<EdgeId, 4>> rings_;
};

/// Returns NACA's symmetric 4-digit section of any thickness, closed at the trailing edge: its heights are proportional to the thickness.
std::vector<Uv> symmetric_section(double thickness) {
  std::vector<Uv> points = with_trailing_edge(naca_airfoil("0010", 40), 0.0).points;
  for (Uv& p : points) p.v *= thickness / 0.1;
  return points;
}

}  // namespace

Model make_box(const std::string& name, const Point& from, const Point& to) {
  for (std::size_t axis = 0; axis < 3; ++axis)
    if (!(to[axis] > from[axis]))
      throw_bad_argument("making box '" + name + "'", "the corners " + format_point(from) + " and " + format_point(to) + " must ascend in x, y and z");
  ModelBuilder builder({name, ComponentKind::box});
  std::array<CornerId, 8> corners;
  for (std::size_t i = 0; i < 8; ++i) corners[i] = builder.corner({i & 1 ? to.x : from.x, i & 2 ? to.y : from.y, i & 4 ? to.z : from.z});
  std::array<std::array<EdgeId, 8>, 8> edges{};
  for (std::size_t i = 0; i < 8; ++i)
    for (const std::size_t bit : {1u, 2u, 4u})
      if (!(i & bit)) edges[i][i | bit] = edges[i | bit][i] = builder.straight_edge(corners[i], corners[i | bit]);
  for (const auto& [a, b] : {std::pair<std::size_t, std::size_t>{1, 2}, {2, 4}, {4, 1}})
    for (const std::size_t side : {std::size_t{0}, 7 - a - b})
      builder.plane({edges[side][side | a], edges[side | a][side | a | b], edges[side | a | b][side | b], edges[side | b][side]}, FaceRole::skin, name);
  return builder.closed_solid(name);
}

Model make_cylinder(const std::string& name, const Point& from, const Point& to, double radius) {
  const double length = distance(from, to);
  if (!(length > 0.0) || !(radius > 0.0))
    throw_bad_argument("making cylinder '" + name + "'",
                       "the cylinder is " + std::to_string(length) + " m long and has a radius of " + std::to_string(radius) + " m; both must be positive");
  ModelBuilder builder({name, ComponentKind::body});
  const Frame frame = frame_along(from, to - from);
  const double pi = std::numbers::pi;
  const auto surface = std::make_shared<CylinderSurface>(frame, radius, ParameterBox{k_full_turn, {0.0, length}});
  std::array<std::array<CornerId, 2>, 2> corners;
  std::array<std::array<EdgeId, 2>, 2> halves;
  for (std::size_t end = 0; end < 2; ++end) {
    const Point center = end == 0 ? from : to;
    const CurvePtr curve = std::make_shared<EllipseCurve>(center, radius * frame.x, radius * frame.y, k_full_turn);
    corners[end] = {builder.corner(center + radius * frame.x), builder.corner(center - radius * frame.x)};
    halves[end] = {builder.edge(curve, {0.0, pi}, corners[end][0], corners[end][1]), builder.edge(curve, {pi, 2.0 * pi}, corners[end][1], corners[end][0])};
  }
  const std::array<EdgeId, 2> sides{builder.straight_edge(corners[0][0], corners[1][0]), builder.straight_edge(corners[0][1], corners[1][1])};
  builder.patch(surface, {{0.0, pi}, {0.0, length}}, {halves[0][0], sides[1], halves[1][0], sides[0]}, FaceRole::skin, name);
  builder.patch(surface, {{pi, 2.0 * pi}, {0.0, length}}, {halves[0][1], sides[0], halves[1][1], sides[1]}, FaceRole::skin, name);
  builder.plane({halves[0][0], halves[0][1]}, FaceRole::nose, name);
  builder.plane({halves[1][0], halves[1][1]}, FaceRole::tail, name);
  return builder.closed_solid(name);
}

Model make_test_section(const TestSectionOptions& o) {
  const std::string attempted = "making a test section";
  TestSectionOptions checked = o;
  require_options(options_of(checked), attempted);
  const double start = is_automatic(o.upstream) ? -0.5 * o.length : -o.upstream;
  const bool has_contraction = o.contraction_length > 0.0 && o.contraction_ratio > 1.0;
  if (!is_automatic(o.diameter)) {
    if (!is_automatic(o.width) || !is_automatic(o.height))
      throw_bad_argument(attempted, "both diameter and width or height are given; for a round section give only the diameter");
    if (has_contraction || o.diffuser_length > 0.0) throw_bad_argument(attempted, "round sections have neither contraction nor diffuser");
    Model model = make_cylinder(o.wall, {start, 0.0, 0.0}, {start + o.length, 0.0, 0.0}, 0.5 * o.diameter);
    model.components.raw().front().kind = ComponentKind::tunnel;
    for (ModelFace& face : model.faces) {
      face.role = face.role == FaceRole::nose ? FaceRole::inflow : face.role == FaceRole::tail ? FaceRole::outflow : FaceRole::wall;
      face.name = face.role == FaceRole::inflow ? o.inflow : face.role == FaceRole::outflow ? o.outflow : o.wall;
    }
    turn_inside_out(model);  // the fluid is inside
    return model;
  }
  if (is_automatic(o.width) || is_automatic(o.height)) throw_bad_argument(attempted, "give width and height, or the diameter of a round section");
  std::vector<DuctStation> stations;
  if (has_contraction) {
    const double scale = std::sqrt(o.contraction_ratio);
    stations.push_back({start - o.contraction_length, 0.5 * scale * o.width, 0.5 * scale * o.height, true});
  }
  stations.push_back({start, 0.5 * o.width, 0.5 * o.height});
  stations.push_back({start + o.length, 0.5 * o.width, 0.5 * o.height});
  if (o.diffuser_length > 0.0) {
    const double wider = o.diffuser_length * std::tan(o.diffuser_angle);
    stations.push_back({start + o.length + o.diffuser_length, 0.5 * o.width + wider, 0.5 * o.height + wider});
  }
  Model model = DuctBuilder(stations, {o.wall, ComponentKind::tunnel}).build(o.wall, FaceRole::wall, o.inflow, FaceRole::inflow, o.outflow, FaceRole::outflow);
  turn_inside_out(model);  // the fluid is inside
  return model;
}

/// Fullness of a nacelle's lip. Intakes are much deeper than their lip is thick, and a quarter ellipse down to the fan would have a very sharp leading edge (2
/// mm of radius on an engine of 4 m). This lip has a radius of about a quarter of its thickness, and is almost straight behind.
constexpr double k_full_lip = 1.6;

Body nacelle_body(const std::string& name, const Point& position, const NacelleOptions& o) {
  NacelleOptions checked = o;
  require_options(options_of(checked), "making nacelle '" + name + "'");
  if (!(o.fan_ratio < o.highlight_ratio))
    throw_bad_argument("making nacelle '" + name + "'",
                       "fan_ratio is " + std::to_string(o.fan_ratio) + "; it must be below highlight_ratio (" + std::to_string(o.highlight_ratio) + ")");
  Body body{.name = name, .placement = {position, {}}};
  const auto add = [&](double x, double ratio) {
    body.frames.push_back(
        {.name = "x" + std::to_string(x), .center = {x * o.length, 0.0, 0.0}, .height = ratio * o.diameter, .width = ratio * o.diameter, .n_points = 11});
  };
  // The front is a quarter ellipse from the highlight to the largest diameter, the rear a parabola to the exit. The frames are dense at the start of the
  // ellipse, so that it starts perpendicular to the axis: any missing turning of the cowl would have to be in the lip.
  for (const double t : {0.0, 0.005, 0.02, 0.07, 0.18, 0.38, 0.65})
    add(t * o.thickest, o.highlight_ratio + (1.0 - o.highlight_ratio) * std::sqrt(1.0 - (1.0 - t) * (1.0 - t)));
  for (const double t : {0.0, 0.35, 0.7, 1.0}) add(o.thickest + t * (1.0 - o.thickest), 1.0 - (1.0 - o.exit_ratio) * t * t);
  const double radius = 0.5 * o.highlight_ratio * o.diameter;
  body.lip = InletLip{o.fan_depth * o.length / radius, 1.0 - o.fan_ratio / o.highlight_ratio, k_full_lip};
  return body;
}

namespace {

/// Distance of a pylon's lower end below the body's surface, as a fraction of the half height.
constexpr double k_pylon_sink = 0.02;
/// Number of samples of the section at that lower end.
constexpr int k_pylon_stations = 40;
/// If the trailing edge is farther back than this, relative to the body's length, it is placed behind the body, because there is no room to leave through the
/// surface before the end plane.
constexpr double k_last_trailing = 0.98;
/// A section whose trailing edge is behind the body must leave the surface before the end plane. In that plane it is outside by this fraction of the half
/// height.
constexpr double k_pylon_rise = 0.05;

/// Upper (side 1) or lower outline of a body over x in its own axes. It is straight between frames, and so lies inside convex bodies.
class BodyOutline {
 public:
  BodyOutline(const Body& body, double side) : body_(body), side_(side) {}
  double front() const { return body_.frames.front().center.x; }
  double length() const { return body_.frames.back().center.x - front(); }
  /// Returns the distance of the surface from z = 0 towards the side, at a lateral distance from the frames' middle; nothing if the body is narrower.
  std::optional<double> height(double x, double across = 0.0) const {
    const auto [i, t] = location(x);
    const BodyFrame &a = body_.frames[i], &b = body_.frames[i + 1];
    const double half_height = 0.5 * ((1.0 - t) * a.height + t * b.height), half_width = 0.5 * ((1.0 - t) * a.width + t * b.width);
    if (!(std::abs(across) < half_width)) return std::nullopt;
    return side_ * ((1.0 - t) * a.center.z + t * b.center.z) + half_height * std::sqrt(1.0 - (across / half_width) * (across / half_width));
  }
  double half_height(double x) const {
    const auto [i, t] = location(x);
    return 0.5 * ((1.0 - t) * body_.frames[i].height + t * body_.frames[i + 1].height);
  }

 private:
  std::pair<std::size_t, double> location(double x) const {
    std::size_t i = 0;
    while (i + 2 < body_.frames.size() && x > body_.frames[i + 1].center.x) ++i;
    const double from = body_.frames[i].center.x, to = body_.frames[i + 1].center.x;
    return {i, std::clamp((x - from) / (to - from), 0.0, 1.0)};
  }
  const Body& body_;
  double side_;
};

/// Returns the leading and the trailing edge of the pylon's lower section in the axes of the body, as (x, distance from z = 0 towards the wing). The whole
/// section lies just below the surface of the body. Its trailing edge is so close to the surface that it comes out through the surface, not through the end
/// plane of the body.
std::array<Uv, 2> ends_at_surface(const BodyOutline& outline, const PylonOptions& o, Uv wing_trailing, const std::string& attempted) {
  const double end = outline.front() + outline.length();
  Uv leading{outline.front() + o.nacelle_from * outline.length(), 0.0}, trailing{outline.front() + o.nacelle_to * outline.length(), 0.0};
  leading.v = *outline.height(leading.u) - k_pylon_sink * outline.half_height(leading.u);
  const bool is_behind = o.nacelle_to > k_last_trailing;
  if (is_behind) {
    trailing.v = *outline.height(end) + k_pylon_rise * outline.half_height(end);
  } else {
    double sink = k_pylon_sink * outline.half_height(trailing.u);
    // On its way to the wing the trailing edge gains height over the surface; half of the room to the end is sufficient.
    const double room = 0.5 * (end - trailing.u), top = *outline.height(trailing.u);
    const double climb = wing_trailing.u > trailing.u ? (wing_trailing.v - top) / (wing_trailing.u - trailing.u) : std::numeric_limits<double>::infinity();
    const double fall = (top - *outline.height(trailing.u + room)) / room;
    if (std::isfinite(climb)) sink = std::min(sink, room * (climb + fall));
    if (!(sink > 0.0))
      throw_bad_argument(attempted,
                         "the trailing edge of the pylon leaves the nacelle through its end plane instead of its surface; nacelle_to or wing_to must "
                         "be less");
    trailing.v = top - sink;
  }
  // The section is thick and the surface is round. Where the section would protrude on either side of its middle, its leading end is lowered.
  for (int i = 0; i < k_pylon_stations; ++i) {
    const double t = static_cast<double>(i) / k_pylon_stations, x = leading.u + t * (trailing.u - leading.u);
    if (is_behind && leading.v + t * (trailing.v - leading.v) > *outline.height(x)) break;  // from here on it is in the air behind the body
    const auto top = outline.height(x, 0.5 * o.thickness * (trailing.u - leading.u));
    if (!top) throw_bad_argument(attempted, "the pylon is thicker than the width of the nacelle: reduce thickness");
    // Near the trailing edge the section is thin again.
    if (t < 0.7) leading.v = std::min(leading.v, (*top - t * trailing.v) / (1.0 - t) - 0.1 * k_pylon_sink * outline.half_height(x));
  }
  return {leading, trailing};
}

}  // namespace

Wing pylon_wing(const std::string& name, const Wing& wing, const Body& nacelle, const PylonOptions& o) {
  const std::string attempted = "making pylon '" + name + "'";
  if (!(o.nacelle_from < o.nacelle_to) || !(o.wing_from < o.wing_to))
    throw_bad_argument(attempted, "the leading edges must lie before the trailing edges (nacelle_from < nacelle_to, wing_from < wing_to)");
  const Transform nacelle_map = transform_of(nacelle.placement), wing_map = transform_of(wing.placement);
  const Point front = nacelle_map.point(nacelle.frames.front().center), back = nacelle_map.point(nacelle.frames.back().center);
  const double y = 0.5 * (front.y + back.y);
  struct Line {
    Point leading, trailing;
  };
  std::vector<Line> lines;
  for (const WingSection& section : wing.sections) {
    const std::vector<Point> loop = section_loop(section, std::nullopt);
    const Point trailing = 0.5 * (loop.front() + loop.back());
    lines.push_back({wing_map.point(*std::max_element(loop.begin(), loop.end(),
                                                      [&](const Point& a, const Point& b) { return distance(a, trailing) < distance(b, trailing); })),
                     wing_map.point(trailing)});
  }
  const double side = wing.is_symmetric && y * lines.front().leading.y < 0.0 ? -1.0 : 1.0;  // the other half of the wing
  const std::size_t n = lines.size();
  std::optional<Line> local;
  for (std::size_t i = 0; i + 1 < n && !local; ++i) {
    const double a = lines[i].leading.y, b = lines[i + 1].leading.y;
    if (a == b || (side * y - a) * (side * y - b) > 0.0) continue;
    const double t = (side * y - a) / (b - a);
    local = Line{lines[i].leading + t * (lines[i + 1].leading - lines[i].leading), lines[i].trailing + t * (lines[i + 1].trailing - lines[i].trailing)};
  }
  if (!local)
    throw_bad_argument(attempted, "nacelle '" + nacelle.name + "' is at y = " + std::to_string(y) + " m, where wing '" + wing.name + "' has no section");
  const Vec3 chord = local->trailing - local->leading;
  const auto section = [&](const std::string& label, const Point& leading, const Point& trailing) {
    WingSection s{.name = label, .leading_edge = leading, .chord = distance(leading, trailing)};
    for (const Uv p : symmetric_section(o.thickness)) s.loop.push_back(leading + p.u * (trailing - leading) + Vec3{0.0, p.v * s.chord, 0.0});
    for (Point& p : s.loop) p.y += y - leading.y;
    s.leading_edge.y = y;
    return s;
  };
  // Points from the surface that faces the wing, in the nacelle's axes.
  const Transform into_nacelle = nacelle_map.inverse();
  const Point wing_trailing = into_nacelle.point(local->leading + o.wing_to * chord), wing_leading = into_nacelle.point(local->leading + o.wing_from * chord);
  const double up = 0.5 * (wing_leading.z + wing_trailing.z) < 0.5 * (nacelle.frames.front().center.z + nacelle.frames.back().center.z) ? -1.0 : 1.0;
  const auto ends = ends_at_surface(BodyOutline(nacelle, up), o, {wing_trailing.x, up * wing_trailing.z}, attempted);
  const auto on_nacelle = [&](Uv at) { return nacelle_map.point({at.u, 0.0, up * at.v}); };
  Wing pylon{.name = name, .is_pylon = true};
  pylon.sections = {section("nacelle", on_nacelle(ends[0]), on_nacelle(ends[1])),
                    section("wing", local->leading + o.wing_from * chord, local->leading + o.wing_to * chord)};
  pylon.trailing_edge = 0.0;
  pylon.right_tip = pylon.left_tip = {CapShape::strip, 0.0};
  return pylon;
}

}  // namespace sterna
