// Compares our tetrahedral kernel with the other engines: tetrahedra per second and growth of the time with the size, all on the same input in one run.
// usage: tets_bench [--threads 2] [--millions 1,2,5] [--engines sterna,hxt,tetgen] [--insertion yes|no]
// 1. Delaunay insertion of random points into a cube, along the curve in rounds that grow by a factor of eight: the kernel alone.
// 2. A sphere in a farfield that a source fills with small tetrahedra: each engine's own seconds, and the total CPU time (with transfer and proof); for
// "sterna", recovery and refinement separately. An exponent is the least-squares slope of the logarithm of the seconds over the logarithm of the tetrahedra.
#include <sys/resource.h>

#include <algorithm>
#include <chrono>
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <random>
#include <span>
#include <string>
#include <vector>

#include "geom/base/error.h"
#include "geom/tets/bulk_insert.h"
#include "tests/support/test_shapes.h"
#include "volmesh/domain/farfield.h"
#include "volmesh/tetra/size_field.h"
#include "volmesh/tetra/tetra.h"

namespace {

using namespace sterna;
using namespace sterna::volmesh;

struct Settings {
  int threads = 2;
  std::vector<std::string> millions = {"1", "2", "5"};
  std::vector<std::string> engines = {"sterna", "hxt", "tetgen"};
  bool has_insertion = true;
};

struct Timing {
  double n = 0.0, seconds = 0.0;
};

std::vector<std::string> parts_of(const std::string& text) {
  std::vector<std::string> parts(1);
  for (const char c : text) {
    if (c == ',') parts.emplace_back();
    else parts.back() += c;
  }
  return parts;
}

double exponent_of(std::span<const Timing> timings) {
  double n = 0.0, x = 0.0, y = 0.0, xx = 0.0, xy = 0.0;
  for (const Timing& t : timings) {
    const double a = std::log(t.n), b = std::log(t.seconds);
    n += 1.0;
    x += a;
    y += b;
    xx += a * a;
    xy += a * b;
  }
  return n < 2.0 ? 0.0 : (n * xy - x * y) / (n * xx - x * x);
}

Timing insert_points(std::size_t n_points, const RunContext& context) {
  const std::vector<Vec3> corners = {{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {1, 1, 0}, {0, 0, 1}, {1, 0, 1}, {0, 1, 1}, {1, 1, 1}};
  const std::vector<tets::Corners> cube = {{0, 1, 3, 7}, {0, 3, 2, 7}, {0, 2, 6, 7}, {0, 6, 4, 7}, {0, 4, 5, 7}, {0, 5, 1, 7}};
  std::mt19937_64 generator(1);
  std::uniform_real_distribution<double> at(1e-6, 1.0 - 1e-6);
  std::vector<Vec3> locations(n_points);
  for (Vec3& p : locations) {
    p.x = at(generator);
    p.y = at(generator);
    p.z = at(generator);
  }
  const auto start = std::chrono::steady_clock::now();
  tets::TetMesh mesh = tets::connect(corners, cube, context);
  tets::BulkInserter inserter(mesh, context);
  for (std::size_t first = 0, n = 64; first < n_points; first += n, n *= 8) {
    n = std::min(n, n_points - first);
    std::vector<tets::Seed> seeds(n);
    for (std::size_t i = 0; i < n; ++i) seeds[i].position = locations[first + i];
    inserter.find_starts(seeds, context);
    inserter.insert(seeds, context);
  }
  tets::compact(mesh, 0);
  const double seconds = std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
  return {static_cast<double>(mesh.nodes.size()), seconds};
}

/// CPU time including helper processes that have ended; hardly affected by other load on the machine.
double processor_seconds() {
  double sum = 0.0;
  for (const int who : {RUSAGE_SELF, RUSAGE_CHILDREN}) {
    rusage usage{};
    getrusage(who, &usage);
    for (const timeval& t : {usage.ru_utime, usage.ru_stime}) sum += static_cast<double>(t.tv_sec) + 1e-6 * static_cast<double>(t.tv_usec);
  }
  return sum;
}

/// Geometric mean edge length of the tetrahedra without corner on the boundary.
double mean_edge(const TetraBoundary& boundary, const TetraResult& result) {
  double sum = 0.0, n = 0.0;
  for (const auto& tet : result.tetrahedra) {
    if (std::ranges::min(tet) < boundary.points.size()) continue;
    const auto point = [&](std::size_t k) { return result.new_points[tet[k] - boundary.points.size()]; };
    for (std::size_t i = 0; i < 4; ++i)
      for (std::size_t j = 0; j < i; ++j) sum += std::log(distance(point(i), point(j)));
    n += 6.0;
  }
  return std::exp(sum / n);
}

double seconds_of(const RunContext& context, const std::string& stage) {
  for (const StageTime& time : context.times())
    if (time.stage == stage) return time.seconds;
  return 0.0;
}

Timing fill_domain(const std::string& engine, double n_tets, const Settings& settings) {
  constexpr double k_radius = 4.0;
  constexpr double k_tets_per_cube = 8.5;  ///< cube with edges of the target size, approximate
  const double size = std::cbrt(4.19 * k_radius * k_radius * k_radius * k_tets_per_cube / n_tets);
  const RunContext context({.threads = settings.threads});
  const TriMesh wall = test::sphere(std::max(4, static_cast<int>(1.0 / size)));
  const TriMesh farfield = farfield_sphere(wall, {.farfield_radius = k_radius}, context);
  std::vector<Vec3> points;
  std::vector<std::array<std::uint32_t, 3>> triangles;
  for (const TriMesh* mesh : {&wall, &farfield}) {
    const auto first = static_cast<std::uint32_t>(points.size());
    points.insert(points.end(), mesh->points.begin(), mesh->points.end());
    for (const TriangleVertices& t : mesh->triangles) triangles.push_back({first + t[0].value(), first + t[1].value(), first + t[2].value()});
  }
  const std::vector<Point> holes = find_cavity_points(wall, context);
  const TetraBoundary boundary{.points = points, .triangles = triangles, .hole_points = holes};
  const std::vector<SizeSource> sources = {{.kind = SourceKind::sphere, .from = {}, .radius = k_radius, .size = size}};
  const SizeField sizes = build_size_field(boundary, sources, {}, context);
  const double processor = processor_seconds();
  const TetraResult result = fill(boundary, &sizes, {.engine = engine, .try_other_engine = false}, context);
  const double used = processor_seconds() - processor;
  const auto n = static_cast<double>(result.tetrahedra.size());
  const double recovery = seconds_of(context, "tetrahedra/recovery"), refinement = seconds_of(context, "tetrahedra/refinement");
  std::printf("| fill | %s | %zu | %.0f | %.2f | %.0f | %.2f | %.2f | %.0f | %.2f | %.3f | %.0f |\n", engine.c_str(), triangles.size(), n,
              double(result.engine_seconds), n / result.engine_seconds / 1000.0, recovery, refinement, refinement > 0.0 ? n / refinement / 1000.0 : 0.0, used,
              mean_edge(boundary, result) / size, result.engine_peak_bytes / 1e6);
  std::fflush(stdout);
  return {n, double(result.engine_seconds)};
}

}  // namespace

int main(int argc, char** argv) {
  Settings settings;
  for (int i = 1; i + 1 < argc; i += 2) {
    const std::string name = argv[i];
    if (name == "--threads") settings.threads = std::atoi(argv[i + 1]);
    else if (name == "--millions") settings.millions = parts_of(argv[i + 1]);
    else if (name == "--engines") settings.engines = parts_of(argv[i + 1]);
    else if (name == "--insertion") settings.has_insertion = std::string(argv[i + 1]) == "yes";
  }
  try {
    std::puts(
        "| work | engine | triangles | tets | s | k tets/s | recovery s | refinement s | k tets/s of it | processor s | edge / size | MB "
        "|\n|---|---|---|---|---|---|---|---|---|---|---|---|");
    std::vector<Timing> timings;
    for (const std::string& millions : settings.has_insertion ? settings.millions : std::vector<std::string>()) {
      const RunContext context({.threads = settings.threads});
      timings.push_back(insert_points(static_cast<std::size_t>(std::atof(millions.c_str()) * 1e6 / 6.7), context));
      std::printf("| insert | sterna | | %.0f | %.2f | %.0f | | | | | | |\n", timings.back().n, timings.back().seconds,
                  timings.back().n / timings.back().seconds / 1000.0);
      std::fflush(stdout);
    }
    if (settings.has_insertion) std::printf("exponent of insertion: %.3f\n", exponent_of(timings));
    for (const std::string& engine : settings.engines) {
      timings.clear();
      for (const std::string& millions : settings.millions) timings.push_back(fill_domain(engine, 1e6 * std::atof(millions.c_str()), settings));
      std::printf("exponent of %s: %.3f\n", engine.c_str(), exponent_of(timings));
    }
  } catch (const Error& error) {
    std::fprintf(stderr, "%s\n", error.what());
    return 1;
  }
  return 0;
}
