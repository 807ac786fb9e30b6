#include "geom/delaunay/planar.h"

#include <algorithm>
#include <cmath>
#include <string>

#include "geom/base/error.h"
#include "geom/delaunay/insertion_order.h"

namespace sterna::delaunay {
namespace {

using Kind = Location::Kind;

/// Number of points between two checks of the stop token.
constexpr std::size_t k_stop_interval = 1 << 16;

void check_input(std::span<const Vec2> points, std::span<const Segment> segments) {
  const auto fail = [](std::string problem) {
    throw Error({.code = ErrorCode::bad_argument, .attempted = "triangulating points and segments in the plane", .problem = std::move(problem)});
  };
  for (std::size_t i = 0; i < points.size(); ++i)
    if (!std::isfinite(points[i].x) || !std::isfinite(points[i].y)) fail("point " + std::to_string(i) + " has a coordinate that is not finite");
  for (std::size_t i = 0; i < segments.size(); ++i)
    if (std::max(segments[i].from, segments[i].to) >= points.size())
      fail("segment " + std::to_string(i) + " ends at point " + std::to_string(std::max(segments[i].from, segments[i].to)) + ", the number of points is " +
           std::to_string(points.size()));
}

bool is_same_location(const Vec2& a, const Vec2& b) { return a.x == b.x && a.y == b.y; }

/// Creates a triangle of three points and the three ghost triangles around it. \pre turn(a, b, c) > 0
void make_first_triangle(Triangulation& mesh, VertexId a, VertexId b, VertexId c) {
  mesh.cells.assign(4, Cell{});
  const std::array<VertexId, 3> v{a, b, c};
  const TriangleId real(0);
  mesh.cells[real].vertex = v;
  for (std::uint32_t k = 0; k < 3; ++k) {
    const TriangleId ghost(1 + k), before(1 + (k + 2) % 3), after(1 + (k + 1) % 3);
    // Across the edge from v[k] to v[k + 1].
    mesh.cells[ghost].vertex = {v[(k + 1) % 3], v[k], k_ghost};
    mesh.cells[ghost].twin = {halfedge(real, k), halfedge(before, 2), halfedge(after, 1)};
    mesh.cells[real].twin[k] = halfedge(ghost, 0);
    mesh.outgoing[v[k]] = halfedge(real, k);
  }
}

/// Moves the first three points of `order` that form a triangle to its front; returns false if all are collinear.
bool bring_triangle_to_front(std::span<const Vec2> points, std::vector<std::uint32_t>& order) {
  const auto point = [&](std::size_t i) -> const Vec2& { return points[order[i]]; };
  const auto bring = [&](std::size_t from, std::size_t to) {
    std::rotate(order.begin() + static_cast<std::ptrdiff_t>(to), order.begin() + static_cast<std::ptrdiff_t>(from),
                order.begin() + static_cast<std::ptrdiff_t>(from) + 1);
  };
  std::size_t second = 1;
  while (second < order.size() && is_same_location(point(second), point(0))) ++second;
  if (second >= order.size()) return false;
  bring(second, 1);
  std::size_t third = 2;
  while (third < order.size() && orient2d(point(0), point(1), point(third)) == 0) ++third;
  if (third >= order.size()) return false;
  bring(third, 2);
  return true;
}

/// Merges coincident points of a collinear set, which has no triangles.
void join_points_of_line(std::span<const Vec2> points, std::vector<std::uint32_t>& order, std::vector<VertexId>& same_as) {
  std::sort(order.begin(), order.end(), [&](std::uint32_t i, std::uint32_t j) {
    const Vec2 &a = points[i], &b = points[j];
    return a.x != b.x ? a.x < b.x : a.y != b.y ? a.y < b.y : i < j;
  });
  for (std::size_t i = 1; i < order.size(); ++i)
    if (is_same_location(points[order[i - 1]], points[order[i]])) same_as[order[i]] = same_as[order[i - 1]];
}

/// Renumbers vertices from the order of insertion to the numbers of their points.
void renumber_vertices(Triangulation& mesh, std::span<const Vec2> points, const std::vector<std::uint32_t>& order) {
  for (Cell& cell : mesh.cells)
    for (VertexId& v : cell.vertex)
      if (v.is_valid()) v = VertexId(order[v.index()]);
  Column<VertexId, HalfedgeId> outgoing(points.size());
  for (std::size_t i = 0; i < order.size(); ++i) outgoing[VertexId(order[i])] = mesh.outgoing[VertexId(static_cast<std::uint64_t>(i))];
  mesh.outgoing = std::move(outgoing);
  mesh.uv = Column<VertexId, Vec2>(std::vector<Vec2>(points.begin(), points.end()));
}

/// Computes the Delaunay triangulation of the points. During construction, vertices are numbered in the order of insertion, so that neighbours are close in
/// memory.
void insert_points(std::span<const Vec2> points, PlanarTriangulation& result, const RunContext& context) {
  Triangulation& mesh = result.mesh;
  const std::size_t n = points.size();
  std::vector<std::uint32_t> order = insertion_order(points);
  if (!bring_triangle_to_front(points, order)) {
    join_points_of_line(points, order, result.same_as);
    mesh.uv = Column<VertexId, Vec2>(std::vector<Vec2>(points.begin(), points.end()));
    mesh.outgoing.assign(n, HalfedgeId{});
    return;
  }
  mesh.uv.resize(n);
  for (std::size_t i = 0; i < n; ++i) mesh.uv[VertexId(static_cast<std::uint64_t>(i))] = points[order[i]];
  mesh.outgoing.assign(n, HalfedgeId{});
  mesh.cells.reserve(2 * n + 4);
  const bool is_left = mesh.turn(VertexId(0u), VertexId(1u), VertexId(2u)) > 0;
  make_first_triangle(mesh, VertexId(0u), VertexId(is_left ? 1u : 2u), VertexId(is_left ? 2u : 1u));
  Cavity cavity;
  TriangleId last(0);
  for (std::size_t i = 3; i < n; ++i) {
    if (i % k_stop_interval == 0) context.check_stop();
    const VertexId p(static_cast<std::uint64_t>(i));
    // In an exact Delaunay triangulation the walk visits no triangle twice.
    const Location location = locate(mesh, mesh.uv[p], last, mesh.cells.size() + 1);
    if (location.kind == Kind::on_vertex) {
      result.same_as[order[i]] = VertexId(order[mesh.origin(location.halfedge).index()]);
      continue;
    }
    insert(mesh, p, location, PlanarCriterion{}, cavity);
    last = cavity.triangles.front();
  }
  renumber_vertices(mesh, points, order);
}

}  // namespace

bool PlanarCriterion::conflicts(const Triangulation& mesh, TriangleId t, VertexId p) const {
  const auto& v = mesh.cells[t].vertex;
  const Vec2& plane_point = mesh.uv[p];
  for (std::size_t k = 0; k < 3; ++k) {
    if (v[k].is_valid()) continue;
    const Vec2 &a = mesh.uv[v[(k + 1) % 3]], &b = mesh.uv[v[(k + 2) % 3]];
    const int side = orient2d(a, b, plane_point);
    if (side != 0) return side > 0;
    // A place on the line of the edge is in conflict only if it lies between the ends of the edge.
    return a.x != b.x ? std::min(a.x, b.x) < plane_point.x && plane_point.x < std::max(a.x, b.x)
                      : std::min(a.y, b.y) < plane_point.y && plane_point.y < std::max(a.y, b.y);
  }
  return incircle(mesh.uv[v[0]], mesh.uv[v[1]], mesh.uv[v[2]], plane_point) > 0;
}

PlanarTriangulation triangulate_plane(std::span<const Vec2> points, std::span<const Segment> segments, Extent extent, const RunContext& context) {
  check_input(points, segments);
  PlanarTriangulation result;
  result.same_as.resize(points.size());
  for (std::size_t i = 0; i < points.size(); ++i) result.same_as[i] = VertexId(static_cast<std::uint64_t>(i));
  insert_points(points, result, context);
  if (!result.mesh.cells.empty())
    for (const Segment& segment : segments) insert_segment(result.mesh, result.same_as[segment.from], result.same_as[segment.to], segment.is_border);
  if (extent == Extent::inside) carve(result.mesh);
  return result;
}

std::vector<TriangleVertices> extract_triangles(const Triangulation& mesh) {
  std::vector<TriangleVertices> triangles;
  triangles.reserve(mesh.n_triangles());
  for (const TriangleId t : mesh.cells.ids())
    if (!mesh.cells[t].is_dead && !mesh.is_ghost(t)) triangles.push_back(mesh.cells[t].vertex);
  return triangles;
}

void carve(Triangulation& mesh) {
  // Flood fill by depth: triangles reached from outside without crossing a border are at depth 0, behind one border at depth 1 ...
  constexpr std::uint32_t k_unseen = ~0u;
  Column<TriangleId, std::uint32_t> depth(mesh.cells.size(), k_unseen);
  std::vector<TriangleId> level, next_level;
  for (const TriangleId t : mesh.cells.ids())
    if (!mesh.cells[t].is_dead && mesh.is_ghost(t)) level.push_back(t);
  for (std::uint32_t d = 0; !level.empty(); ++d, level.swap(next_level), next_level.clear()) {
    while (!level.empty()) {
      const TriangleId t = level.back();
      level.pop_back();
      if (depth[t] != k_unseen) continue;
      depth[t] = d;
      for (std::uint32_t c = 0; c < 3; ++c) {
        const TriangleId other = triangle_of(mesh.cells[t].twin[c]);
        if (depth[other] != k_unseen) continue;
        ((mesh.cells[t].flags[c] & k_domain_border) != 0 ? next_level : level).push_back(other);
      }
    }
  }
  Column<TriangleId, TriangleId> kept(mesh.cells.size());
  std::uint32_t n = 0;
  for (const TriangleId t : mesh.cells.ids())
    if (!mesh.cells[t].is_dead && depth[t] % 2 == 1) kept[t] = TriangleId(n++);
  Column<TriangleId, Cell> cells(n);
  mesh.outgoing.assign(mesh.outgoing.size(), HalfedgeId{});
  for (const TriangleId t : mesh.cells.ids()) {
    if (!kept[t].is_valid()) continue;
    Cell& cell = cells[kept[t]];
    cell = mesh.cells[t];
    for (std::uint32_t c = 0; c < 3; ++c) {
      const HalfedgeId out = cell.twin[c];
      const TriangleId other = kept[triangle_of(out)];
      cell.twin[c] = other.is_valid() ? halfedge(other, corner_of(out)) : HalfedgeId{};
      mesh.outgoing[cell.vertex[c]] = halfedge(kept[t], c);
    }
  }
  mesh.cells = std::move(cells);
  mesh.free_cells.clear();
}

}  // namespace sterna::delaunay
