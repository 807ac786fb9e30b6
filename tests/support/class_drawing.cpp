#include "tests/support/class_drawing.h"

#include <fmt/format.h>

#include <algorithm>
#include <vector>

namespace sterna::test {
namespace {

constexpr double k_width = 480.0, k_margin = 30.0;  ///< in units of the picture

std::string_view colour_of(const volmesh::VertexClass& flags) {
  if (flags.is_smooth()) return "#b0b0b0";
  if (flags.is_ridge && flags.is_convex && flags.is_concave) return "#2ca02c";
  if (flags.is_corner) return "#9467bd";
  return flags.is_concave ? "#d62728" : flags.is_sharp ? "#ff7f0e" : "#1f77b4";
}

}  // namespace

std::string draw_classes(const volmesh::LayerBase& base, const volmesh::Classification& classes, const volmesh::Envelope& envelope, const Vec3& from,
                         double line_share) {
  const Vec3 towards = normalized(from);
  const Vec3 right = normalized(cross({0, 0, 1}, towards));
  const Vec3 up = cross(towards, right);
  const TriMesh& wall = base.wall;
  const double line = line_share * base.body_length;
  double x0 = 1e300, x1 = -1e300, y0 = 1e300, y1 = -1e300;
  const auto cover = [&](const Point& p) {
    x0 = std::min(x0, dot(p, right)), x1 = std::max(x1, dot(p, right));
    y0 = std::min(y0, dot(p, up)), y1 = std::max(y1, dot(p, up));
  };
  for (const VertexId v : wall.points.ids()) cover(wall.points[v]), cover(wall.points[v] + line * envelope.direction[v]);
  const double scale = (k_width - 2.0 * k_margin) / std::max(x1 - x0, y1 - y0);
  const double height = 2.0 * k_margin + scale * (y1 - y0);
  const auto x_of = [&](const Point& p) { return k_margin + scale * (dot(p, right) - x0); };
  const auto y_of = [&](const Point& p) { return height - k_margin - scale * (dot(p, up) - y0); };

  std::vector<TriangleId> order;
  std::vector<double> depth(wall.n_triangles());
  std::vector<std::uint8_t> is_seen(wall.n_vertices(), 0);
  for (const TriangleId t : wall.triangles.ids()) {
    const auto [a, b, c] = corners(wall, t);
    depth[t.index()] = dot(a + b + c, towards);
    if (dot(base.unit_normal[t], towards) <= 0.0) continue;
    order.push_back(t);
    for (const VertexId v : wall.triangles[t]) is_seen[v.index()] = 1;
  }
  std::stable_sort(order.begin(), order.end(), [&](TriangleId a, TriangleId b) { return depth[a.index()] < depth[b.index()]; });

  std::string svg =
      fmt::format("<svg xmlns=\"http://www.w3.org/2000/svg\" width=\"{:.0f}\" height=\"{:.0f}\">\n<rect width=\"100%\" height=\"100%\" fill=\"white\"/>\n",
                  k_width + 0.0, height);
  for (const TriangleId t : order) {
    const auto p = corners(wall, t);
    svg += fmt::format("<path d=\"M{:.1f} {:.1f}L{:.1f} {:.1f}L{:.1f} {:.1f}Z\" fill=\"#f6f4ee\" stroke=\"#d0ccc0\" stroke-width=\"0.6\"/>\n", x_of(p[0]),
                       y_of(p[0]), x_of(p[1]), y_of(p[1]), x_of(p[2]), y_of(p[2]));
    for (int k = 0; k < 3; ++k) {
      const HalfedgeId h = halfedge(t, k);
      if (!classes.is_feature[h]) continue;
      const Point a = wall.points[base.topology.from(h)], b = wall.points[base.topology.to(h)];
      svg += fmt::format("<path d=\"M{:.1f} {:.1f}L{:.1f} {:.1f}\" stroke=\"#404040\" stroke-width=\"1.8\"/>\n", x_of(a), y_of(a), x_of(b), y_of(b));
    }
  }
  for (const VertexId v : wall.points.ids()) {
    if (!is_seen[v.index()]) continue;
    const Point p = wall.points[v], q = p + line * envelope.direction[v];
    const std::string_view colour = colour_of(classes.vertex[v]);
    const double radius = classes.vertex[v].is_smooth() ? 1.6 : 3.4;
    svg += fmt::format("<path d=\"M{:.1f} {:.1f}L{:.1f} {:.1f}\" stroke=\"{}\" stroke-width=\"1\"/>", x_of(p), y_of(p), x_of(q), y_of(q), colour);
    svg += fmt::format("<circle cx=\"{:.1f}\" cy=\"{:.1f}\" r=\"{}\" fill=\"{}\"/>\n", x_of(p), y_of(p), radius, colour);
  }
  return svg + "</svg>\n";
}

}  // namespace sterna::test
