// Points per second of the planar kernel, and the ratio to sorting the same points, which is comparable between machines.
// usage: delaunay_bench [N ...]
#include <algorithm>
#include <cstdio>
#include <cstdlib>
#include <ctime>
#include <random>
#include <vector>

#include "geom/delaunay/insertion_order.h"
#include "geom/delaunay/planar.h"

namespace {

using namespace sterna;
/// CPU time, not wall-clock time, so that other work on the machine does not count.
double seconds_since(std::clock_t start) { return static_cast<double>(std::clock() - start) / CLOCKS_PER_SEC; }

void measure(const char* name, const std::vector<Vec2>& points) {
  const RunContext context({.threads = 1});
  std::clock_t start = std::clock();
  const std::size_t n_sorted = delaunay::insertion_order(points).size();
  const double sorting = seconds_since(start);
  start = std::clock();
  const auto result = delaunay::triangulate_plane(points, {}, delaunay::Extent::hull, context);
  const double seconds = seconds_since(start);
  std::printf("%-10s %9zu points %7.3f s %7.3f M points/s  order alone %6.3f s  (%.1f times)  %zu triangles\n", name, n_sorted, seconds,
              static_cast<double>(points.size()) / seconds * 1e-6, sorting, seconds / sorting, result.mesh.n_triangles());
}

}  // namespace

int main(int argc, char** argv) {
  std::vector<std::size_t> sizes;
  for (int i = 1; i < argc; ++i) sizes.push_back(std::strtoull(argv[i], nullptr, 10));
  if (sizes.empty()) sizes = {20'000, 80'000, 320'000, 1'280'000};
  for (const std::size_t n : sizes) {
    std::mt19937_64 random(1);
    std::uniform_real_distribution<double> uniform;
    std::normal_distribution<double> normal;
    std::vector<Vec2> points(n);
    for (Vec2& p : points) p = {uniform(random), uniform(random)};
    measure("uniform", points);
    for (Vec2& p : points) p = {normal(random) * normal(random), normal(random) * normal(random)};
    measure("clustered", points);
  }
  return 0;
}
