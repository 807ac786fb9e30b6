#include "volmesh/tetra/two_pass.h"

#include <array>
#include <utility>
#include <vector>

namespace sterna::volmesh {
namespace {

constexpr int k_sweeps = 10;  ///< number of smoothing sweeps: the distance in edges over which boundary sizes affect the volume
constexpr double k_relaxation = 0.5;

}  // namespace

SizeSource nodal_sizes(const TetraBoundary& boundary, const TetraResult& coarse, const RunContext& context) {
  const std::size_t n_fixed = boundary.points.size();
  const std::size_t n = n_fixed + coarse.new_points.size();
  const auto point = [&](std::size_t v) { return v < n_fixed ? boundary.points[v] : coarse.new_points[v - n_fixed]; };
  std::vector<double> sum(n, 0.0), count(n, 0.0), size(n);
  const auto for_each_edge = [&](const auto& f) {
    constexpr std::array<std::pair<std::size_t, std::size_t>, 6> k_edges = {{{0, 1}, {0, 2}, {0, 3}, {1, 2}, {1, 3}, {2, 3}}};
    for (const auto& tet : coarse.tetrahedra)
      for (const auto& [i, j] : k_edges) f(tet[i], tet[j]);
  };
  for_each_edge([&](std::uint32_t a, std::uint32_t b) {
    const double length = distance(point(a), point(b));
    for (const std::uint32_t v : {a, b}) {
      sum[v] += length;
      count[v] += 1.0;
    }
  });
  for (std::size_t v = 0; v < n; ++v) size[v] = sum[v] / count[v];
  for (int sweep = 0; sweep < k_sweeps; ++sweep) {
    context.check_stop();
    sum.assign(n, 0.0);
    for_each_edge([&](std::uint32_t a, std::uint32_t b) {
      sum[a] += size[b];
      sum[b] += size[a];
    });
    for (std::size_t v = n_fixed; v < n; ++v) size[v] += k_relaxation * (sum[v] / count[v] - size[v]);
  }
  return {.kind = SourceKind::samples, .points = coarse.new_points, .sizes = {size.begin() + static_cast<std::ptrdiff_t>(n_fixed), size.end()}};
}

}  // namespace sterna::volmesh
