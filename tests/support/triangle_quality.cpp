#include "tests/support/triangle_quality.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>

#include "geom/math/measures.h"

namespace sterna::test {

TriangleQuality measure_triangles(std::span<const Point> points, std::span<const TriangleVertices> triangles) {
  TriangleQuality result;
  std::vector<double> least;
  std::vector<int> n_triangles(points.size(), 0);
  std::vector<std::array<std::uint32_t, 2>> edges;
  double sum = 0.0, area_sum = 0.0;
  for (const TriangleVertices& v : triangles) {
    const Point &a = points[v[0].index()], &b = points[v[1].index()], &c = points[v[2].index()];
    const double x = distance(a, b), y = distance(b, c), z = distance(c, a), area = triangle_area(a, b, c);
    if (x * y * z > 0.0) sum += area * 16.0 * area * area / ((x + y + z) * x * y * z);
    area_sum += area;
    const std::array<double, 3> angles{corner_angle(a, b, c), corner_angle(b, c, a), corner_angle(c, a, b)};
    const auto [low, high] = std::minmax_element(angles.begin(), angles.end());
    least.push_back(*low * 180.0 / std::numbers::pi);
    result.max_angle = std::max(result.max_angle, *high * 180.0 / std::numbers::pi);
    for (std::size_t k = 0; k < 3; ++k) {
      ++n_triangles[v[k].index()];
      const std::uint32_t from = v[k].value(), to = v[(k + 1) % 3].value();
      edges.push_back({std::min(from, to), std::max(from, to)});
    }
  }
  if (least.empty()) return result;
  result.radius_ratio = area_sum > 0.0 ? sum / area_sum : 0.0;
  const auto at_1 = least.begin() + static_cast<std::ptrdiff_t>(least.size() / 100);
  std::nth_element(least.begin(), at_1, least.end());
  result.angle_quantile_1 = *at_1;
  result.min_angle = *std::min_element(least.begin(), least.end());
  std::sort(edges.begin(), edges.end());
  std::vector<bool> is_free(points.size(), false);
  for (std::size_t i = 0; i < edges.size();) {
    std::size_t j = i;
    while (j < edges.size() && edges[j] == edges[i]) ++j;
    if (j - i != 2) is_free[edges[i][0]] = is_free[edges[i][1]] = true;
    i = j;
  }
  std::size_t n_inner = 0, n_six = 0;
  for (std::size_t i = 0; i < points.size(); ++i) {
    if (is_free[i] || n_triangles[i] == 0) continue;
    ++n_inner;
    if (n_triangles[i] == 6) ++n_six;
  }
  result.share_of_six = n_inner > 0 ? static_cast<double>(n_six) / static_cast<double>(n_inner) : 0.0;
  return result;
}

}  // namespace sterna::test
