// Wings: rows of points through the sections -> a surface around the airfoil between sections, split at leading edge -> upper and lower faces over
// shared edges -> trailing edge and tips.
#include <algorithm>
#include <cmath>
#include <numbers>

#include "geom/base/error.h"
#include "geom/model/components.h"
#include "geom/model/model_builder.h"
#include "geom/model/nurbs_surface.h"
#include "geom/model/nurbs_tools.h"
#include "geom/model/section_rows.h"
#include "geom/model/spline.h"

namespace sterna {
namespace {

constexpr std::size_t k_side_points = k_wing_side_points;
/// First and last section of a symmetric wing that are nearer to each other than this part of the span: the wing is a ring.
constexpr double k_ring = 1e-6;

/// What a section's faces share.
struct Station {
  CornerId leading, upper, lower;  ///< upper == lower where the trailing edge is sharp
  EdgeId upper_side, lower_side, thickness;
};

class WingBuilder {
 public:
  WingBuilder(const Wing& wing, const Transform& map)
      : wing_(wing), map_(map * transform_of(wing.placement)), builder_({wing.name, wing.is_pylon ? ComponentKind::pylon : ComponentKind::wing}) {}
  Model build();

 private:
  void make_rows();
  void make_panels();
  void make_sides(const std::vector<std::size_t>& sections, Station& from, Station* to_known, Station& to);
  Station station(const NurbsSurfaceForm& upper, const NurbsSurfaceForm& lower, double v, const std::vector<Point>& row);
  void tip(const Station& at, std::size_t section, std::size_t neighbour, const EndCap& cap);

  const Wing& wing_;
  Transform map_;
  ModelBuilder builder_;
  std::vector<std::vector<Point>> rows_;
  std::vector<bool> is_break_;
  bool is_blunt_ = true;
  bool is_ring_ = false;
};

void WingBuilder::make_rows() {
  const auto refuse = [&](const std::string& problem) { throw Error({.code = ErrorCode::bad_argument, .attempted = "making wing '" + wing_.name + "'", .problem = problem}); };
  if (wing_.sections.size() < 2) refuse("it has " + std::to_string(wing_.sections.size()) + " sections; at least 2 are needed");
  WingRows made = wing_rows(wing_);
  rows_ = std::move(made.rows);
  is_blunt_ = made.is_blunt;
  for (const WingSection& section : wing_.sections) is_break_.push_back(section.is_break || !wing_.is_cubic);
  if (wing_.is_symmetric) {
    is_break_.back() = true;
    for (std::size_t i = wing_.sections.size() - 1; i-- > 0;) is_break_.push_back(is_break_[i]);
    double off = 0.0;
    for (std::size_t k = 0; k < rows_.front().size(); ++k) off = std::max(off, distance(rows_.front()[k], rows_.back()[k]));
    is_ring_ = off <= k_ring * distance(rows_.front().front(), rows_[rows_.size() / 2].front());
    if (is_ring_) rows_.back() = rows_.front();
  }
  is_break_.front() = is_break_.back() = true;
  for (std::vector<Point>& row : rows_)
    for (Point& p : row) p = map_.point(p);
  for (std::size_t i = 1; i < rows_.size(); ++i)
    if (distance(rows_[i].front(), rows_[i - 1].front()) + distance(rows_[i][k_side_points], rows_[i - 1][k_side_points]) == 0.0)
      refuse("two neighbouring sections, number " + std::to_string(i) + " and " + std::to_string(i + 1) + " along the whole span, stand in the same place");
}

Station WingBuilder::station(const NurbsSurfaceForm& upper, const NurbsSurfaceForm& lower, double v, const std::vector<Point>& row) {
  Station s;
  s.leading = builder_.corner(row[k_side_points]);
  s.upper = builder_.corner(row.front());
  s.lower = is_blunt_ ? builder_.corner(row.back()) : s.upper;
  s.upper_side = builder_.edge(line_of_constant_v(upper, v), {0.0, 1.0}, s.upper, s.leading);
  s.lower_side = builder_.edge(line_of_constant_v(lower, v), {0.0, 1.0}, s.lower, s.leading);
  if (is_blunt_) s.thickness = builder_.straight_edge(s.upper, s.lower);
  return s;
}

/// The faces between two breaks. `to_known`: the station already exists (a ring closes).
void WingBuilder::make_sides(const std::vector<std::size_t>& sections, Station& from, Station* to_known, Station& to) {
  const std::size_t n = sections.size();
  PointGrid grid{2 * k_side_points + 1, n, {}};
  for (std::size_t i = 0; i < grid.n_u; ++i)
    for (const std::size_t section : sections) grid.points.push_back(rows_[section][i]);
  SplineOptions around{.tangents = SplineTangents::not_a_knot, .at = airfoil_stations(k_side_points)};
  for (std::size_t k = k_side_points; k-- > 0;) around.at.push_back(2.0 - around.at[k]);
  const NurbsSurfaceForm form = spline_surface_form(grid, around, {.tangents = n == 2 ? SplineTangents::linear : SplineTangents::natural});
  const Interval v{form.knots_v.front(), form.knots_v.back()};
  const NurbsSurfaceForm upper = restricted(form, {0.0, 1.0}, v);
  NurbsSurfaceForm lower = reversed_u(restricted(form, {1.0, 2.0}, v));
  lower.knots_u = upper.knots_u;  // stations are mirrored: the same but for rounding
  const std::string kind = n == 2 ? "linear-cubic spline" : "bicubic spline";
  const auto upper_surface = std::make_shared<NurbsSurface>(upper, false, false, kind), lower_surface = std::make_shared<NurbsSurface>(lower, false, false, kind);
  if (!from.leading.is_valid()) from = station(upper, lower, v.from, rows_[sections.front()]);
  to = to_known ? *to_known : station(upper, lower, v.to, rows_[sections.back()]);
  const EdgeId leading = builder_.edge(line_of_constant_u(upper, 1.0), v, from.leading, to.leading, "leading edge");
  const EdgeId upper_trailing = builder_.edge(line_of_constant_u(upper, 0.0), v, from.upper, to.upper, "trailing edge");
  const EdgeId lower_trailing = is_blunt_ ? builder_.edge(line_of_constant_u(lower, 0.0), v, from.lower, to.lower, "trailing edge") : upper_trailing;
  const ParameterBox box{{0.0, 1.0}, v};
  builder_.patch(upper_surface, box, {from.upper_side, leading, to.upper_side, upper_trailing}, FaceRole::upper, wing_.name);
  builder_.patch(lower_surface, box, {from.lower_side, leading, to.lower_side, lower_trailing}, FaceRole::lower, wing_.name);
  if (!is_blunt_) return;
  NurbsSurfaceForm base{1, upper.degree_v, {0.0, 0.0, 1.0, 1.0}, upper.knots_v, 2, upper.n_v, {}, {}};
  for (std::size_t j = 0; j < upper.n_v; ++j) base.poles.push_back(upper.poles[j]);
  for (std::size_t j = 0; j < lower.n_v; ++j) base.poles.push_back(lower.poles[j]);
  builder_.patch(std::make_shared<NurbsSurface>(base), box, {from.thickness, lower_trailing, to.thickness, upper_trailing}, FaceRole::trailing_edge, wing_.name);
}

void WingBuilder::make_panels() {
  Station first, at;
  std::size_t from = 0;
  for (std::size_t i = 1; i < rows_.size(); ++i) {
    if (!is_break_[i]) continue;
    std::vector<std::size_t> sections;
    for (std::size_t k = from; k <= i; ++k) sections.push_back(k);
    Station next;
    make_sides(sections, at, is_ring_ && i + 1 == rows_.size() ? &first : nullptr, next);
    if (from == 0) first = at;
    at = next;
    from = i;
  }
  if (is_ring_) return;
  tip(first, 0, 1, wing_.right_tip);
  tip(at, rows_.size() - 1, rows_.size() - 2, wing_.left_tip);
}

/// Flat, or half ellipses between upper and lower side as rational quadratics: side, side + bulge, crest line, side + bulge, side. The bulge is the
/// section's half thickness times the height, outwards along the section's normal.
void WingBuilder::tip(const Station& at, std::size_t section, std::size_t neighbour, const EndCap& cap) {
  if (!(cap.height > 0.0)) {
    std::vector<EdgeId> border{at.upper_side, at.lower_side};
    if (is_blunt_) border.push_back(at.thickness);
    builder_.plane(border, FaceRole::tip, wing_.name);
    return;
  }
  const std::vector<Point>& row = rows_[section];
  Vec3 outwards;
  for (std::size_t i = 0; i + 1 < row.size(); ++i) outwards += cross(row[i] - row[0], row[i + 1] - row[0]);
  outwards = normalized(outwards);
  const Vec3 along = 0.5 * (row.front() + row[k_side_points]) - 0.5 * (rows_[neighbour].front() + rows_[neighbour][k_side_points]);
  if (dot(outwards, along) < 0.0) outwards = -outwards;
  const Vec3 chord = normalized(0.5 * (row.front() + row.back()) - row[k_side_points]);
  const NurbsCurveForm<Point> upper = *builder_.model().edges[at.upper_side].curve->exact_nurbs(), lower = *builder_.model().edges[at.lower_side].curve->exact_nurbs();
  Vec3 up = cross(outwards, chord);
  double side = 0.0;
  for (std::size_t i = 0; i < upper.poles.size(); ++i) side += dot(upper.poles[i] - lower.poles[i], up);
  if (side < 0.0) up = -up;
  NurbsSurfaceForm form{3, 2, upper.knots, {0.0, 0.0, 0.0, 0.5, 0.5, 1.0, 1.0, 1.0}, upper.poles.size(), 5, {}, {}};
  for (std::size_t i = 0; i < form.n_u; ++i) {
    const Point &a = upper.poles[i], &b = lower.poles[i];
    const Vec3 bulge = cap.height * 0.5 * dot(a - b, up) * outwards;
    form.poles.insert(form.poles.end(), {a, a + bulge, 0.5 * (a + b) + bulge, b + bulge, b});
    form.weights.insert(form.weights.end(), {1.0, std::numbers::sqrt2 / 2.0, 1.0, std::numbers::sqrt2 / 2.0, 1.0});
  }
  const EdgeId nose = builder_.pole(at.leading);
  EdgeId base;
  if (is_blunt_) {
    base = builder_.edge(line_of_constant_u(form, 0.0), {0.0, 1.0}, at.upper, at.lower);
    builder_.plane({base, at.thickness}, FaceRole::trailing_edge, wing_.name);
  } else {
    base = builder_.pole(at.upper);
  }
  builder_.patch(std::make_shared<NurbsSurface>(form), {{0.0, 1.0}, {0.0, 1.0}}, {at.upper_side, nose, at.lower_side, base}, FaceRole::tip, wing_.name);
}

Model WingBuilder::build() {
  make_rows();
  make_panels();
  return builder_.closed_solid(wing_.name);
}

}  // namespace

Model make_wing(const Wing& wing, const Transform& map) { return WingBuilder(wing, map).build(); }

}  // namespace sterna
