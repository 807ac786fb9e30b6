// Speed of building and evaluating a size field.
// usage: size_bench SURFACE...
// Locations: around the vertices of the wall, at distances of 0.1 to 1000 times the local edge, in vertex order (as engines query, neighbour after neighbour)
// and shuffled.
#include <algorithm>
#include <chrono>
#include <cmath>
#include <cstdio>
#include <random>
#include <vector>

#include "io/file/surface_file.h"
#include "surfmesh/stitch/stitch_surface.h"
#include "volmesh/domain/farfield.h"
#include "volmesh/tetra/size_field.h"

namespace {

using namespace sterna;
using namespace sterna::volmesh;
using Clock = std::chrono::steady_clock;

constexpr int k_locations_per_vertex = 20;

double seconds_since(Clock::time_point start) { return std::chrono::duration<double>(Clock::now() - start).count(); }

double rate(const SizeField& field, const std::vector<Vec3>& locations) {
  const Clock::time_point start = Clock::now();
  double sum = 0.0;
  for (const Vec3& p : locations) sum += field(p);
  const double seconds = seconds_since(start);
  return sum > 0.0 ? static_cast<double>(locations.size()) / seconds : 0.0;
}

void measure(const char* path) {
  const RunContext context({.threads = 1});
  const TriMesh wall = surfmesh::stitch_surface({io::read_surface_file(path, context)}, {}, context).mesh;
  const TriMesh outer = farfield_sphere(wall, {}, context);
  std::vector<Vec3> points(wall.points.begin(), wall.points.end());
  std::vector<std::array<std::uint32_t, 3>> triangles;
  const auto shift = static_cast<std::uint32_t>(points.size());
  for (const TriangleVertices& v : wall.triangles) triangles.push_back({v[0].value(), v[1].value(), v[2].value()});
  for (const TriangleVertices& v : outer.triangles) triangles.push_back({v[0].value() + shift, v[1].value() + shift, v[2].value() + shift});
  points.insert(points.end(), outer.points.begin(), outer.points.end());
  const TetraBoundary boundary{points, triangles, {}};
  const Clock::time_point start = Clock::now();
  const SizeField field = build_size_field(boundary, {}, {}, context);
  const double building = seconds_since(start);

  std::mt19937_64 random(1);
  std::normal_distribution<double> normal;
  std::uniform_real_distribution<double> exponent(-1.0, 3.0);
  std::vector<Vec3> locations;
  for (const Point& p : wall.points) {
    const double edge = field(p);
    for (int k = 0; k < k_locations_per_vertex; ++k)
      locations.push_back(p + std::pow(10.0, exponent(random)) * edge * normalized(Vec3{normal(random), normal(random), normal(random)}));
  }
  // Engines traverse space along a curve; here only the distances within each vertex are sorted.
  for (std::size_t first = 0; first < locations.size(); first += k_locations_per_vertex)
    std::sort(locations.begin() + static_cast<std::ptrdiff_t>(first), locations.begin() + static_cast<std::ptrdiff_t>(first + k_locations_per_vertex),
              [&](const Vec3& a, const Vec3& b) { return field(a) < field(b); });
  const double in_order = rate(field, locations);
  std::shuffle(locations.begin(), locations.end(), random);
  std::printf("| %s | %zu | %.2f | %llu | %.1f | %.2f | %.2f |\n", path, wall.n_triangles(), building,
              static_cast<unsigned long long>(field.view().header().n_leaves), static_cast<double>(field.bytes().size()) / 1e6, in_order / 1e6,
              rate(field, locations) / 1e6);
}

}  // namespace

int main(int argc, char** argv) {
  std::puts("| surface | triangles | built in s, one core | leaves | MB | M/s in order | M/s at random |\n|---|---|---|---|---|---|---|");
  for (int i = 1; i < argc; ++i) measure(argv[i]);
  return argc > 1 ? 0 : 2;
}
