// Speed of the tetrahedra pre-flight (target: 150 000 triangles/s/core): checks of the boundary, then the pre-flight of walls as boundaries, with and without
// the search for crossings.
// usage: preflight_bench [--threads 1,2] SURFACE...        the ladder of surfaces is made by tests/bench/make_ladder
#include <chrono>
#include <cstdio>
#include <cstdlib>
#include <functional>
#include <string>
#include <vector>

#include "io/file/surface_file.h"
#include "surfmesh/stitch/stitch_surface.h"
#include "volmesh/tetra/boundary_check.h"
#include "volmesh/tetra/preflight.h"

namespace {

using namespace sterna;
using Clock = std::chrono::steady_clock;

double best_of_three(const std::function<void()>& f) {
  double best = 1e300;
  for (int i = 0; i < 3; ++i) {
    const auto start = Clock::now();
    f();
    best = std::min(best, std::chrono::duration<double>(Clock::now() - start).count());
  }
  return best;
}

void run(const std::string& path, const std::vector<int>& thread_numbers) {
  const TriMesh wall = surfmesh::stitch_surface({io::read_surface_file(path, RunContext())}, {}, RunContext()).mesh;
  const std::vector<Vec3> points(wall.points.begin(), wall.points.end());
  std::vector<std::array<std::uint32_t, 3>> triangles;
  for (const TriangleVertices& t : wall.triangles) triangles.push_back({t[0].value(), t[1].value(), t[2].value()});
  const volmesh::TetraBoundary boundary{.points = points, .triangles = triangles, .hole_points = {}};
  for (const int threads : thread_numbers) {
    const RunContext context({.threads = threads});
    const auto row = [&](const char* name, const std::function<void()>& f) {
      const double seconds = best_of_three(f);
      std::printf("| %s | %zu | %d | %s | %.3f | %.0f |\n", path.substr(path.rfind('/') + 1).c_str(), triangles.size(), threads, name, seconds,
                  static_cast<double>(triangles.size()) / seconds / threads);
      std::fflush(stdout);
    };
    row("indices, edges, degenerate triangles", [&] { volmesh::check_boundary(boundary, context); });
    row("pre-flight", [&] { volmesh::preflight(boundary, {}, context); });
    row("pre-flight without crossings", [&] { volmesh::preflight(boundary, {.searches_crossings = false}, context); });
  }
}

}  // namespace

int main(int argc, char** argv) {
  std::vector<int> threads = {1, 2};
  std::vector<std::string> paths;
  for (int i = 1; i < argc; ++i) {
    const std::string argument = argv[i];
    if (argument == "--threads" && i + 1 < argc) {
      threads.clear();
      for (char* at = argv[++i]; *at != '\0'; at += *at == ',') threads.push_back(static_cast<int>(std::strtol(at, &at, 10)));
    } else {
      paths.push_back(argument);
    }
  }
  if (paths.empty()) {
    std::fprintf(stderr, "usage: preflight_bench [--threads 1,2] SURFACE...\n");
    return 2;
  }
  std::printf("| surface | triangles | threads | step | seconds | triangles/s/core |\n|---|---|---|---|---|---|\n");
  for (const std::string& path : paths) run(path, threads);
}
