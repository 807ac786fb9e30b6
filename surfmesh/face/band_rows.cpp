// Columns stand on the border's points, at right angles to it within the surface. All columns grow together, row by row:
// 1. start_columns   creates a column at each point. If the border next to the run is itself a column, the columns near it are inclined like that border.
// 2. grow_rows       adds one step per row, at right angles to the row below, until the row is as high as its edges along the border, or an obstacle is too
// near.
// 3. limit_rows      removes rows so that neighbouring columns differ by at most one row and no cell is inverted (exact test in the plane).
// 4. lay             creates the cells and passes the remaining border to mesh_face. If the rest cannot be meshed, rows are removed around the location.
#include "surfmesh/face/band_rows.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <numbers>

#include "geom/base/error.h"
#include "geom/delaunay/face_state.h"
#include "geom/delaunay/triangulation.h"
#include "geom/math/measures.h"
#include "geom/math/predicates.h"
#include "surfmesh/face/point_grid.h"

namespace sterna::surfmesh {
namespace {

using delaunay::sample;

/// Smallest distance of a row vertex from another border, relative to its edges along the border: one triangle must fit between.
constexpr double k_clearance = 1.0;
/// Rows of two borders that face each other keep an additional distance of this many times the height of the column.
constexpr double k_half = 1.0;
/// Limits for the width of a cell, relative to the width of its column at the border.
constexpr double k_narrowest = 0.45, k_widest = 2.2;
/// A border column that deviates from the right angle inclines the columns beside it over this many times its deflection. Neighbours then approach each other
/// by at most one eighth.
constexpr double k_lean_reach = 8.0;
/// A step is exact to this fraction of its length, because growth is reported with an accuracy of 0.1 %.
constexpr double k_step_tolerance = 1e-7;
constexpr int k_max_step_iterations = 30;
/// Rows are removed within this many edge lengths of a location that cannot be meshed. After k_max_take_backs attempts all rows are removed.
constexpr double k_take_back_reach = 3.0;
constexpr int k_max_take_backs = 12;
/// Rad: two smallest angles that differ by less than this are considered equal, so that diagonals alternate.
constexpr double k_same_angle = 0.01;

struct RowLocation {
  Uv uv;
  Point point;
  Vec3 normal;           ///< unit normal, in the direction of du x dv
  std::uint32_t id = 0;  ///< border id for given points; `lay` sets the ids of all others
};

struct RowColumn {
  std::vector<RowLocation> rows;       ///< vertices of the column by row; rows[0] lies on the border
  double spacing = 0.0;                ///< m, mean length of the two edges along the border
  double at_top = 0.0;                 ///< m, mean edge length in the last row, not more than `spacing`
  Vec3 direction;                      ///< unit direction of the next step
  std::array<double, 2> lean_share{};  ///< fractions of the border columns' inclination, at the start and at the end of the run, that this column takes over
  double lean = 0.0;                   ///< rad: angle between the next step and the right angle, positive in the direction of the run
  double height = 0.0;                 ///< m, height of the last row
  double climbed = 0.0;                ///< m, sum of the heights of all rows
  bool is_growing = false;
  bool is_given = false;  ///< the points of the column are border points
  std::size_t n_rows() const { return rows.size() - 1; }
};

struct Run {
  const BandRun* target = nullptr;
  std::vector<RowColumn> columns;
  double length = 0.0;
  std::array<double, 2> lean{};  ///< rad: inclination of the border columns at the start and the end of the run, in the growing row
};

/// The complete state of a face with its rows.
struct Laying {
  const Surface& surface;
  const FaceBorder& border;
  Vec2 scale;
  std::vector<std::uint32_t> first_of_loop;
  std::vector<bool> is_left;  ///< per loop: true if the face lies to the left of the loop
  std::vector<Run> runs;
  BandMeasures measures;
};

std::uint32_t border_id(const Laying& laying, std::size_t loop, std::size_t i) {
  return laying.first_of_loop[loop] + static_cast<std::uint32_t>(i % laying.border.loops[loop].size());
}

/// Returns the side of each loop by the sign of its area: outer loops have the face to the left if it is positive, holes if it is negative.
std::vector<bool> sides_of(const FaceBorder& border) {
  std::vector<double> area;
  std::size_t outer = 0;
  for (const auto& loop : border.loops) {
    double sum = 0.0;
    for (std::size_t i = 0; i < loop.size(); ++i) {
      const Uv &a = loop[i].uv, &b = loop[(i + 1) % loop.size()].uv;
      sum += 0.5 * (a.u * b.v - a.v * b.u);
    }
    area.push_back(sum);
    if (std::abs(sum) > std::abs(area[outer])) outer = area.size() - 1;
  }
  std::vector<bool> is_left;
  for (std::size_t l = 0; l < area.size(); ++l) is_left.push_back((area[l] > 0.0) == (l == outer));
  return is_left;
}

RowLocation location_of(const Laying& laying, std::size_t loop, std::size_t i) {
  const BorderPoint& p = laying.border.loops[loop][i % laying.border.loops[loop].size()];
  return {p.uv, p.point, sample(laying.surface, p.uv).frame.normal, border_id(laying, loop, i)};
}

Vec3 along_surface(const Vec3& v, const Vec3& normal) { return v - dot(v, normal) * normal; }

double angle_along(const Vec3& direction, const Vec3& tangent) { return std::asin(std::clamp(dot(direction, tangent), -1.0, 1.0)); }

/// Returns the normal curvature of the surface in a direction, 1/m, not negative.
double curvature_along(const Surface& surface, Uv at, const Vec3& direction) {
  const SurfaceDerivatives d = surface.derivatives(at);
  const delaunay::SurfaceFrame frame{d.du, d.dv, {}};
  const Uv w = parameter_step(frame, direction);
  const Vec3 step = w.u * d.du + w.v * d.dv, normal = cross(d.du, d.dv);
  const double second = dot(w.u * w.u * d.duu + 2.0 * w.u * w.v * d.duv + w.v * w.v * d.dvv, normal);
  const double result = std::abs(second) / (norm(normal) * norm2(step));
  return std::isfinite(result) ? result : 0.0;
}

/// Finds a point of the surface at `step` metres from `from`, ahead along `direction`. \return false if the surface does not continue in this way
bool walk(const Surface& surface, const RowLocation& from, const Vec3& direction, double step, RowLocation& to) {
  to.uv = from.uv;
  delaunay::SurfaceSample at = sample(surface, from.uv);
  double reach = step;
  for (int i = 0; i < k_max_step_iterations; ++i) {
    const Vec3 off = along_surface(from.point + reach * direction - at.point, at.frame.normal);
    const Uv change = parameter_step(at.frame, off);
    if (!std::isfinite(change.u) || !std::isfinite(change.v)) return false;
    to.uv = to.uv + change;
    at = sample(surface, to.uv);
    const double done = distance(at.point, from.point);
    if (!(done > 0.1 * step) || !is_finite(at.point) || norm2(at.frame.normal) == 0.0) return false;
    if (norm(off) <= k_step_tolerance * step && std::abs(done - step) <= k_step_tolerance * step) break;
    reach *= std::clamp(step / done, 0.5, 2.0);
  }
  to.point = at.point;
  to.normal = at.frame.normal;
  const double done = distance(to.point, from.point);
  constexpr double k_good_enough = 1e-3;
  return std::abs(done - step) <= k_good_enough * step && dot(to.point - from.point, direction) > 0.5 * done;
}

void start_columns(const Laying& laying, Run& run) {
  const BandRun& target = *run.target;
  const auto& loop = laying.border.loops[target.loop];
  const auto point = [&](std::size_t i) -> const Point& { return loop[(target.first + i) % loop.size()].point; };
  const std::size_t n = target.n_points;
  const double side = laying.is_left[target.loop] ? 1.0 : -1.0;
  std::vector<double> along{0.0};
  for (std::size_t i = 0; i + 1 < n; ++i) along.push_back(along.back() + distance(point(i), point(i + 1)));
  run.length = along.back();
  for (std::size_t i = 0; i < n; ++i) {
    RowColumn column;
    column.rows.push_back(location_of(laying, target.loop, target.first + i));
    const std::size_t before = i > 0 ? i - 1 : 0, after = std::min(i + 1, n - 1);
    column.spacing = (along[after] - along[before]) / static_cast<double>(after - before);
    const Vec3& normal = column.rows[0].normal;
    const Vec3 across = side * cross(normal, along_surface(point(after) - point(before), normal));
    if (norm2(across) > 0.0 && norm2(normal) > 0.0) column.direction = normalized(across);
    column.is_growing = i > 0 && i + 1 < n && norm2(column.direction) > 0.0;
    run.columns.push_back(std::move(column));
  }
  // The columns on the border, and the distance over which other columns are inclined like them.
  std::array<double, 2> reach{};
  for (const std::size_t end : {0u, 1u}) {
    const std::size_t n_given = end == 0 ? target.n_before : target.n_after;
    if (n_given == 0) continue;
    RowColumn& column = run.columns[end == 0 ? 0 : n - 1];
    column.is_given = true;
    for (std::size_t k = 1; k <= n_given; ++k)
      column.rows.push_back(location_of(laying, target.loop, end == 0 ? target.first + loop.size() - k : target.first + n - 1 + k));
    const Vec3 tangent = normalized(point(end == 0 ? 1 : n - 1) - point(end == 0 ? 0 : n - 2));
    reach[end] = std::max(k_lean_reach * std::abs(dot(column.rows.back().point - column.rows.front().point, tangent)), column.spacing);
  }
  if (const double sum = reach[0] + reach[1]; sum > run.length)
    for (double& r : reach) r *= run.length / sum;
  for (std::size_t i = 1; i + 1 < n; ++i) {
    if (reach[0] > 0.0) run.columns[i].lean_share[0] = std::max(0.0, 1.0 - along[i] / reach[0]);
    if (reach[1] > 0.0) run.columns[i].lean_share[1] = std::max(0.0, 1.0 - (run.length - along[i]) / reach[1]);
  }
}

/// Sets the directions of the steps to row k: across the row below, inclined like the columns on the border there.
void set_directions(const Laying& laying, Run& run, std::size_t k) {
  std::vector<RowColumn>& columns = run.columns;
  const std::size_t n = columns.size();
  const double side = laying.is_left[run.target->loop] ? 1.0 : -1.0;
  const auto tangent_at = [&](std::size_t i, double& wide) {
    const RowLocation& here = columns[i].rows[k - 1];
    const bool has_before = i > 0 && columns[i - 1].n_rows() + 1 >= k, has_after = i + 1 < n && columns[i + 1].n_rows() + 1 >= k;
    const Vec3 way = (has_after ? columns[i + 1].rows[k - 1].point : here.point) - (has_before ? columns[i - 1].rows[k - 1].point : here.point);
    wide = norm(way) / (has_before && has_after ? 2.0 : 1.0);
    return normalized(along_surface(way, here.normal));
  };
  double wide = 0.0;
  for (const std::size_t end : {0u, 1u}) {
    const RowColumn& given = columns[end == 0 ? 0 : n - 1];
    if (given.is_given && given.n_rows() >= k)
      if (const Vec3 tangent = tangent_at(end == 0 ? 0 : n - 1, wide); norm2(tangent) > 0.0)
        run.lean[end] = angle_along(normalized(along_surface(given.rows[k].point - given.rows[k - 1].point, given.rows[k - 1].normal)), tangent);
  }
  for (std::size_t i = 1; i + 1 < n; ++i) {
    RowColumn& column = columns[i];
    if (!column.is_growing) continue;
    column.lean = column.lean_share[0] * run.lean[0] + column.lean_share[1] * run.lean[1];
    const Vec3 tangent = tangent_at(i, wide);
    column.at_top = column.spacing;
    if (norm2(tangent) == 0.0) continue;  // the direction stays unchanged
    column.at_top = std::min(column.spacing, wide);
    const Vec3 across = side * cross(column.rows.back().normal, tangent);
    column.direction = std::cos(column.lean) * across + std::sin(column.lean) * tangent;
  }
}

/// Border points as obstacles for a run. Its own points and the columns on the border beside it are no obstacles.
struct Obstacles {
  PointGrid points;                  ///< all border points of the face, with half their edges as reach
  std::vector<std::int32_t> run_of;  ///< by border id: number of the run, or -1. Points of columns on the border belong to the run of that column
};

Obstacles make_obstacles(const Laying& laying) {
  Obstacles result;
  std::vector<GridPoint> points;
  for (std::size_t l = 0; l < laying.border.loops.size(); ++l) {
    const auto& loop = laying.border.loops[l];
    for (std::size_t i = 0; i < loop.size(); ++i) {
      points.push_back({loop[i].point, border_id(laying, l, i)});
      // Long edges get intermediate points, so that rows cannot pass through them.
      constexpr double k_pieces = 4.0;
      for (double k = 1.0; k < k_pieces; k += 1.0)
        points.push_back({loop[i].point + (k / k_pieces) * (loop[(i + 1) % loop.size()].point - loop[i].point), border_id(laying, l, i)});
    }
  }
  result.run_of.assign(laying.first_of_loop.back(), -1);
  for (std::size_t r = 0; r < laying.runs.size(); ++r)
    for (const RowColumn& column : laying.runs[r].columns)
      for (const RowLocation& location : column.is_given ? column.rows : std::vector<RowLocation>{column.rows[0]})
        result.run_of[location.id] = static_cast<std::int32_t>(r);
  result.points = PointGrid(std::move(points));
  return result;
}

bool is_too_near(const Obstacles& obstacles, std::int32_t run, const Point& p, double clearance, double climbed) {
  const double reach = clearance + k_half * climbed;
  bool is_near = false;
  obstacles.points.for_each_near(p, reach, [&](const GridPoint& other) {
    const std::int32_t owner = obstacles.run_of[other.id];
    if (owner == run) return;
    // The other run will climb as high as this one. Towards a plain border only the clearance is kept.
    if (norm2(other.point - p) < (owner >= 0 ? reach * reach : clearance * clearance)) is_near = true;
  });
  return is_near;
}

/// Adds a row to a column. \return false if the column ends here
bool grow(const Laying& laying, const Obstacles& obstacles, std::size_t run, RowColumn& column) {
  const RowLaw& law = laying.runs[run].target->law;
  const RowLocation& top = column.rows.back();
  const double height = law.next_height(column.height, curvature_along(laying.surface, top.uv, column.direction));
  if (height > k_isotropic_height * column.at_top || column.n_rows() >= k_max_rows) return false;
  RowLocation next;
  if (!walk(laying.surface, top, column.direction, height / std::cos(column.lean), next)) return false;
  if (is_too_near(obstacles, static_cast<std::int32_t>(run), next.point, k_clearance * std::max(column.spacing, height), column.climbed + height)) return false;
  // The mean of the directions before and after a step is the direction of its chord.
  const Vec3 chord = normalized(next.point - top.point);
  column.direction = normalized(along_surface(2.0 * dot(column.direction, chord) * chord - column.direction, next.normal));
  column.height = height;
  column.climbed += height;
  column.rows.push_back(next);
  return true;
}

void grow_rows(Laying& laying) {
  const Obstacles obstacles = make_obstacles(laying);
  for (std::size_t r = 0; r < laying.runs.size(); ++r) {
    std::vector<RowColumn>& columns = laying.runs[r].columns;
    for (std::size_t k = 1; k <= k_max_rows; ++k) {
      bool is_any = false;
      set_directions(laying, laying.runs[r], k);
      for (RowColumn& column : columns) {
        column.is_growing = column.is_growing && grow(laying, obstacles, r, column);
        is_any = is_any || column.is_growing;
      }
      if (!is_any) break;
    }
  }
}

bool is_upright(const Laying& laying, const RowLocation& a, const RowLocation& b, const RowLocation& c) {
  const auto in_plane = [&](const RowLocation& p) { return Vec2{p.uv.u * laying.scale.x, p.uv.v * laying.scale.y}; };
  if (orient2d(in_plane(a), in_plane(b), in_plane(c)) <= 0) return false;
  const Vec3 normal = cross(b.point - a.point, c.point - a.point);
  return dot(normal, a.normal) > 0.0 && dot(normal, b.normal) > 0.0 && dot(normal, c.normal) > 0.0;
}

using LocationTriangle = std::array<const RowLocation*, 3>;

/// Visits the triangles between columns i and i + 1 in row k (counted from 1), counter-clockwise in (u, v). A column that ends below gives one triangle.
template <class Visit>
void for_each_cell(const Laying& laying, const Run& run, std::size_t i, const Visit& visit) {
  const RowColumn &left = run.columns[i], &right = run.columns[i + 1];
  const bool is_left = laying.is_left[run.target->loop];
  const auto emit = [&](std::size_t k, const RowLocation& a, const RowLocation& b, const RowLocation& c) {
    is_left ? visit(k, LocationTriangle{&a, &b, &c}) : visit(k, LocationTriangle{&a, &c, &b});
  };
  const std::size_t n = std::min(left.n_rows(), right.n_rows());
  for (std::size_t k = 1; k <= n; ++k) {
    const RowLocation &a = left.rows[k - 1], &b = right.rows[k - 1], &c = right.rows[k], &d = left.rows[k];
    if (is_first_diagonal(a.point, b.point, c.point, d.point, (i + k) % 2 == 0)) {
      emit(k, a, b, c);
      emit(k, a, c, d);
    } else {
      emit(k, a, b, d);
      emit(k, b, c, d);
    }
  }
  if (left.n_rows() > n) emit(n + 1, left.rows[n], right.rows[n], left.rows[n + 1]);
  if (right.n_rows() > n) emit(n + 1, left.rows[n], right.rows[n], right.rows[n + 1]);
}

/// Removes the rows of column i from the k-th on.
void cut(Run& run, std::size_t i, std::size_t k) {
  if (run.columns[i].rows.size() > k) run.columns[i].rows.resize(std::max<std::size_t>(k, 1));
}

void limit_rows(const Laying& laying, Run& run) {
  std::vector<RowColumn>& columns = run.columns;
  bool is_changed = true;
  while (is_changed) {  // the loop ends because every iteration removes a row
    is_changed = false;
    for (std::size_t i = 0; i + 1 < columns.size(); ++i) cut(run, i + 1, columns[i].n_rows() + 2);
    for (std::size_t i = columns.size() - 1; i > 0; --i) cut(run, i - 1, columns[i].n_rows() + 2);
    for (std::size_t i = 0; i + 1 < columns.size(); ++i) {
      std::size_t bad = std::numeric_limits<std::size_t>::max();
      for_each_cell(laying, run, i, [&](std::size_t k, const LocationTriangle& t) {
        if (!is_upright(laying, *t[0], *t[1], *t[2])) bad = std::min(bad, k);
      });
      const double wide = distance(columns[i].rows[0].point, columns[i + 1].rows[0].point);
      for (std::size_t k = 1; k <= std::min({columns[i].n_rows(), columns[i + 1].n_rows(), bad}); ++k) {
        const double at_row = distance(columns[i].rows[k].point, columns[i + 1].rows[k].point);
        if (at_row < k_narrowest * wide || at_row > k_widest * wide) bad = std::min(bad, k);
      }
      if (bad == std::numeric_limits<std::size_t>::max()) continue;
      cut(run, i, bad);
      cut(run, i + 1, bad);
      is_changed = true;
    }
  }
}

/// Returns the length along and the height across of the cell of row k between two columns.
std::array<double, 2> cell_size(const RowColumn& left, const RowColumn& right, std::size_t k) {
  const Point &a = left.rows[k - 1].point, &b = right.rows[k - 1].point, &c = right.rows[k].point, &d = left.rows[k].point;
  const double along = 0.5 * (distance(a, b) + distance(d, c)),
               area = 0.5 * (triangle_area(a, b, c) + triangle_area(a, c, d) + triangle_area(a, b, d) + triangle_area(b, c, d));
  return {along, area / along};
}

void measure_cells(Laying& laying) {
  BandMeasures& m = laying.measures;
  for (const Run& run : laying.runs) {
    for (const RowColumn& column : run.columns) column.n_rows() > 0 ? ++m.n_columns : ++m.n_without;
    for (std::size_t i = 0; i + 1 < run.columns.size(); ++i) {
      const RowColumn &left = run.columns[i], &right = run.columns[i + 1];
      double before = 0.0;
      for (std::size_t k = 1; k <= std::min(left.n_rows(), right.n_rows()); ++k) {
        const auto [along, height] = cell_size(left, right, k);
        m.max_stretch = std::max(m.max_stretch, along / height);
        if (before > 0.0) m.max_growth = std::max(m.max_growth, height / before);
        before = height;
      }
    }
  }
}

/// The border that remains beside the rows, and the identity of its points.
struct RestBorder {
  FaceBorder border;
  std::vector<std::uint32_t> ids;  ///< per point: border id, or n_border + number of the row vertex
};

/// Numbers the row vertices, and replaces each run's points by the outer boundary of its rows.
RestBorder rest_of(Laying& laying, std::vector<const RowLocation*>& row_locations) {
  const std::uint32_t n_border = laying.first_of_loop.back();
  for (Run& run : laying.runs)
    for (RowColumn& column : run.columns)
      for (std::size_t k = 1; !column.is_given && k < column.rows.size(); ++k) {
        column.rows[k].id = n_border + static_cast<std::uint32_t>(row_locations.size());
        row_locations.push_back(&column.rows[k]);
      }
  std::vector<std::uint8_t> is_covered(n_border, 0);
  std::vector<std::vector<const RowLocation*>> front_at(n_border);  // outer vertices of a run, stored at the first border point that they replace
  for (const Run& run : laying.runs) {
    std::vector<const RowLocation*> front;
    for (const RowColumn& column : run.columns) {
      front.push_back(&column.rows.back());
      for (std::size_t k = 0; k < (column.is_given ? column.rows.size() : 1); ++k) is_covered[column.rows[k].id] = 1;
    }
    front_at[run.columns.front().is_given ? run.columns.front().rows.back().id : run.columns.front().rows[0].id] = std::move(front);
  }
  RestBorder rest;
  for (std::size_t l = 0; l < laying.border.loops.size(); ++l) {
    std::vector<BorderPoint> loop;
    const auto add = [&](Uv uv, const Point& point, std::uint32_t id) {
      if (!loop.empty() && rest.ids.back() == id) return;  // two runs meet in this point, which is added once
      loop.push_back({uv, point});
      rest.ids.push_back(id);
    };
    const std::size_t n = laying.border.loops[l].size();
    const std::size_t first_id = rest.ids.size();
    for (std::size_t i = 0; i < n; ++i) {
      const std::uint32_t id = border_id(laying, l, i);
      const BorderPoint& p = laying.border.loops[l][i];
      for (const RowLocation* location : front_at[id]) add(location->uv, location->point, location->id);
      if (is_covered[id] == 0) add(p.uv, p.point, id);
    }
    if (loop.size() > 1 && rest.ids.back() == rest.ids[first_id]) {
      loop.pop_back();
      rest.ids.pop_back();
    }
    if (!loop.empty()) rest.border.loops.push_back(std::move(loop));
  }
  return rest;
}

/// Joins the mesh of the rest and the rows: border points come first, in their order.
FaceMesh join(const Laying& laying, const RestBorder& rest, const std::vector<const RowLocation*>& row_locations, FaceMesh inner) {
  FaceMesh result;
  result.report = inner.report;
  result.n_border = laying.first_of_loop.back();
  for (const auto& loop : laying.border.loops)
    for (const BorderPoint& p : loop) {
      result.points.push_back(p.point);
      result.uv.push_back(p.uv);
      result.normals.push_back(sample(laying.surface, p.uv).frame.normal);
    }
  for (const RowLocation* location : row_locations) {
    result.points.push_back(location->point);
    result.uv.push_back(location->uv);
    result.normals.push_back(location->normal);
  }
  std::vector<VertexId> number(inner.points.size());
  for (std::size_t i = 0; i < inner.points.size(); ++i) {
    if (i < inner.n_border) {
      number[i] = VertexId(rest.ids[i]);
      continue;
    }
    number[i] = VertexId(static_cast<std::uint64_t>(result.points.size()));
    result.points.push_back(inner.points[i]);
    result.uv.push_back(inner.uv[i]);
    result.normals.push_back(inner.normals[i]);
  }
  for (const TriangleVertices& v : inner.triangles) result.triangles.push_back({number[v[0].index()], number[v[1].index()], number[v[2].index()]});
  for (const Run& run : laying.runs)
    for (std::size_t i = 0; i + 1 < run.columns.size(); ++i)
      for_each_cell(laying, run, i, [&](std::size_t, const LocationTriangle& t) {
        result.triangles.push_back({VertexId(t[0]->id), VertexId(t[1]->id), VertexId(t[2]->id)});
        ++result.n_band;
      });
  return result;
}

/// Halves the number of rows near the locations (with `all`: the rows of all columns). \return true if there were any
bool take_back(Laying& laying, const std::vector<ErrorLocation>& locations, bool all, std::vector<Point>& dropped) {
  bool is_any = false;
  for (Run& run : laying.runs) {
    for (std::size_t i = 0; i < run.columns.size(); ++i) {
      RowColumn& column = run.columns[i];
      if (column.n_rows() == 0) continue;
      bool is_near = all || locations.empty();
      for (const ErrorLocation& location : locations)
        for (const RowLocation& row : column.rows) is_near = is_near || distance(row.point, location.position) < k_take_back_reach * column.spacing;
      if (!is_near) continue;
      is_any = true;
      dropped.push_back(column.rows[0].point);
      cut(run, i, all ? 1 : 1 + column.n_rows() / 2);
    }
    limit_rows(laying, run);
  }
  return is_any;
}

}  // namespace

double RowLaw::next_height(double before, double curvature) const { return std::min(before > 0.0 ? growth * before : first, limits.size_of(curvature)); }

bool is_first_diagonal(const Point& a, const Point& b, const Point& c, const Point& d, bool is_even) {
  const auto least = [](const Point& p, const Point& q, const Point& r) {
    return std::min({corner_angle(p, q, r), corner_angle(q, r, p), corner_angle(r, p, q)});
  };
  const double first = std::min(least(a, b, c), least(a, c, d)), second = std::min(least(a, b, d), least(b, c, d));
  return std::abs(first - second) < k_same_angle * std::max(first, second) ? is_even : first > second;
}

BandedFace mesh_banded_face(const Surface& surface, const FaceBorder& border, const std::vector<BandRun>& runs, const SizeFunction& size, Vec2 mean_speed,
                            const FaceMeshOptions& options, const RunContext& context) {
  Laying laying{surface, border, {delaunay::scale_of_speed(mean_speed.x), delaunay::scale_of_speed(mean_speed.y)}, {0}, sides_of(border), {}, {}};
  for (const auto& loop : border.loops) laying.first_of_loop.push_back(laying.first_of_loop.back() + static_cast<std::uint32_t>(loop.size()));
  for (const BandRun& target : runs) {
    laying.runs.push_back({&target, {}, 0.0, {}});
    start_columns(laying, laying.runs.back());
  }
  grow_rows(laying);
  for (Run& run : laying.runs) limit_rows(laying, run);
  BandedFace result;
  for (int attempt = 0;; ++attempt) {
    std::vector<const RowLocation*> row_locations;
    const RestBorder rest = rest_of(laying, row_locations);
    try {
      result.mesh = join(laying, rest, row_locations, mesh_face(surface, rest.border, size, mean_speed, options, context));
    } catch (const Error& error) {
      const bool may_be_rows = error.code() == ErrorCode::self_intersection || error.code() == ErrorCode::bad_argument;
      if (!may_be_rows || !take_back(laying, error.info().locations, attempt + 1 >= k_max_take_backs, result.dropped)) throw;
      continue;
    }
    break;
  }
  measure_cells(laying);
  result.bands = laying.measures;
  result.bands.n_triangles = result.mesh.n_band;
  return result;
}

}  // namespace sterna::surfmesh
