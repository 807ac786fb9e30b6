#include "geom/model/wing_sides.h"

#include <algorithm>

#include "geom/model/nurbs_surface.h"
#include "geom/model/nurbs_tools.h"

namespace sterna {

WingSides wing_sides(WingPanel panel) {
  WingSides sides{std::move(panel), {}, {}, {}, {}};
  const Interval v{sides.form.knots_v.front(), sides.form.knots_v.back()};
  sides.upper = restricted(sides.form, {0.0, 1.0}, v);
  sides.lower = reversed_u(restricted(sides.form, {1.0, 2.0}, v));
  sides.lower.knots_u = sides.upper.knots_u;  // stations are mirrored: equal except for rounding
  const std::string kind = sides.v_of_row.size() == 2 ? "linear-cubic spline" : "bicubic spline";
  sides.upper_surface = std::make_shared<NurbsSurface>(sides.upper, false, false, kind);
  sides.lower_surface = std::make_shared<NurbsSurface>(sides.lower, false, false, kind);
  return sides;
}

const WingSides& panel_at(const std::vector<WingSides>& panels, double location, bool is_before) {
  std::size_t i = 0;
  while (i + 1 < panels.size() &&
         (is_before ? location > static_cast<double>(panels[i + 1].first_row) : location >= static_cast<double>(panels[i + 1].first_row)))
    ++i;
  return panels[i];
}

SurfacePtr trailing_edge_surface(const WingSides& sides) {
  NurbsSurfaceForm base{1, sides.upper.degree_v, {0.0, 0.0, 1.0, 1.0}, sides.upper.knots_v, 2, sides.upper.n_v, {}, {}};
  for (const NurbsSurfaceForm* side : {&sides.upper, &sides.lower})
    for (std::size_t j = 0; j < side->n_v; ++j) base.poles.push_back(side->poles[j]);
  return std::make_shared<NurbsSurface>(base);
}

double first_location(const WingPatch& patch) { return patch.border.front().section; }
double last_location(const WingPatch& patch) { return patch.border.back().section; }

WingPatch::Location crossing_at(const std::vector<WingPatch::Location>& line, double location) {
  std::size_t i = 1;
  while (i + 1 < line.size() && location > line[i].section) ++i;
  const WingPatch::Location &a = line[i - 1], &b = line[i];
  if (location == a.section || location == b.section) return location == a.section ? a : b;
  const double t = (location - a.section) / (b.section - a.section);
  return {location, a.upper + t * (b.upper - a.upper), a.lower + t * (b.lower - a.lower)};
}

HingeSection hinge_section(const WingSides& sides, const WingPatch& patch, double location) {
  const WingPatch::Location at = crossing_at(patch.slot->hinge, location);
  const double v = sides.v(location);
  HingeSection section{sides.upper_surface->point({at.upper, v}), sides.lower_surface->point({at.lower, v}), {}, {}};
  section.middle = 0.5 * (section.upper + section.lower);
  const Vec3 up = normalized(section.upper - section.lower), nose = sides.upper_surface->point({1.0, v}) - section.middle;
  section.ahead = normalized(nose - dot(nose, up) * up);
  if (patch.kind == ControlKind::leading_edge) section.ahead = -section.ahead;
  return section;
}

void add_sorted(std::vector<double>& values, double value) {
  const auto at = std::lower_bound(values.begin(), values.end(), value);
  if (at == values.end() || *at != value) values.insert(at, value);
}

}  // namespace sterna
