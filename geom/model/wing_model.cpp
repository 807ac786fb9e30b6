// Wings: rows of points through the sections -> a surface around the airfoil between sections, split at leading edge -> upper and lower faces over
// shared edges, patches cut out of them -> trailing edge and tips.
#include <algorithm>
#include <cmath>
#include <map>
#include <numbers>

#include "geom/base/error.h"
#include "geom/model/components.h"
#include "geom/model/model_builder.h"
#include "geom/model/nurbs_surface.h"
#include "geom/model/nurbs_tools.h"
#include "geom/model/section_rows.h"
#include "geom/model/side_graph.h"
#include "geom/model/spline.h"

namespace sterna {
namespace {

constexpr std::size_t k_side_points = k_wing_side_points;
/// First and last section of a symmetric wing that are nearer to each other than this part of the span: the wing is a ring.
constexpr double k_ring = 1e-6;

/// What the faces at both sides of a section share.
struct Station {
  SplitCurve upper, lower;  ///< from the trailing to the leading edge
  EdgeId thickness;         ///< where the trailing edge is blunt; else upper and lower begin at the same corner
  CornerId leading() const { return upper.corners.back(); }
};

/// Upper and lower side between two breaks. u: 0 trailing edge .. 1 leading edge on both; v along the span.
struct Panel : WingPanel {
  NurbsSurfaceForm upper, lower;
  SurfacePtr upper_surface, lower_surface;
};

double first_place(const WingPatch& patch) { return patch.border.front().section; }
double last_place(const WingPatch& patch) { return patch.border.back().section; }

/// Where a patch's border crosses the sides at a place within it.
WingPatch::Place crossing_at(const WingPatch& patch, double place) {
  std::size_t i = 1;
  while (i + 1 < patch.border.size() && place > patch.border[i].section) ++i;
  const WingPatch::Place &a = patch.border[i - 1], &b = patch.border[i];
  if (place == a.section || place == b.section) return place == a.section ? a : b;
  const double t = (place - a.section) / (b.section - a.section);
  return {place, a.upper + t * (b.upper - a.upper), a.lower + t * (b.lower - a.lower)};
}

void add_sorted(std::vector<double>& values, double value) {
  const auto at = std::lower_bound(values.begin(), values.end(), value);
  if (at == values.end() || *at != value) values.insert(at, value);
}

class WingBuilder {
 public:
  WingBuilder(const Wing& wing, const Transform& map)
      : wing_(wing), map_(map * transform_of(wing.placement)), builder_({wing.name, wing.is_pylon ? ComponentKind::pylon : ComponentKind::wing}) {}
  Model build();

 private:
  using Crossing = double WingPatch::Place::*;
  void make_rows();
  void make_panels();
  Panel panel(std::size_t first_row, std::size_t last_row) const;
  void make_part(const Panel& panel, double from_place, double to_place, const Station& from, const Station& to);
  void make_side(const Panel& panel, Crossing side, double from_place, double to_place, const Station& from, const Station& to, const SplitCurve& leading, const SplitCurve& trailing);
  Station station(const Panel& panel, double place);
  const WingPatch* patch_over(ControlKind kind, double from_place, double to_place) const;
  std::vector<double> patch_ends(ControlKind kind, double from_place, double to_place) const;
  void tip(const Station& at, std::size_t section, std::size_t neighbour, const EndCap& cap);

  const Wing& wing_;
  Transform map_;
  ModelBuilder builder_;
  std::vector<std::vector<Point>> rows_;
  std::vector<bool> is_break_;
  bool is_blunt_ = true;
  bool is_ring_ = false;
  bool is_sampled_ = false;
};

void WingBuilder::make_rows() {
  const auto refuse = [&](const std::string& problem) { throw Error({.code = ErrorCode::bad_argument, .attempted = "making wing '" + wing_.name + "'", .problem = problem}); };
  if (wing_.sections.size() < 2) refuse("it has " + std::to_string(wing_.sections.size()) + " sections; at least 2 are needed");
  WingRows made = wing_rows(wing_);
  rows_ = std::move(made.rows);
  is_blunt_ = made.is_blunt;
  is_sampled_ = made.is_sampled;
  is_break_ = std::move(made.is_break);
  if (wing_.is_symmetric) {
    double off = 0.0;
    for (std::size_t k = 0; k < rows_.front().size(); ++k) off = std::max(off, distance(rows_.front()[k], rows_.back()[k]));
    is_ring_ = off <= k_ring * distance(rows_.front().front(), rows_[rows_.size() / 2].front());
    if (is_ring_) rows_.back() = rows_.front();
  }
  for (std::vector<Point>& row : rows_)
    for (Point& p : row) p = map_.point(p);
  for (std::size_t i = 1; i < rows_.size(); ++i)
    if (distance(rows_[i].front(), rows_[i - 1].front()) + distance(rows_[i][k_side_points], rows_[i - 1][k_side_points]) == 0.0)
      refuse("two neighbouring sections, number " + std::to_string(i) + " and " + std::to_string(i + 1) + " along the whole span, stand in the same place");
}

Panel WingBuilder::panel(std::size_t first_row, std::size_t last_row) const {
  Panel panel{wing_panel(rows_, first_row, last_row, is_sampled_), {}, {}, {}, {}};
  const Interval v{panel.form.knots_v.front(), panel.form.knots_v.back()};
  panel.upper = restricted(panel.form, {0.0, 1.0}, v);
  panel.lower = reversed_u(restricted(panel.form, {1.0, 2.0}, v));
  panel.lower.knots_u = panel.upper.knots_u;  // stations are mirrored: the same but for rounding
  const std::string kind = last_row == first_row + 1 ? "linear-cubic spline" : "bicubic spline";
  panel.upper_surface = std::make_shared<NurbsSurface>(panel.upper, false, false, kind);
  panel.lower_surface = std::make_shared<NurbsSurface>(panel.lower, false, false, kind);
  return panel;
}

/// The patch of a kind that lies over the whole of a range.
const WingPatch* WingBuilder::patch_over(ControlKind kind, double from_place, double to_place) const {
  for (const WingPatch& patch : wing_.patches)
    if (patch.kind == kind && first_place(patch) <= from_place && last_place(patch) >= to_place) return &patch;
  return nullptr;
}

/// Ends of patches of a kind within a range, and the range's own.
std::vector<double> WingBuilder::patch_ends(ControlKind kind, double from_place, double to_place) const {
  std::vector<double> ends{from_place, to_place};
  for (const WingPatch& patch : wing_.patches)
    for (const double end : {first_place(patch), last_place(patch)})
      if (patch.kind == kind && end > from_place && end < to_place) add_sorted(ends, end);
  return ends;
}

Station WingBuilder::station(const Panel& panel, double place) {
  std::vector<double> upper{0.0, 1.0}, lower{0.0, 1.0};
  for (const WingPatch& patch : wing_.patches)
    if (patch.kind != ControlKind::all_moving && first_place(patch) <= place && last_place(patch) >= place) {
      const WingPatch::Place crossing = crossing_at(patch, place);
      add_sorted(upper, crossing.upper);
      add_sorted(lower, crossing.lower);
    }
  const double v = panel.v(place);
  const CurvePtr upper_curve = line_of_constant_v(panel.upper, v), lower_curve = line_of_constant_v(panel.lower, v);
  const CornerId leading = builder_.corner(upper_curve->point(1.0)), trailing = builder_.corner(upper_curve->point(0.0));
  const CornerId below = is_blunt_ ? builder_.corner(lower_curve->point(0.0)) : trailing;
  return {builder_.split_curve(upper_curve, upper, trailing, leading), builder_.split_curve(lower_curve, lower, below, leading), is_blunt_ ? builder_.straight_edge(trailing, below) : EdgeId()};
}

/// The faces of one side: what the patches leave, and theirs.
void WingBuilder::make_side(const Panel& panel, Crossing side, double from_place, double to_place, const Station& from, const Station& to, const SplitCurve& leading, const SplitCurve& trailing) {
  const bool is_upper = side == &WingPatch::Place::upper;
  const NurbsSurfaceForm& form = is_upper ? panel.upper : panel.lower;
  const SurfacePtr& surface = is_upper ? panel.upper_surface : panel.lower_surface;
  const FaceRole role = is_upper ? FaceRole::upper : FaceRole::lower;
  std::map<std::pair<double, double>, CornerId> corners;
  SideGraph graph;
  const auto add = [&](const SplitCurve& split, bool is_across, double fixed, SideGraph::Mark left = {}, SideGraph::Mark right = {}) {
    const auto place = [&](double t) { return is_across ? Uv{t, fixed} : Uv{fixed, t}; };
    for (std::size_t i = 0; i < split.edges.size(); ++i) graph.add(split.edges[i], place(split.at[i]), place(split.at[i + 1]), left, right);
    for (std::size_t i = 0; i < split.at.size(); ++i) corners.emplace(std::pair(place(split.at[i]).u, place(split.at[i]).v), split.corners[i]);
  };
  const auto corner = [&](Uv at) {
    const auto [found, is_new] = corners.emplace(std::pair(at.u, at.v), CornerId());
    if (is_new) found->second = builder_.corner(surface->point(at));
    return found->second;
  };
  add(is_upper ? from.upper : from.lower, true, panel.v(from_place));
  add(leading, false, 1.0);
  add(is_upper ? to.upper : to.lower, true, panel.v(to_place));
  add(trailing, false, 0.0);
  for (const ControlKind kind : {ControlKind::trailing_edge, ControlKind::leading_edge}) {
    for (const double end : patch_ends(kind, from_place, to_place)) {  // the sides of the patches, across the span
      if (end == from_place || end == to_place) continue;
      const double edge_u = kind == ControlKind::trailing_edge ? 0.0 : 1.0;
      std::vector<double> at{edge_u};
      for (const WingPatch& patch : wing_.patches)
        if (patch.kind == kind && first_place(patch) <= end && last_place(patch) >= end) add_sorted(at, crossing_at(patch, end).*side);
      if (at.size() == 1) continue;  // the border ends at the edge itself
      const double v = panel.v(end);
      SplitCurve across{line_of_constant_v(form, v), at, {}, {}};
      for (const double u : at) across.corners.push_back(corner({u, v}));
      for (std::size_t i = 1; i < at.size(); ++i) across.edges.push_back(builder_.edge(across.curve, {at[i - 1], at[i]}, across.corners[i - 1], across.corners[i]));
      add(across, true, v);
    }
    for (std::size_t k = 0; k < wing_.patches.size(); ++k) {  // their borders, along the span
      const WingPatch& patch = wing_.patches[k];
      if (patch.kind != kind || first_place(patch) >= to_place || last_place(patch) <= from_place) continue;
      std::vector<double> places{std::max(from_place, first_place(patch)), std::min(to_place, last_place(patch))};
      for (const WingPatch::Place& p : patch.border)
        if (p.section > places.front() && p.section < places.back()) add_sorted(places, p.section);
      for (std::size_t i = 1; i < places.size(); ++i) {
        const Uv a{crossing_at(patch, places[i - 1]).*side, panel.v(places[i - 1])}, b{crossing_at(patch, places[i]).*side, panel.v(places[i])};
        const EdgeId edge = builder_.edge(line_on_surface(form, a, b), {0.0, 1.0}, corner(a), corner(b), "hinge");
        if (kind == ControlKind::trailing_edge) graph.add(edge, a, b, k);
        else graph.add(edge, a, b, {}, k);
      }
    }
  }
  const WingPatch* whole = patch_over(ControlKind::all_moving, from_place, to_place);
  for (const SideGraph::Loop& loop : graph.loops()) {
    const WingPatch* patch = whole ? whole : loop.mark ? &wing_.patches[*loop.mark] : nullptr;
    builder_.face(surface, loop.sides, patch ? FaceRole::control : role, patch ? patch->name : wing_.name);
  }
}

/// The faces between two stations of a panel.
void WingBuilder::make_part(const Panel& panel, double from_place, double to_place, const Station& from, const Station& to) {
  const auto along = [&](const NurbsSurfaceForm& form, double u, const std::vector<double>& places, CornerId first, CornerId last, const char* name) {
    std::vector<double> at;
    for (const double place : places) at.push_back(panel.v(place));
    return builder_.split_curve(line_of_constant_u(form, u), at, first, last, name);
  };
  const std::vector<double> behind = patch_ends(ControlKind::trailing_edge, from_place, to_place), before = patch_ends(ControlKind::leading_edge, from_place, to_place);
  const SplitCurve leading = along(panel.upper, 1.0, before, from.leading(), to.leading(), "leading edge");
  const SplitCurve upper_trailing = along(panel.upper, 0.0, behind, from.upper.corners.front(), to.upper.corners.front(), "trailing edge");
  const SplitCurve lower_trailing = is_blunt_ ? along(panel.lower, 0.0, behind, from.lower.corners.front(), to.lower.corners.front(), "trailing edge") : upper_trailing;
  make_side(panel, &WingPatch::Place::upper, from_place, to_place, from, to, leading, upper_trailing);
  make_side(panel, &WingPatch::Place::lower, from_place, to_place, from, to, leading, lower_trailing);
  if (!is_blunt_) return;
  NurbsSurfaceForm base{1, panel.upper.degree_v, {0.0, 0.0, 1.0, 1.0}, panel.upper.knots_v, 2, panel.upper.n_v, {}, {}};
  for (std::size_t j = 0; j < panel.upper.n_v; ++j) base.poles.push_back(panel.upper.poles[j]);
  for (std::size_t j = 0; j < panel.lower.n_v; ++j) base.poles.push_back(panel.lower.poles[j]);
  const auto surface = std::make_shared<NurbsSurface>(base);
  EdgeId thickness = from.thickness;
  for (std::size_t i = 1; i < behind.size(); ++i) {
    const EdgeId next = i + 1 == behind.size() ? to.thickness : builder_.straight_edge(upper_trailing.corners[i], lower_trailing.corners[i]);
    const WingPatch* patch = patch_over(ControlKind::trailing_edge, behind[i - 1], behind[i]);
    if (!patch) patch = patch_over(ControlKind::all_moving, from_place, to_place);
    const ParameterBox box{{0.0, 1.0}, {upper_trailing.at[i - 1], upper_trailing.at[i]}};
    builder_.patch(surface, box, {thickness, lower_trailing.edges[i - 1], next, upper_trailing.edges[i - 1]}, FaceRole::trailing_edge, patch ? patch->name : wing_.name);
    thickness = next;
  }
}

void WingBuilder::make_panels() {
  Station first, at;
  std::size_t from = 0;
  for (std::size_t i = 1; i < rows_.size(); ++i) {
    if (!is_break_[i]) continue;
    const Panel part = panel(from, i);
    const std::vector<double> cuts = patch_ends(ControlKind::all_moving, static_cast<double>(from), static_cast<double>(i));
    if (from == 0) first = at = station(part, 0.0);
    for (std::size_t k = 1; k < cuts.size(); ++k) {
      const bool closes_ring = is_ring_ && i + 1 == rows_.size() && k + 1 == cuts.size();
      const Station next = closes_ring ? first : station(part, cuts[k]);
      make_part(part, cuts[k - 1], cuts[k], at, next);
      at = next;
    }
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
    std::vector<EdgeId> border = at.upper.edges;
    border.insert(border.end(), at.lower.edges.rbegin(), at.lower.edges.rend());
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
  const NurbsCurveForm<Point> upper = *at.upper.curve->exact_nurbs(), lower = *at.lower.curve->exact_nurbs();
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
  const EdgeId nose = builder_.pole(at.leading());
  EdgeId base;
  if (is_blunt_) {
    base = builder_.edge(line_of_constant_u(form, 0.0), {0.0, 1.0}, at.upper.corners.front(), at.lower.corners.front());
    builder_.plane({base, at.thickness}, FaceRole::trailing_edge, wing_.name);
  } else {
    base = builder_.pole(at.upper.corners.front());
  }
  std::vector<ModelBuilder::Side> sides;
  for (std::size_t i = 0; i < at.upper.edges.size(); ++i) sides.push_back({at.upper.edges[i], {at.upper.at[i], 0.0}, {at.upper.at[i + 1], 0.0}});
  sides.push_back({nose, {1.0, 0.0}, {1.0, 1.0}});
  for (std::size_t i = at.lower.edges.size(); i-- > 0;) sides.push_back({at.lower.edges[i], {at.lower.at[i + 1], 1.0}, {at.lower.at[i], 1.0}});
  sides.push_back({base, {0.0, 1.0}, {0.0, 0.0}});
  builder_.face(std::make_shared<NurbsSurface>(form), sides, FaceRole::tip, wing_.name);
}

Model WingBuilder::build() {
  make_rows();
  make_panels();
  return builder_.closed_solid(wing_.name);
}

}  // namespace

Model make_wing(const Wing& wing, const Transform& map) { return WingBuilder(wing, map).build(); }

}  // namespace sterna
