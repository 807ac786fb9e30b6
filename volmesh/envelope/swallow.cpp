// Surfaces that do not cross may still lie within each other's layers. Examples are a small body inside a thick layer, layers that have passed through one
// another in an annulus, and a layer beyond the outer boundary. If nothing crosses, it is sufficient to test one point of the wall and one point of the top of
// each connected part, and the points of the outer boundary. None of them may lie within a macro-element of another part.
#include <algorithm>
#include <cmath>
#include <numbers>

#include "volmesh/envelope/collide.h"

namespace sterna::volmesh {
namespace {

/// Winding numbers are 0 or 1 except for rounding. Points with a larger number are inside.
constexpr double k_swallowed_inside = 0.5;
/// Smallest winding number of a cell that contains a point, alone or together with the neighbour on the point's side.
constexpr double k_holds = 0.1;
constexpr int k_swallow_bisections = 10;  ///< number of halvings; the result is within 0.1 % of the height

/// Returns the solid angle of a triangle as seen from p, divided by 4 pi. It is positive if the triangle's normal points away from p (Van Oosterom & Strackee
/// 1983).
double winding(const Point& p, const Point& p0, const Point& p1, const Point& p2) {
  const Vec3 a = p0 - p, b = p1 - p, c = p2 - p;
  const double la = norm(a), lb = norm(b), lc = norm(c);
  return std::atan2(dot(a, cross(p1 - p0, p2 - p0)), la * lb * lc + dot(a, b) * lc + dot(b, c) * la + dot(c, a) * lb) / (2.0 * std::numbers::pi);
}

/// Returns the winding number of a macro-element at the fraction `share` of its heights. Sides are split from the wall vertex with the lower number, so that
/// neighbours fit together.
double cell_winding(const LayerBase& base, const EnvelopeShape& shape, TriangleId t, double share, const Point& p) {
  const TriangleVertices& v = base.wall.triangles[t];
  std::array<Point, 3> low, top;
  for (std::size_t k = 0; k < 3; ++k) {
    low[k] = base.wall.points[v[k]];
    top[k] = low[k] + (share * shape.height[v[k]]) * shape.direction[v[k]];
  }
  double sum = winding(p, low[0], low[2], low[1]) + winding(p, top[0], top[1], top[2]);
  for (std::size_t k = 0; k < 3; ++k) {
    const std::size_t l = (k + 1) % 3;
    sum += v[k] < v[l] ? winding(p, low[k], low[l], top[l]) + winding(p, low[k], top[l], top[k])
                       : winding(p, low[k], low[l], top[k]) + winding(p, low[l], top[l], top[k]);
  }
  return sum;
}

}  // namespace

std::vector<Swallowing> Collider::swallowings(const EnvelopeShape& shape) const {
  std::vector<Swallowing> all;
  std::vector<std::uint32_t> near;
  // \p part component of the point's own layer, whose cells are not tested. \p mover vertex whose height moves the point
  const auto look = [&](const Point& p, std::uint32_t part, VertexId mover) {
    near.clear();
    Box box;
    box.add(p);
    find_cells(box, near);
    double sum = 0.0;
    std::vector<TriangleId> holders;
    for (const std::uint32_t item : near) {
      if (component_[TriangleId(item)] == part) continue;
      const double own = cell_winding(base_, shape, TriangleId(item), 1.0, p);
      sum += own;
      if (own > k_holds) holders.push_back(TriangleId(item));
    }
    if (sum < k_swallowed_inside || holders.empty()) return;
    Swallowing found{p, {}, 0.0};
    for (const TriangleId t : holders)
      for (const VertexId v : base_.wall.triangles[t]) found.vertices.push_back(v);
    if (mover.is_valid()) found.vertices.push_back(mover);
    double swallowed = 1.0;
    for (int step = 0; step < k_swallow_bisections; ++step) {
      const double middle = 0.5 * (found.clear_share + swallowed);
      const Point q = mover.is_valid() ? base_.wall.points[mover] + (middle * shape.height[mover]) * shape.direction[mover] : p;
      const bool is_inside = std::any_of(holders.begin(), holders.end(), [&](TriangleId t) { return cell_winding(base_, shape, t, middle, q) > k_holds; });
      (is_inside ? swallowed : found.clear_share) = middle;
    }
    all.push_back(std::move(found));
  };
  std::vector<std::uint8_t> has_wall_point(n_components_, 0), has_top_point(n_components_, 0);
  for (const TriangleId t : base_.wall.triangles.ids()) {
    if (n_components_ < 2) break;
    const std::uint32_t part = component_[t];
    const VertexId v = base_.wall.triangles[t][0];
    if (!has_wall_point[part]) look(base_.wall.points[v], part, {});
    has_wall_point[part] = 1;
    if (has_top_point[part] || shape.is_collapsed(v)) continue;
    look(shape.point(base_.wall, v), part, v);
    has_top_point[part] = 1;
  }
  // Vertices of re-meshed patches that a layer covers will not exist in the final mesh.
  Column<VertexId, std::uint8_t> is_passing(outer_ ? outer_->n_vertices() : 0, 0);
  for (std::size_t t = 0; links_ && t < outer_->n_triangles(); ++t)
    if (links_->surface[TriangleId(t)] >= 0)
      for (const VertexId v : outer_->triangles[TriangleId(t)]) is_passing[v] = 1;
  for (const VertexId v : is_passing.ids())
    if (!is_passing[v]) look(outer_->points[v], k_none, {});
  return all;
}

}  // namespace sterna::volmesh
