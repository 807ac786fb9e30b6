#include "surfmesh/remesh/remesh_report.h"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <sstream>

#include "geom/base/parallel.h"
#include "geom/math/measures.h"
#include "geom/math/nearest.h"
#include "geom/mesh/bvh.h"

namespace sterna::surfmesh {
namespace {

constexpr double k_to_degrees = 180.0 / std::numbers::pi;

double longest_edge(const TriMesh& mesh, TriangleId t) {
  const auto [a, b, c] = corners(mesh, t);
  return std::max({distance(a, b), distance(b, c), distance(c, a)});
}

}  // namespace

void measure_angles(const TriMesh& mesh, RemeshReport& report) {
  report.n_triangles = static_cast<std::int64_t>(mesh.n_triangles());
  report.length = body_length(mesh);
  report.min_angle = std::numbers::pi;
  std::vector<double> least;
  double sum = 0.0, area_sum = 0.0;
  for (const TriangleId t : mesh.triangles.ids()) {
    const auto [a, b, c] = corners(mesh, t);
    const double x = distance(a, b), y = distance(b, c), z = distance(c, a), area = triangle_area(a, b, c);
    if (x * y * z > 0.0) sum += area * 16.0 * area * area / ((x + y + z) * x * y * z);
    area_sum += area;
    const std::array<double, 3> angles{corner_angle(a, b, c), corner_angle(b, c, a), corner_angle(c, a, b)};
    const auto [low, high] = std::minmax_element(angles.begin(), angles.end());
    least.push_back(*low);
    report.min_angle = std::min(report.min_angle, *low);
    report.max_angle = std::max(report.max_angle, *high);
    ++report.least_angles[std::min<std::size_t>(5, static_cast<std::size_t>(*low * k_to_degrees / 10.0))];
  }
  report.mean_radius_ratio = area_sum > 0.0 ? sum / area_sum : 0.0;
  if (least.empty()) return;
  const auto at_1 = least.begin() + static_cast<std::ptrdiff_t>(least.size() / 100);
  std::nth_element(least.begin(), at_1, least.end());
  report.angle_quantile_1 = *at_1;
}

SliverCount count_slivers(const TriMesh& mesh, double limit) {
  SliverCount slivers;
  for (const TriangleId t : mesh.triangles.ids()) {
    const auto [a, b, c] = corners(mesh, t);
    const double least = std::min({corner_angle(a, b, c), corner_angle(b, c, a), corner_angle(c, a, b)});
    if (least < limit) ++slivers.n;
    if (t.index() == 0 || least < slivers.least_angle) {
      slivers.least_angle = least;
      slivers.location = (a + b + c) / 3.0;
    }
  }
  return slivers;
}

bool is_remesh_advised(const SliverCount& slivers, std::size_t n_triangles) {
  return slivers.n > 0 && (slivers.least_angle < k_worst_sliver_angle || static_cast<double>(slivers.n) > k_sliver_share * static_cast<double>(n_triangles));
}

SurfaceDistance surface_distance(const TriMesh& from, const TriMesh& to, bool is_from_new, const RunContext& context) {
  const TriangleTree tree(to, context);
  struct Part {
    SurfaceDistance distance;
    CompensatedSum sum;
    std::int64_t n = 0;
    void add(const Point& p, double d, double edge) {
      sum.add(d);
      ++n;
      if (edge > 0.0) distance.of_edge = std::max(distance.of_edge, d / edge);
      if (d > distance.max) {
        distance.max = d;
        distance.location = p;
      }
    }
  };
  const std::size_t n_points = from.n_vertices();
  Part all = parallel_reduce(
      context, n_points + from.n_triangles(), Part{},
      [&](std::size_t begin, std::size_t end) {
        Part part;
        TriangleId last;
        const auto add = [&](const Point& p, double edge) {
          // The nearest triangle of the previous query gives an upper limit for the distance.
          NearestHit hit;
          if (last.is_valid()) hit = tree.nearest(p, distance(p, nearest_on_triangle(p, corners(to, last))) * (1.0 + 1e-9));
          if (!hit.triangle.is_valid()) hit = tree.nearest(p);
          part.add(p, hit.distance, is_from_new ? edge : longest_edge(to, hit.triangle));
          last = hit.triangle;
        };
        for (std::size_t i = begin; i < end; ++i) {
          if (i < n_points) {
            add(from.points[VertexId(i)], 0.0);
            continue;
          }
          // The middle of each edge is visited once, in the triangle in which its vertices ascend. Edges of an open boundary may be left out; their middles are
          // also middles of edges of the input.
          const TriangleVertices& v = from.triangles[TriangleId(i - n_points)];
          const auto [a, b, c] = corners(from, TriangleId(i - n_points));
          const double edge = longest_edge(from, TriangleId(i - n_points));
          add((a + b + c) / 3.0, edge);
          if (v[0] < v[1]) add(0.5 * (a + b), edge);
          if (v[1] < v[2]) add(0.5 * (b + c), edge);
          if (v[2] < v[0]) add(0.5 * (c + a), edge);
        }
        return part;
      },
      [](Part a, const Part& b) {
        a.sum.add(b.sum);
        a.n += b.n;
        const double of_edge = std::max(a.distance.of_edge, b.distance.of_edge);
        if (b.distance.max > a.distance.max) a.distance = b.distance;
        a.distance.of_edge = of_edge;
        return a;
      });
  all.distance.mean = all.n > 0 ? all.sum.value() / static_cast<double>(all.n) : 0.0;
  return all.distance;
}

std::string to_text(const RemeshReport& r) {
  std::ostringstream text;
  text.precision(3);
  const auto far = [&](const SurfaceDistance& d) {
    std::ostringstream s;
    s.precision(3);
    s << d.max << " m (" << d.max / r.length << " of the length) at " << format_point(d.location) << ", mean " << d.mean << " m";
    return s.str();
  };
  text << r.n_triangles_before << " triangles were remeshed to " << r.n_triangles << "; edges of " << r.least_size << " to " << r.max_edge
       << " m were requested; " << r.n_lines << " lines between " << r.n_corners << " corners were kept\n";
  text << "angles " << r.min_angle * k_to_degrees << " to " << r.max_angle * k_to_degrees << " degrees, 1 % of the triangles below "
       << r.angle_quantile_1 * k_to_degrees << ", radius ratio " << r.mean_radius_ratio << " by area\n";
  text << "distance of the new surface from the input surface: " << far(r.to_input) << "\n";
  text << "distance of the input surface from the new surface: " << far(r.from_input);
  if (r.n_slivers > 0) {
    text << "\n"
         << r.n_slivers << " sliver triangles (a corner below " << k_sliver_angle * k_to_degrees << " degrees) are forced by lines and corners, the worst:";
    for (const ErrorLocation& location : r.slivers) text << "\n  " << format_point(location.position) << " " << location.what;
  }
  if (r.rows.n_triangles > 0)
    text << "\nrows at leading and trailing edges: " << r.rows.n_triangles << " triangles at " << r.rows.n_columns << " locations (" << r.rows.n_without
         << " without), stretched by at most " << r.rows.max_stretch << ", growth at most " << r.rows.max_growth
         << "; the angles above include these triangles";
  for (const std::string& note : r.rows.notes) text << "\n" << note;
  if (r.n_kept > 0) text << "\n" << r.n_kept << " input triangles were kept, because new triangles would cross";
  return text.str();
}

}  // namespace sterna::surfmesh
