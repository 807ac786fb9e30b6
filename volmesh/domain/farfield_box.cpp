// A box whose sides have their own edge lengths. Each of its twelve edges is divided once, by the finer of its two sides. Each side is then filled between its
// four edges.
#include <algorithm>
#include <array>
#include <cmath>
#include <string>

#include "geom/base/error.h"
#include "geom/base/number_text.h"
#include "volmesh/domain/farfield.h"
#include "volmesh/domain/fill_polygon.h"
#include "volmesh/domain/shape_sizes.h"

namespace sterna::volmesh {
namespace {

constexpr const char* k_box_attempt = "making the farfield box";

struct BoxSize {
  Box box;
  std::array<double, 6> edge{};  ///< target edge length of each side
};

BoxSize size_of_box(const TriMesh& wall, const FarfieldOptions& options, std::span<const EndPlane> ends) {
  BoxSize size;
  const Box of_wall = bounding_box(wall);
  const double reach = k_default_radius * body_length(wall);
  const std::array from = {options.farfield_from_x, options.farfield_from_y, options.farfield_from_z},
                   to = {options.farfield_to_x, options.farfield_to_y, options.farfield_to_z};
  for (std::size_t k = 0; k < 3; ++k) {
    size.box.min[k] = of_wall.center()[k] - reach;
    size.box.max[k] = of_wall.center()[k] + reach;
    for (const EndPlane& end : ends)
      if (end.axis == k) (end.inward > 0.0 ? size.box.min : size.box.max)[k] = end.at;
    if (!is_automatic(from[k])) size.box.min[k] = from[k];
    if (!is_automatic(to[k])) size.box.max[k] = to[k];
    if (!(size.box.max[k] > size.box.min[k]))
      throw Error({.code = ErrorCode::bad_argument,
                   .attempted = k_box_attempt,
                   .problem = std::string("the box extends from ") + "xyz"[k] + " = " + in_metres(size.box.min[k]) + " to " + in_metres(size.box.max[k]),
                   .hint = "give the lower corner first (farfield_from), then the upper corner (farfield_to)"});
  }
  const double common = common_edge(options.farfield_edge, k_default_edge * 0.5 * size.box.longest_side());
  for (std::size_t side = 0; side < 6; ++side) size.edge[side] = edge_of_side(options.farfield_sides, k_box_sides[side], common);
  return size;
}

void check_encloses(const TriMesh& wall, const Box& box, std::span<const EndPlane> ends) {
  const double margin = k_shape_margin * body_length(wall);
  ErrorInfo info{.code = ErrorCode::bad_argument, .attempted = k_box_attempt, .hint = "move farfield_from and farfield_to apart"};
  for (std::size_t side = 0; side < 6; ++side) {
    const std::size_t k = side / 2;
    const bool is_upper = side % 2 == 1;
    const double at = is_upper ? box.max[k] : box.min[k];
    const auto beyond = [&](const Point& p) { return is_upper ? p[k] - at : at - p[k]; };
    const Point farthest = *std::max_element(wall.points.begin(), wall.points.end(), [&](const Point& p, const Point& q) { return beyond(p) < beyond(q); });
    const bool is_end = std::any_of(ends.begin(), ends.end(), [&](const EndPlane& end) {
      return end.axis == k && (end.inward > 0.0) != is_upper && beyond({end.at, end.at, end.at}) <= k_coincident * box.longest_side();
    });
    if (is_end || beyond(farthest) + margin <= 0.0) continue;
    info.problem += (info.problem.empty() ? "" : "; ") + std::string("side ") + k_box_sides[side] + " at " + in_metres(at) + ": the wall is " +
                    (beyond(farthest) > 0.0 ? "outside by " : "inside by ") + in_metres(std::abs(beyond(farthest))) + " but must be inside by " +
                    in_metres(margin);
    info.locations.push_back({farthest, std::string("farthest point of the wall towards ") + k_box_sides[side]});
  }
  if (!info.locations.empty()) throw Error(std::move(info));
}

class BoxMesh {
 public:
  BoxMesh(const BoxSize& size, const RunContext& context) : size_(size) {
    for (std::size_t corner = 0; corner < 8; ++corner) {
      Point p;
      for (std::size_t k = 0; k < 3; ++k) p[k] = ((corner >> k) & 1) != 0 ? size.box.max[k] : size.box.min[k];
      mesh_.points.push_back(p);
    }
    for (std::size_t axis = 0; axis < 3; ++axis)
      for (std::size_t corner = 0; corner < 8; ++corner)
        if (((corner >> axis) & 1) == 0) divide(axis, corner);
    for (std::size_t side = 0; side < 6; ++side) fill_side(side, context);
  }
  TriMesh take() { return std::move(mesh_); }

 private:
  double length(std::size_t axis) const { return size_.box.max[axis] - size_.box.min[axis]; }
  /// Divides the edge from a corner along an axis, with the edge length of the finer of the two adjacent sides.
  void divide(std::size_t axis, std::size_t corner) {
    double target = 1e300;
    for (std::size_t k = 0; k < 3; ++k)
      if (k != axis) target = std::min(target, size_.edge[2 * k + ((corner >> k) & 1)]);
    const int n = pieces(length(axis), target);
    std::vector<VertexId>& edge = edges_[axis][corner];
    edge.push_back(VertexId(corner));
    for (int i = 1; i < n; ++i) {
      Point p = mesh_.points[VertexId(corner)];
      p[axis] = size_.box.min[axis] + length(axis) * i / n;
      edge.push_back(mesh_.points.push_back(p));
    }
    edge.push_back(VertexId(corner | (std::size_t{1} << axis)));
  }
  void fill_side(std::size_t side, const RunContext& context) {
    const std::size_t k = side / 2, u = (k + 1) % 3, v = (k + 2) % 3;
    const std::size_t base = (side % 2) << k, at_u = base | (std::size_t{1} << u), at_v = base | (std::size_t{1} << v);
    // The order is: lower u edge, upper v edge, then upper u edge and lower v edge backwards.
    const std::array<const std::vector<VertexId>*, 4> around = {&edges_[u][base], &edges_[v][at_u], &edges_[u][at_v], &edges_[v][base]};
    std::vector<VertexId> loop;
    for (std::size_t i = 0; i < 4; ++i)
      for (std::size_t j = 0; j + 1 < around[i]->size(); ++j) loop.push_back((*around[i])[i < 2 ? j : around[i]->size() - 1 - j]);
    std::vector<Vec2> polygon;
    for (const VertexId p : loop) polygon.push_back({mesh_.points[p][u], mesh_.points[p][v]});
    std::array<double, 4> spacing{};
    for (std::size_t i = 0; i < 4; ++i) spacing[i] = length(i % 2 == 0 ? u : v) / static_cast<double>(around[i]->size() - 1);
    const PolygonFill fill = fill_polygon(
        polygon,
        [&](const Vec2& p) {
          const std::array<double, 4> distance = {p.y - size_.box.min[v], size_.box.max[u] - p.x, size_.box.max[v] - p.y, p.x - size_.box.min[u]};
          LocalSize local{size_.edge[side], distance[0]};
          for (std::size_t i = 0; i < 4; ++i) {
            local.edge = std::min(local.edge, spacing[i] + k_edge_growth * std::max(0.0, distance[i]));
            local.from_border = std::min(local.from_border, distance[i]);
          }
          return local;
        },
        context);
    for (std::size_t i = loop.size(); i < fill.points.size(); ++i) {
      Point p;
      p[k] = side % 2 == 1 ? size_.box.max[k] : size_.box.min[k];
      p[u] = fill.points[i].x;
      p[v] = fill.points[i].y;
      loop.push_back(mesh_.points.push_back(p));
    }
    add_patch(mesh_, k_box_sides[side], fill.triangles, loop, side % 2 == 1);
  }

  const BoxSize& size_;
  TriMesh mesh_;
  std::array<std::array<std::vector<VertexId>, 8>, 3> edges_;  ///< vertices of each edge, indexed by axis and lower corner
};

TriMesh mesh_of_box(const BoxSize& size, const RunContext& context) {
  double n = 0.0;
  for (std::size_t side = 0; side < 6; ++side) {
    const std::size_t u = (side / 2 + 1) % 3, v = (side / 2 + 2) % 3;
    n += triangles_of((size.box.max[u] - size.box.min[u]) * (size.box.max[v] - size.box.min[v]), size.edge[side]);
  }
  require_affordable(n, k_box_attempt);
  return BoxMesh(size, context).take();
}

}  // namespace

TriMesh farfield_box(const TriMesh& wall, const FarfieldOptions& options, std::span<const EndPlane> ends, const RunContext& context) {
  const BoxSize size = size_of_box(wall, options, ends);
  check_encloses(wall, size.box, ends);
  return mesh_of_box(size, context);
}

TriMesh box_side(const Box& box, const std::array<double, 6>& edges, std::size_t side, const RunContext& context) {
  const TriMesh whole = mesh_of_box({box, edges}, context);
  TriMesh mesh;
  Column<VertexId, VertexId> old2new(whole.n_vertices(), VertexId{});
  Column<VertexId, std::uint8_t> is_used(whole.n_vertices(), 0);
  std::vector<std::array<std::uint32_t, 3>> triangles;
  std::vector<VertexId> vertices;
  for (const TriangleId t : whole.triangles.ids()) {
    if (whole.triangle_patch[t].index() != side) continue;
    for (const VertexId v : whole.triangles[t]) {
      if (is_used[v] != 0) continue;
      is_used[v] = 1;
      vertices.push_back(old2new[v] = mesh.points.push_back(whole.points[v]));
    }
    triangles.push_back({old2new[whole.triangles[t][0]].value(), old2new[whole.triangles[t][1]].value(), old2new[whole.triangles[t][2]].value()});
  }
  add_patch(mesh, k_box_sides[side], triangles, vertices, false);
  return mesh;
}

}  // namespace sterna::volmesh
