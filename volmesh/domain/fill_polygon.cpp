#include "volmesh/domain/fill_polygon.h"

#include <cmath>
#include <numeric>

#include "geom/delaunay/planar.h"
#include "geom/delaunay/refinement_queue.h"

namespace sterna::volmesh {
namespace {

/// Fraction of the target edge: triangles with a larger circumradius get a point (the circumradius of an equilateral triangle is 0.577).
constexpr double k_radius_share = 0.72;
constexpr double k_border_share = 0.5;     ///< fraction of the target edge: smallest distance of new points from the border
constexpr double k_distance_share = 0.55;  ///< fraction of the target edge: smallest distance of new points from other vertices
constexpr std::size_t k_most_points = 20'000'000;

struct Circle {
  Vec2 center;
  double radius = 0.0;
};

Circle circumcircle(const Vec2& a, const Vec2& b, const Vec2& c) {
  const double ux = b.x - a.x, uy = b.y - a.y, vx = c.x - a.x, vy = c.y - a.y;
  const double twice = 2.0 * (ux * vy - uy * vx), u2 = ux * ux + uy * uy, v2 = vx * vx + vy * vy;
  const double x = (vy * u2 - uy * v2) / twice, y = (ux * v2 - vx * u2) / twice;
  return {{a.x + x, a.y + y}, std::hypot(x, y)};
}

/// Task for delaunay::refine: adds the circumcentres of triangles that are too large.
class SizeTask {
 public:
  explicit SizeTask(const std::function<LocalSize(const Vec2&)>& size) : size_(size) {}
  void measure(const delaunay::SurfaceTriangulation&, TriangleId) {}
  double priority(const delaunay::SurfaceTriangulation& surface, TriangleId t) const {
    const Circle circle = circle_of(surface, t);
    return std::isfinite(circle.radius) ? circle.radius - k_radius_share * size_(circle.center).edge : 0.0;
  }
  bool propose(const delaunay::SurfaceTriangulation& surface, TriangleId t, delaunay::Proposal& proposal) const {
    const Circle circle = circle_of(surface, t);
    const LocalSize local = size_(circle.center);
    if (local.from_border < k_border_share * local.edge) return false;
    proposal.at = {circle.center.x, circle.center.y};
    proposal.sample = {{circle.center.x, circle.center.y, 0.0}, {{1, 0, 0}, {0, 1, 0}, {0, 0, 1}}};
    proposal.min_distance = k_distance_share * local.edge;
    return true;
  }
  void inserted(const delaunay::SurfaceTriangulation&, VertexId, const delaunay::Proposal&) {}

 private:
  static Circle circle_of(const delaunay::SurfaceTriangulation& surface, TriangleId t) {
    const auto& v = surface.mesh.cells[t].vertex;
    return circumcircle(surface.mesh.uv[v[0]], surface.mesh.uv[v[1]], surface.mesh.uv[v[2]]);
  }
  const std::function<LocalSize(const Vec2&)>& size_;
};

}  // namespace

PolygonFill fill_polygon(std::span<const Vec2> polygon, const std::function<LocalSize(const Vec2&)>& size, const RunContext& context) {
  delaunay::SurfaceBorder border;
  for (const Vec2& p : polygon) {
    border.stands_for.push_back(VertexId(border.uv.size()));
    border.uv.push_back({p.x, p.y});
    border.samples.push_back({{p.x, p.y, 0.0}, {{1, 0, 0}, {0, 1, 0}, {0, 0, 1}}});
  }
  border.loops.emplace_back(polygon.size());
  std::iota(border.loops.front().begin(), border.loops.front().end(), 0u);
  delaunay::SurfaceTriangulation surface = delaunay::triangulate_border(border, {1.0, 1.0}, context);
  SizeTask task(size);
  delaunay::refine<false>(surface, delaunay::PlanarCriterion{}, task, k_most_points, context);
  PolygonFill fill;
  for (const Vec2& p : surface.mesh.uv) fill.points.push_back(p);
  for (const TriangleVertices& t : delaunay::extract_triangles(surface)) fill.triangles.push_back({t[0].value(), t[1].value(), t[2].value()});
  return fill;
}

std::vector<std::array<std::uint32_t, 3>> triangulate_borders(std::span<const Vec2> points, std::span<const std::array<std::uint32_t, 2>> segments,
                                                              const RunContext& context) {
  std::vector<delaunay::Segment> borders;
  for (const auto& [from, to] : segments) borders.push_back({from, to, true});
  const delaunay::PlanarTriangulation plane = delaunay::triangulate_plane(points, borders, delaunay::Extent::inside, context);
  std::vector<std::array<std::uint32_t, 3>> triangles;
  for (const TriangleVertices& t : delaunay::extract_triangles(plane.mesh)) triangles.push_back({t[0].value(), t[1].value(), t[2].value()});
  return triangles;
}

}  // namespace sterna::volmesh
