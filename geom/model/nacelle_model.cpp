// Builds nacelles of cowls. Steps: make profiles at angles about the axis; make rows of points around the axis; spline surfaces closed around the axis, in two
// halves, with edges along the lips and the trailing edges.
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

/// Number of points around the axis; even, so that halves end on points.
constexpr std::size_t k_cowl_angles = 32;
constexpr std::size_t k_cowl_side_points = 32;
/// Radii and thicknesses below this fraction of the profile's size are zero: files have 6 digits.
constexpr double k_nothing = 1e-6;

SplineOptions around_cowl() {
  SplineOptions o{.tangents = SplineTangents::periodic, .at = {}};
  for (std::size_t i = 0; i <= k_cowl_angles; ++i) o.at.push_back(static_cast<double>(i) / k_cowl_angles);
  return o;
}

/// A circle-like edge in two halves at one location of the profile.
struct Hoop {
  std::array<CornerId, 2> corners;
  std::array<EdgeId, 2> halves;
};

class CowlBuilder {
 public:
  CowlBuilder(const std::string& name, const Transform& map) : name_(name), map_(map), builder_({name, ComponentKind::nacelle}) {}
  Model ring(const Cowl& cowl);
  Model center_body(const std::vector<Uv>& profile);

 private:
  /// Returns a grid of points (profile, angle) from x and radius at each angle. Angle 0 is at the top; the sense is right-handed about x.
  PointGrid turned(const std::vector<std::vector<Uv>>& profiles) const;
  Hoop hoop(const NurbsSurfaceForm& form, double u);
  void halves(const NurbsSurfaceForm& form, const Hoop& from, const Hoop& to, FaceRole role);

  std::string name_;
  Transform map_;
  ModelBuilder builder_;
};

PointGrid CowlBuilder::turned(const std::vector<std::vector<Uv>>& profiles) const {
  PointGrid grid{profiles.front().size(), k_cowl_angles + 1, {}};
  for (std::size_t i = 0; i < grid.n_u; ++i)
    for (std::size_t j = 0; j <= k_cowl_angles; ++j) {
      const Uv p = profiles[j % k_cowl_angles][i];
      const double angle = 2.0 * std::numbers::pi * static_cast<double>(j % k_cowl_angles) / k_cowl_angles;
      grid.points.push_back(map_.point({p.u, -p.v * std::sin(angle), p.v * std::cos(angle)}));
    }
  return grid;
}

Hoop CowlBuilder::hoop(const NurbsSurfaceForm& form, double u) {
  const CurvePtr curve = line_of_constant_u(form, u);
  constexpr double k_rounding = 1e-13;  // relative to coordinates: the points of a pole differ by the rounding of the basis functions
  if (distance(curve->point(0.0), curve->point(0.5)) <= k_rounding * (1.0 + norm(curve->point(0.0)))) {
    const CornerId c = builder_.corner(curve->point(0.0));
    return {{c, c}, {builder_.pole(c), builder_.pole(c)}};
  }
  const std::array<CornerId, 2> corners{builder_.corner(curve->point(0.0)), builder_.corner(curve->point(0.5))};
  return {corners, {builder_.edge(curve, {0.0, 0.5}, corners[0], corners[1]), builder_.edge(curve, {0.5, 1.0}, corners[1], corners[0])}};
}

void CowlBuilder::halves(const NurbsSurfaceForm& form, const Hoop& from, const Hoop& to, FaceRole role) {
  const auto surface = std::make_shared<NurbsSurface>(form, false, true, "bicubic spline");
  const Interval u = surface->domain().u;
  const EdgeId top = builder_.edge(line_of_constant_v(form, 0.0), u, from.corners[0], to.corners[0], "top");
  const EdgeId bottom = builder_.edge(line_of_constant_v(form, 0.5), u, from.corners[1], to.corners[1], "bottom");
  builder_.patch(surface, {u, {0.0, 0.5}}, {top, to.halves[0], bottom, from.halves[0]}, role, name_);
  builder_.patch(surface, {u, {0.5, 1.0}}, {bottom, to.halves[1], top, from.halves[1]}, role, name_);
}

/// Returns the profiles at all angles: sections are splined around the circle, point by point in x and radius.
std::vector<std::vector<Uv>> profiles_of(const Cowl& cowl) {
  std::vector<std::vector<Uv>> rows;
  for (const CowlSection& section : cowl.sections) {
    std::vector<Point> loop;
    for (const Uv p : section.profile) loop.push_back({p.u, 0.0, p.v});
    std::vector<Uv> row;
    for (const Point& p : airfoil_row(loop, k_cowl_side_points, section.name).points) row.push_back({p.x, p.z});
    rows.push_back(std::move(row));
  }
  std::vector<std::vector<Uv>> profiles(k_cowl_angles, rows.front());
  if (rows.size() == 1) return profiles;
  const double turn = 2.0 * std::numbers::pi;
  SplineOptions o{.tangents = rows.size() > 2 ? SplineTangents::periodic : SplineTangents::bessel, .at = {}, .is_closed = true};
  for (const CowlSection& section : cowl.sections) o.at.push_back(section.angle);
  o.at.push_back(cowl.sections.front().angle + turn);
  for (std::size_t i = 0; i < rows.front().size(); ++i) {
    std::vector<Point> values;
    for (const std::vector<Uv>& row : rows) values.push_back({row[i].u, row[i].v, 0.0});
    values.push_back(values.front());
    if (rows.size() == 2) {  // two rows are too few for a closed spline: interpolate between them by a cosine
      for (std::size_t j = 0; j < k_cowl_angles; ++j) {
        const double part = 0.5 - 0.5 * std::cos((turn * static_cast<double>(j) / k_cowl_angles - o.at[0]) / (o.at[1] - o.at[0]) * std::numbers::pi);
        const Point p = values[0] + part * (values[1] - values[0]);
        profiles[j][i] = {p.x, p.y};
      }
      continue;
    }
    const CurvePtr curve = spline_curve(values, o);
    for (std::size_t j = 0; j < k_cowl_angles; ++j) {
      double angle = turn * static_cast<double>(j) / k_cowl_angles;
      if (angle < o.at.front()) angle += turn;
      const Point p = curve->point(angle);
      profiles[j][i] = {p.x, p.y};
    }
  }
  return profiles;
}

Model CowlBuilder::ring(const Cowl& cowl) {
  if (cowl.sections.size() == 2 && std::abs(cowl.sections[1].angle - cowl.sections[0].angle - std::numbers::pi) > k_nothing)
    throw Error(
        {.code = ErrorCode::bad_argument,
         .attempted = "making nacelle '" + name_ + "'",
         .problem = "two sections of a cowl must face each other; they are " + std::to_string(cowl.sections[1].angle - cowl.sections[0].angle) + " rad apart"});
  const PointGrid grid = turned(profiles_of(cowl));
  PointGrid closed = grid;
  const double size = distance(grid(0, 0), grid(k_cowl_side_points, 0));
  bool is_blunt = true;
  for (std::size_t j = 0; j < grid.n_v; ++j)
    if (distance(grid(0, j), grid(grid.n_u - 1, j)) <= k_nothing * size) is_blunt = false;
  if (!is_blunt)
    for (std::size_t j = 0; j < grid.n_v; ++j) {
      const Point middle = 0.5 * (grid(0, j) + grid(grid.n_u - 1, j));
      closed.points[j] = closed.points[(grid.n_u - 1) * grid.n_v + j] = middle;
    }
  SplineOptions along{.tangents = SplineTangents::not_a_knot, .at = airfoil_stations(k_cowl_side_points)};
  for (std::size_t k = k_cowl_side_points; k-- > 0;) along.at.push_back(2.0 - along.at[k]);
  const NurbsSurfaceForm form = spline_surface_form(closed, along, around_cowl());
  const NurbsSurfaceForm inner = restricted(form, {0.0, 1.0}, {0.0, 1.0}), outer = restricted(form, {1.0, 2.0}, {0.0, 1.0});
  const Hoop inner_end = hoop(inner, 0.0), lip = hoop(inner, 1.0), outer_end = is_blunt ? hoop(outer, 2.0) : inner_end;
  halves(inner, inner_end, lip, FaceRole::lower);
  halves(outer, lip, outer_end, FaceRole::upper);
  if (is_blunt) {
    NurbsSurfaceForm base{1, inner.degree_v, {0.0, 0.0, 1.0, 1.0}, inner.knots_v, 2, inner.n_v, {}, {}};
    base.poles.assign(inner.poles.begin(), inner.poles.begin() + static_cast<std::ptrdiff_t>(inner.n_v));
    base.poles.insert(base.poles.end(), outer.poles.end() - static_cast<std::ptrdiff_t>(outer.n_v), outer.poles.end());
    halves(base, inner_end, outer_end, FaceRole::trailing_edge);
  }
  return builder_.closed_solid(name_);
}

Model CowlBuilder::center_body(const std::vector<Uv>& given) {
  std::vector<Uv> profile = given;
  double size = 0.0;
  for (const Uv p : profile) size = std::max({size, p.v, std::abs(p.u - profile.front().u)});
  for (Uv* end : {&profile.front(), &profile.back()})
    if (end->v <= k_nothing * size) end->v = 0.0;
  const PointGrid grid = turned(std::vector<std::vector<Uv>>(k_cowl_angles, profile));
  const NurbsSurfaceForm form = spline_surface_form(grid, {.tangents = SplineTangents::akima}, around_cowl());
  const Hoop nose = hoop(form, form.knots_u.front()), tail = hoop(form, form.knots_u.back());
  halves(form, nose, tail, FaceRole::skin);
  for (const auto& [end, role] : {std::pair{nose, FaceRole::nose}, {tail, FaceRole::tail}})
    if (end.corners[0] != end.corners[1]) builder_.plane({end.halves[0], end.halves[1]}, role, name_);
  return builder_.closed_solid(name_);
}

}  // namespace

Model make_nacelle(const CowlNacelle& nacelle, const Transform& map) {
  const Transform location = map * nacelle.placement;
  Model model;
  for (std::size_t i = 0; i < nacelle.cowls.size(); ++i) append(model, CowlBuilder(nacelle.name + (i == 0 ? "" : "Core"), location).ring(nacelle.cowls[i]));
  if (!nacelle.center_body.empty()) append(model, CowlBuilder(nacelle.name + "Center", location).center_body(nacelle.center_body));
  return model;
}

}  // namespace sterna
