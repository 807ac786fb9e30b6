// Speed of `check`: columns on an icosahedral sphere with tets above them, generated in memory so that nothing else is measured. Times the whole of `check`,
// then each step with a public function.
// usage: check_bench [triangles along an icosahedron's edge = 100] [layers = 45] [threads = 2]     245 45 gives 1.2 M triangles, 54 M prisms, 7.2 M tets
#include <sys/resource.h>

#include <chrono>
#include <cstdio>
#include <cstdlib>
#include <functional>

#include "geom/mesh/check.h"
#include "geom/mesh/dual_metrics.h"
#include "tests/support/hybrid_shapes.h"

namespace {

using Clock = std::chrono::steady_clock;

double peak_megabytes() {
  rusage usage{};
  getrusage(RUSAGE_SELF, &usage);
  return static_cast<double>(usage.ru_maxrss) / 1024.0;
}

/// CPU time of all threads; unlike the wall clock it is meaningful on a machine shared with other processes.
double cpu_seconds() {
  rusage usage{};
  getrusage(RUSAGE_SELF, &usage);
  const auto seconds = [](const timeval& t) { return static_cast<double>(t.tv_sec) + 1e-6 * static_cast<double>(t.tv_usec); };
  return seconds(usage.ru_utime) + seconds(usage.ru_stime);
}

void timed(const char* name, std::int64_t n_cells, const std::function<void()>& f) {
  const Clock::time_point start = Clock::now();
  const double cpu_start = cpu_seconds();
  f();
  const double seconds = std::chrono::duration<double>(Clock::now() - start).count();
  std::printf("%-24s %8.2f s  %7.2f M cells/s   cpu %8.2f s   peak %.0f MB\n", name, seconds, 1e-6 * static_cast<double>(n_cells) / seconds,
              cpu_seconds() - cpu_start, peak_megabytes());
  std::fflush(stdout);
}

}  // namespace

int main(int argc, char** argv) {
  const int f = argc > 1 ? std::atoi(argv[1]) : 100;
  const int n_layers = argc > 2 ? std::atoi(argv[2]) : 45;
  const int threads = argc > 3 ? std::atoi(argv[3]) : 2;
  using namespace sterna;
  HybridMesh mesh;
  timed("making the mesh", 0, [&] { mesh = test::sphere_shell(f, {.n_layers = n_layers, .layer_height = 0.05, .ratio = 1.2}); });
  const std::int64_t n = count_cells(mesh).total();
  std::printf("%lld cells, %zu nodes, %d threads\n", static_cast<long long>(n), mesh.points.size(), threads);
  const RunContext context({.threads = threads});
  CheckReport report;
  timed("check, everything", n, [&] { report = check(mesh, {}, context); });
  timed("check again", n, [&] { report = check(mesh, {}, context); });
  for (const StageTime& stage : context.times()) std::printf("    %-32s %8.2f s in both\n", stage.stage.c_str(), stage.seconds);
  timed("dual mesh alone", n, [&] { scan_dual(mesh, {}, context); });
  std::printf("%s\n", report.is_valid() ? "VALID" : "INVALID");
  return report.is_valid() ? 0 : 1;
}
