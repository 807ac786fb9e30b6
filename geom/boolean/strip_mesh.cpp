// An exchange removes some triangles and fills the hole with others. It is made only if no new triangle turns away from the input triangle that it represents,
// leaves the reference by more than the tolerance, or (exactly) crosses any other triangle that the removed ones did not cross.
#include "geom/boolean/strip_mesh.h"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "geom/math/intersect.h"
#include "geom/math/measures.h"
#include "geom/math/nearest.h"

namespace sterna {
namespace {

/// Exponent (base 2) of the smallest cell size: only triangles of negligible size are smaller.
constexpr int k_least_exponent = -60;

double min_angle_of(const Vec3& a, const Vec3& b, const Vec3& c) { return std::min({corner_angle(a, b, c), corner_angle(b, c, a), corner_angle(c, a, b)}); }

bool contains(const std::vector<VertexId>& list, VertexId value) { return std::find(list.begin(), list.end(), value) != list.end(); }

}  // namespace

// ---- Grid ----

int TriangleGrid::exponent_of(const Box& box) {
  const double side = box.longest_side();
  return side > 0.0 ? std::max(std::ilogb(side) + 1, k_least_exponent) : k_least_exponent;
}

std::array<TriangleGrid::Cell, 2> TriangleGrid::range_of(const Box& box, int exponent) {
  std::array<Cell, 2> range{};
  for (std::size_t k = 0; k < 3; ++k) {
    range[0][k] = static_cast<std::int64_t>(std::floor(std::ldexp(box.min[k], -exponent)));
    range[1][k] = static_cast<std::int64_t>(std::floor(std::ldexp(box.max[k], -exponent)));
  }
  return range;
}

TriangleGrid::Level& TriangleGrid::level(int exponent) {
  for (Level& known : levels_)
    if (known.exponent == exponent) return known;
  return levels_.emplace_back(Level{.exponent = exponent, .cells = {}});
}

void TriangleGrid::insert(TriangleId triangle, const Box& box) {
  Level& home = level(exponent_of(box));
  const auto [low, high] = range_of(box, home.exponent);
  for (std::int64_t i = low[0]; i <= high[0]; ++i)
    for (std::int64_t j = low[1]; j <= high[1]; ++j)
      for (std::int64_t k = low[2]; k <= high[2]; ++k) home.cells[{i, j, k}].push_back(triangle);
}

void TriangleGrid::remove(TriangleId triangle, const Box& box) {
  Level& home = level(exponent_of(box));
  const auto [low, high] = range_of(box, home.exponent);
  for (std::int64_t i = low[0]; i <= high[0]; ++i)
    for (std::int64_t j = low[1]; j <= high[1]; ++j)
      for (std::int64_t k = low[2]; k <= high[2]; ++k) {
        auto& items = home.cells[{i, j, k}];
        items.erase(std::find(items.begin(), items.end(), triangle));
      }
}

// ---- Queries ----

StripMesh::StripMesh(Column<VertexId, Vec3> given_points, Column<TriangleId, StripTriangle> given_triangles, const StripLimits& limits,
                     Borrowed<const TriangleTree> reference)
    : points(std::move(given_points)),
      triangles(std::move(given_triangles)),
      is_alive(triangles.size(), 0),
      star(points.size()),
      limits_(limits),
      reference_(reference) {
  for (const TriangleId t : triangles.ids()) insert(t);
}

std::array<Vec3, 3> StripMesh::corners(TriangleId t) const { return {points[triangles[t].v[0]], points[triangles[t].v[1]], points[triangles[t].v[2]]}; }

double StripMesh::min_angle(const TriangleVertices& v) const { return min_angle_of(points[v[0]], points[v[1]], points[v[2]]); }

Box StripMesh::box_of(TriangleId t) const {
  Box box;
  for (const Vec3& p : corners(t)) box.add(p);
  return box;
}

TriangleId StripMesh::triangle_at(VertexId a, VertexId b) const {
  for (const TriangleId t : star[a]) {
    const auto& v = triangles[t].v;
    for (std::size_t k = 0; k < 3; ++k)
      if (v[k] == a && v[(k + 1) % 3] == b) return t;
  }
  return {};
}

VertexId StripMesh::opposite(TriangleId t, VertexId a, VertexId b) const {
  for (const VertexId v : triangles[t].v)
    if (v != a && v != b) return v;
  return a;
}

bool StripMesh::is_kept_edge(VertexId a, VertexId b) const {
  const auto left = triangle_at(a, b), right = triangle_at(b, a);
  if (!left.is_valid() || !right.is_valid()) return true;
  const StripTriangle &s = triangles[left], &t = triangles[right];
  return s.region != t.region || dot(s.normal, t.normal) < std::cos(limits_.max_bend);
}

std::vector<VertexId> StripMesh::neighbours(VertexId v) const {
  std::vector<VertexId> found;
  for (const TriangleId t : star[v])
    for (const VertexId w : triangles[t].v)
      if (w != v) found.push_back(w);
  std::sort(found.begin(), found.end());
  found.erase(std::unique(found.begin(), found.end()), found.end());
  return found;
}

std::vector<VertexId> StripMesh::kept_neighbours(VertexId v) const {
  std::vector<VertexId> found = neighbours(v);
  std::erase_if(found, [&](VertexId w) { return !is_kept_edge(v, w); });
  return found;
}

std::size_t StripMesh::count_crossings(std::span<const TriangleId> set) const {
  std::size_t n = 0;
  std::vector<TriangleId> near;
  const auto values = [&](TriangleId t) { return std::array{triangles[t].v[0].value(), triangles[t].v[1].value(), triangles[t].v[2].value()}; };
  for (const TriangleId t : set) {
    const Box box = box_of(t);
    near.clear();
    grid_.for_each_near(box, [&](TriangleId other) { near.push_back(other); });
    std::sort(near.begin(), near.end());
    near.erase(std::unique(near.begin(), near.end()), near.end());
    for (const TriangleId other : near) {
      if (other == t || !overlap(box, box_of(other))) continue;
      if (other < t && std::find(set.begin(), set.end(), other) != set.end()) continue;  // the pair is counted for the other triangle
      if (triangles_cross(points.raw(), values(t), values(other))) ++n;
    }
  }
  return n;
}

// ---- Exchanges ----

void StripMesh::insert(TriangleId t) {
  is_alive[t] = 1;
  for (const VertexId v : triangles[t].v) star[v].push_back(t);
  grid_.insert(t, box_of(t));
}

void StripMesh::remove(TriangleId t) {
  is_alive[t] = 0;
  for (const VertexId v : triangles[t].v) std::erase(star[v], t);
  grid_.remove(t, box_of(t));
}

bool StripMesh::are_normals_sound(const Exchange& exchange, double negligible) const {
  const double least = std::cos(limits_.max_bend);
  for (const StripTriangle& t : exchange.added) {
    const Vec3 &a = points[t.v[0]], &b = points[t.v[1]], &c = points[t.v[2]];
    const Vec3 area = area_vector(a, b, c);
    const double longest = std::sqrt(std::max({norm2(b - a), norm2(c - b), norm2(a - c)}));
    if (2.0 * norm(area) < negligible * longest) continue;
    if (!(dot(area, t.normal) > least * norm(area))) return false;
  }
  return true;
}

bool StripMesh::is_near_reference(const Exchange& exchange, double tolerance) const {
  const auto is_near = [&](const Vec3& p) { return reference_.nearest(p, tolerance).triangle.is_valid(); };
  for (const StripTriangle& t : exchange.added) {
    const Vec3 &a = points[t.v[0]], &b = points[t.v[1]], &c = points[t.v[2]];
    if (!is_near((a + b + c) / 3.0) || !is_near(0.5 * (a + b)) || !is_near(0.5 * (b + c)) || !is_near(0.5 * (c + a))) return false;
  }
  return true;
}

void StripMesh::apply(const Exchange& exchange, std::vector<TriangleId>& added) {
  for (const TriangleId t : exchange.removed) remove(t);
  for (const StripTriangle& t : exchange.added) {
    added.push_back(triangles.push_back(t));
    is_alive.push_back(0);
    insert(added.back());
  }
}

void StripMesh::revert(const Exchange& exchange, const std::vector<TriangleId>& added) {
  for (const TriangleId t : added) remove(t);
  triangles.resize(triangles.size() - added.size());
  is_alive.resize(triangles.size());
  for (const TriangleId t : exchange.removed) insert(t);
}

bool StripMesh::exchange_without_crossing(const Exchange& exchange, bool may_leave) {
  std::vector<TriangleId> added;
  apply(exchange, added);
  const std::size_t n_new = count_crossings(added);
  if (n_new == 0) return true;
  revert(exchange, added);
  const std::size_t n_old = count_crossings(exchange.removed);
  if (n_old < n_new || (n_old == n_new && !may_leave)) return false;
  added.clear();
  apply(exchange, added);
  return true;
}

bool StripMesh::flip(VertexId a, VertexId b, double min_gain, double tolerance) {
  const auto left = triangle_at(a, b), right = triangle_at(b, a);
  if (!left.is_valid() || !right.is_valid()) return false;
  const VertexId c = opposite(left, a, b), d = opposite(right, a, b);
  if (c == d || triangle_at(c, d).is_valid() || triangle_at(d, c).is_valid()) return false;
  const StripTriangle &s = triangles[left], &t = triangles[right];
  const Vec3 normal = normalized(s.normal + t.normal);
  const Exchange exchange{{left, right}, {{{a, d, c}, s.region, normal}, {{d, b, c}, s.region, normal}}};
  const double before = std::min(min_angle(left), min_angle(right));
  const double after = std::min(min_angle(exchange.added[0].v), min_angle(exchange.added[1].v));
  if (!(after > before + min_gain)) return false;
  return are_normals_sound(exchange) && is_near_reference(exchange, tolerance) && exchange_without_crossing(exchange);
}

bool StripMesh::is_way_along_kept_edges(VertexId from, VertexId to, double tolerance) const {
  const std::vector<VertexId> kept = kept_neighbours(from);
  if (kept.empty()) return true;
  if (kept.size() != 2 || !contains(kept, to)) return false;
  const VertexId other = kept[0] == to ? kept[1] : kept[0];
  return distance(points[from], nearest_on_segment(points[from], points[to], points[other])) <= tolerance;
}

bool StripMesh::collapse(VertexId from, VertexId to, const CollapseLimits& limits) {
  const auto left = triangle_at(from, to), right = triangle_at(to, from);
  if (!left.is_valid() || !right.is_valid()) return false;
  const bool is_merge = limits.is_one_location || distance(points[from], points[to]) < limits.merge;
  if (!is_merge && !is_way_along_kept_edges(from, to, limits.tolerance)) return false;
  // Link condition: only the two triangles vanish, and the surface remains a closed manifold.
  const std::vector<VertexId> around_from = neighbours(from), around_to = neighbours(to);
  std::vector<VertexId> common;
  std::set_intersection(around_from.begin(), around_from.end(), around_to.begin(), around_to.end(), std::back_inserter(common));
  if (common.size() != 2 || around_from.size() == 3) return false;
  Exchange exchange;
  double before = std::numbers::pi, after = std::numbers::pi, nearest = std::numeric_limits<double>::infinity();
  for (const TriangleId t : star[from]) {
    exchange.removed.push_back(t);
    before = std::min(before, min_angle(t));
    if (t == left || t == right) continue;
    StripTriangle moved = triangles[t];
    std::replace(moved.v.begin(), moved.v.end(), from, to);
    after = std::min(after, min_angle(moved.v));
    const std::array<Vec3, 3> c{points[moved.v[0]], points[moved.v[1]], points[moved.v[2]]};
    nearest = std::min(nearest, distance(points[from], nearest_on_triangle(points[from], c)));
    exchange.added.push_back(moved);
  }
  if (!is_merge && after < limits.least_angle && after <= before) return false;
  if (nearest > limits.tolerance) return false;
  for (const VertexId v : around_from)
    if (v != to && !contains(around_to, v) && distance(points[v], points[to]) > limits.longest) return false;
  return are_normals_sound(exchange, is_merge ? limits.merge : 0.0) && is_near_reference(exchange, limits.tolerance) &&
         exchange_without_crossing(exchange, is_merge);
}

VertexId StripMesh::split(VertexId a, VertexId b) {
  const auto left = triangle_at(a, b), right = triangle_at(b, a);
  if (!left.is_valid() || !right.is_valid()) return {};
  const VertexId m = points.push_back(0.5 * (points[a] + points[b]));
  star.push_back({});
  const VertexId c = opposite(left, a, b), d = opposite(right, a, b);
  const StripTriangle &s = triangles[left], &t = triangles[right];
  const Exchange exchange{{left, right},
                          {{{a, m, c}, s.region, s.normal}, {{m, b, c}, s.region, s.normal}, {{b, m, d}, t.region, t.normal}, {{m, a, d}, t.region, t.normal}}};
  if (are_normals_sound(exchange) && exchange_without_crossing(exchange)) return m;
  points.raw().pop_back();
  star.raw().pop_back();
  return {};
}

bool StripMesh::move(VertexId v, const Vec3& to, double tolerance) {
  Exchange exchange;
  exchange.removed = star[v];
  double before = std::numbers::pi;
  for (const TriangleId t : star[v]) {
    exchange.added.push_back(triangles[t]);
    before = std::min(before, min_angle(t));
  }
  const Vec3 home = points[v];
  const std::size_t n_before = count_crossings(exchange.removed);
  for (const TriangleId t : exchange.removed) grid_.remove(t, box_of(t));
  points[v] = to;
  for (const TriangleId t : exchange.removed) grid_.insert(t, box_of(t));
  double after = std::numbers::pi;
  for (const TriangleId t : exchange.removed) after = std::min(after, min_angle(t));
  if (after > before && are_normals_sound(exchange) && is_near_reference(exchange, tolerance) && count_crossings(exchange.removed) <= n_before) return true;
  for (const TriangleId t : exchange.removed) grid_.remove(t, box_of(t));
  points[v] = home;
  for (const TriangleId t : exchange.removed) grid_.insert(t, box_of(t));
  return false;
}

}  // namespace sterna
