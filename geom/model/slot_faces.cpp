#include "geom/model/slot_faces.h"

#include <algorithm>
#include <cmath>

#include "geom/model/curves.h"
#include "geom/model/nurbs_curve.h"
#include "geom/model/nurbs_surface.h"
#include "geom/model/nurbs_tools.h"

namespace sterna {
namespace {

/// Poles of half an arc as a rational quadratic: corner, intersection of the tangents, foremost point. Their weights are 1, w, 1.
struct HalfArc {
  Point corner, shoulder, front;
  double weight;
};
HalfArc half_arc(const Point& corner, const Bulge& bulge) {
  const Vec3 arm = corner - bulge.centre;
  const double ahead = dot(arm, bulge.ahead);
  const Vec3 aside = arm - ahead * bulge.ahead;
  const double side = norm(aside), y = side - ahead * (bulge.radius - ahead) / side;
  const double angle = std::atan2(side, ahead);
  return {corner, bulge.centre + bulge.radius * bulge.ahead + (y / side) * aside, bulge.centre + bulge.radius * bulge.ahead, std::cos(0.5 * angle)};
}

std::vector<double> knots_of_section(bool is_straight) {
  return is_straight ? std::vector<double>{0.0, 0.0, 1.0, 1.0} : std::vector<double>{0.0, 0.0, 0.0, 0.5, 0.5, 1.0, 1.0, 1.0};
}

/// Poles and weights of a section from the upper to the lower corner.
struct SectionForm {
  std::vector<Point> poles;
  std::vector<double> weights;
};
SectionForm section_form(const Point& upper, const Point& lower, const std::optional<Bulge>& bulge) {
  if (!bulge) return {{upper, lower}, {1.0, 1.0}};
  const HalfArc a = half_arc(upper, *bulge), b = half_arc(lower, *bulge);
  return {{a.corner, a.shoulder, a.front, b.shoulder, b.corner}, {1.0, a.weight, 1.0, b.weight, 1.0}};
}

/// Returns a part of a curve as a polynomial form over [0, 1].
NurbsCurveForm<Point> unit_form(const CurvePtr& curve, Interval range) {
  NurbsCurveForm<Point> form = *part_of(curve, range)->exact_nurbs();
  form.knots = stretched_knots(form.knots, {0.0, 1.0});
  return form;
}

/// Converts both forms to the same knots and the same degree.
void unify(NurbsCurveForm<Point>& a, NurbsCurveForm<Point>& b) {
  const int degree = std::max(a.degree, b.degree);
  const std::vector<double> knots = united_knots(elevated_knots(a.knots, degree - a.degree), elevated_knots(b.knots, degree - b.degree));
  a = on_knots(a, degree, knots);
  b = on_knots(b, degree, knots);
}

using Side = ModelBuilder::Side;

/// Returns sides along a split curve, from its start to its end or back; `location` gives (u, v) of its parameter.
template <class Location>
void add_sides(std::vector<Side>& sides, const SplitCurve& split, bool is_forward, const Location& location) {
  const std::size_t n = split.edges.size();
  for (std::size_t k = 0; k < n; ++k) {
    const std::size_t i = is_forward ? k : n - 1 - k;
    sides.push_back({split.edges[i], location(split.at[is_forward ? i : i + 1]), location(split.at[is_forward ? i + 1 : i])});
  }
}

}  // namespace

SplitCurve slot_section(ModelBuilder& builder, const SlotStation& station) {
  const Point upper = builder.model().corners[station.upper].point, lower = builder.model().corners[station.lower].point;
  SectionForm form = section_form(upper, lower, station.bulge);
  const bool is_straight = !station.bulge;
  const CurvePtr curve = std::make_shared<NurbsCurve>(NurbsCurveForm<Point>{is_straight ? 1 : 2, knots_of_section(is_straight), std::move(form.poles),
                                                                            is_straight ? std::vector<double>{} : std::move(form.weights)});
  return builder.split_curve(curve, is_straight ? std::vector<double>{0.0, 1.0} : std::vector<double>{0.0, 0.5, 1.0}, station.upper, station.lower);
}

void slot_strip(ModelBuilder& builder, const std::vector<SplitCurve>& sections, const std::vector<SlotStation>& stations, const std::vector<EdgeId>& upper,
                const std::vector<EdgeId>& lower, FaceRole role, const std::string& name) {
  for (std::size_t i = 0; i + 1 < stations.size(); ++i) {
    const auto form_of = [&](EdgeId id, CornerId start) {
      const ModelEdge& edge = builder.model().edges[id];
      NurbsCurveForm<Point> form = unit_form(edge.curve, edge.range);
      if (edge.start != start) {
        form = reversed(form);
        form.knots = stretched_knots(form.knots, {0.0, 1.0});
      }
      return form;
    };
    NurbsCurveForm<Point> top = form_of(upper[i], stations[i].upper), bottom = form_of(lower[i], stations[i].lower);
    unify(top, bottom);
    const auto at = [&](std::size_t k) {
      return section_form(builder.model().corners[stations[k].upper].point, builder.model().corners[stations[k].lower].point, stations[k].bulge);
    };
    const SectionForm a = at(i), b = at(i + 1);
    const bool is_straight = !stations[i].bulge;
    NurbsSurfaceForm form{is_straight ? 1 : 2, top.degree, knots_of_section(is_straight), top.knots, a.poles.size(), top.poles.size(), {}, {}};
    for (std::size_t r = 0; r < form.n_u; ++r)
      for (std::size_t j = 0; j < form.n_v; ++j) {
        double t = 0.0;  // Greville abscissa of the pole: linear functions along the span are preserved
        for (int k = 1; k <= top.degree; ++k) t += top.knots[j + static_cast<std::size_t>(k)] / top.degree;
        form.poles.push_back(r == 0 ? top.poles[j] : r + 1 == form.n_u ? bottom.poles[j] : (1.0 - t) * a.poles[r] + t * b.poles[r]);
        if (!is_straight) form.weights.push_back((1.0 - t) * a.weights[r] + t * b.weights[r]);
      }
    std::vector<Side> sides;
    add_sides(sides, sections[i], true, [](double t) { return Uv{t, 0.0}; });
    sides.push_back({lower[i], {1.0, 0.0}, {1.0, 1.0}});
    add_sides(sides, sections[i + 1], false, [](double t) { return Uv{t, 1.0}; });
    sides.push_back({upper[i], {0.0, 1.0}, {0.0, 0.0}});
    builder.face(std::make_shared<NurbsSurface>(form), sides, role, name);
  }
}

namespace {

/// Returns the ruled surface between two polynomial forms, or two rational ones on the same knots.
SurfacePtr ruled(NurbsCurveForm<Point> a, NurbsCurveForm<Point> b) {
  const bool is_rational = !a.weights.empty();
  if (!is_rational) unify(a, b);
  NurbsSurfaceForm form{a.degree, 1, a.knots, {0.0, 0.0, 1.0, 1.0}, a.poles.size(), 2, {}, {}};
  for (std::size_t i = 0; i < a.poles.size(); ++i) {
    form.poles.insert(form.poles.end(), {a.poles[i], b.poles[i]});
    if (is_rational) form.weights.insert(form.weights.end(), {a.weights[i], b.weights[i]});
  }
  return std::make_shared<NurbsSurface>(form);
}

}  // namespace

void ruled_wall(ModelBuilder& builder, const SplitCurve& upper, const SplitCurve& lower, EdgeId start, EdgeId end, FaceRole role, const std::string& name) {
  const auto range = [](const SplitCurve& split) { return Interval{split.at.front(), split.at.back()}; };
  const auto location = [&](const SplitCurve& split, double v) { return [r = range(split), v](double t) { return Uv{(t - r.from) / r.length(), v}; }; };
  std::vector<Side> sides;
  add_sides(sides, upper, true, location(upper, 0.0));
  sides.push_back({end, {1.0, 0.0}, {1.0, 1.0}});
  add_sides(sides, lower, false, location(lower, 1.0));
  sides.push_back({start, {0.0, 1.0}, {0.0, 0.0}});
  builder.face(ruled(unit_form(upper.curve, range(upper)), unit_form(lower.curve, range(lower))), sides, role, name);
}

void slot_wall(ModelBuilder& builder, const SlotWall& wall, const SplitCurve& section, FaceRole role, const std::string& name) {
  const CornerId upper = wall.is_slot_at_start ? wall.upper.corners.front() : wall.upper.corners.back(),
                 lower = wall.is_slot_at_start ? wall.lower.corners.front() : wall.lower.corners.back();
  const EdgeId at_slot = section.edges.size() == 1 ? section.edges.front() : builder.straight_edge(upper, lower);
  const EdgeId at_end = wall.end ? *wall.end : builder.pole(wall.is_slot_at_start ? wall.upper.corners.back() : wall.upper.corners.front());
  ruled_wall(builder, wall.upper, wall.lower, wall.is_slot_at_start ? at_slot : at_end, wall.is_slot_at_start ? at_end : at_slot, role, name);
  if (section.edges.size() == 1) return;
  const NurbsCurveForm<Point> arc = *section.curve->exact_nurbs();
  const std::vector<double> knots{0.0, 0.0, 0.0, 1.0, 1.0, 1.0};
  const NurbsCurveForm<Point> first{2, knots, {arc.poles[0], arc.poles[1], arc.poles[2]}, {1.0, arc.weights[1], 1.0}},
      second{2, knots, {arc.poles[4], arc.poles[3], arc.poles[2]}, {1.0, arc.weights[3], 1.0}};
  const EdgeId pole = builder.pole(section.corners[1]);
  builder.face(ruled(first, second),
               {{section.edges[0], {0.0, 0.0}, {1.0, 0.0}},
                {pole, {1.0, 0.0}, {1.0, 1.0}},
                {section.edges[1], {1.0, 1.0}, {0.0, 1.0}},
                {at_slot, {0.0, 1.0}, {0.0, 0.0}}},
               role, name);
}

SplitCurve pieces(const SplitCurve& split, double from, double to) {
  SplitCurve part{split.curve, {}, {}, {}};
  for (std::size_t i = 0; i < split.at.size(); ++i) {
    if (split.at[i] < from || split.at[i] > to) continue;
    if (!part.at.empty()) part.edges.push_back(split.edges[i - 1]);
    part.at.push_back(split.at[i]);
    part.corners.push_back(split.corners[i]);
  }
  return part;
}

}  // namespace sterna
