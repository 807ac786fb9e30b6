// Speed of an inspection, and accuracy of its layer prediction. Times reading, joining and inspecting each surface; with --compare also the envelope of
// volume_mesh on the same wall.
// usage: inspect_bench [--threads 1,2] [--layers 35] [--compare] SURFACE...        the ladder of surfaces is made by tests/bench/make_ladder
// The first height is 1e-6 of the body length; the other options have their defaults. Times are wall-clock and CPU seconds (CPU equals wall-clock times threads
// on a quiet machine).
#include <chrono>
#include <cstdio>
#include <cstdlib>
#include <ctime>
#include <functional>
#include <string>
#include <vector>

#include "io/file/surface_file.h"
#include "surfmesh/stitch/stitch_surface.h"
#include "volmesh/inspect/inspect.h"
#include "volmesh/layer_domain/layer_domain.h"
#include "volmesh/stages.h"

namespace {

using namespace sterna;
using namespace sterna::volmesh;
using Clock = std::chrono::steady_clock;

struct Seconds {
  double wall = 0.0, processor = 0.0;
};

Seconds timed(const std::function<void()>& f) {
  const Clock::time_point start = Clock::now();
  const std::clock_t processor = std::clock();
  f();
  return {std::chrono::duration<double>(Clock::now() - start).count(), static_cast<double>(std::clock() - processor) / CLOCKS_PER_SEC};
}

/// Area shares of the finished envelope, counted as in the report of a mesh.
void print_envelope(const TriMesh& wall, const MeshCase& options, const InspectReport& report, const std::string& name, const RunContext& context) {
  const LayerDomain layer_domain(wall, options, context);
  EnvelopeStage stage;
  const Seconds seconds = timed([&] { stage = make_envelope(wall, options, {}, context); });
  const EnvelopeScale scale = scale_of(layer_domain.base, layer_domain.options.envelope);
  double all = 0.0, full = 0.0, compressed = 0.0, collapsed = 0.0;
  for (const VertexId v : layer_domain.base.wall.points.ids()) {
    const double a = layer_domain.base.vertex_area[v], h = stage.envelope.height[v];
    all += a;
    if (h >= 0.9 * stage.envelope.target[v]) full += a;
    if (h == 0.0) collapsed += a;
    else if (h < scale.compressed(v)) compressed += a;
  }
  std::printf("| %s | %zu | %.2f | %.2f | %.3f | %.3f | %.3f | %.3f | %.1f |\n", name.c_str(), wall.n_triangles(), 100.0 * report.layer.coverage,
              100.0 * full / all, 100.0 * report.layer.compressed, 100.0 * compressed / all, 100.0 * report.layer.collapsed, 100.0 * collapsed / all,
              seconds.wall);
}

void run(const std::string& path, int threads, int layers, bool is_compared) {
  const RunContext context({.threads = threads});
  SurfaceSoup soup;
  TriMesh wall;
  InspectReport report;
  const std::string name = path.substr(path.rfind('/') + 1);
  const Seconds reading = timed([&] { soup = io::read_surface_file(path, context); });
  const Seconds joining = timed([&] { wall = surfmesh::stitch_surface({soup}, {.allow_open = true, .check_intersections = false}, context).mesh; });
  InspectRequest request;
  request.volume.envelope.layers = layers;
  request.volume.envelope.first_height = 1e-6 * body_length(wall);
  const Seconds inspecting = timed([&] { report = inspect_wall(wall, request, context); });
  const double millions = 1e-6 * static_cast<double>(wall.n_triangles());
  if (is_compared) {
    if (report.layer.is_known) print_envelope(wall, request.volume, report, name, context);
  } else {
    std::printf("| %s | %zu | %d | %.2f | %.2f | %.2f | %.2f | %.2f |\n", name.c_str(), wall.n_triangles(), threads, reading.wall, joining.wall,
                inspecting.wall, (reading.wall + joining.wall + inspecting.wall) / millions,
                (reading.processor + joining.processor + inspecting.processor) / millions);
  }
  std::fflush(stdout);
}

}  // namespace

int main(int argc, char** argv) {
  std::vector<int> threads = {1, 2};
  std::vector<std::string> paths;
  int layers = 35;
  bool is_compared = false;
  for (int i = 1; i < argc; ++i) {
    const std::string argument = argv[i];
    if (argument == "--threads" && i + 1 < argc) {
      threads.clear();
      for (char* at = argv[++i]; *at != '\0'; at += *at == ',') threads.push_back(static_cast<int>(std::strtol(at, &at, 10)));
    } else if (argument == "--layers" && i + 1 < argc) {
      layers = std::atoi(argv[++i]);
    } else if (argument == "--compare") {
      is_compared = true;
    } else {
      paths.push_back(argument);
    }
  }
  if (paths.empty()) {
    std::fprintf(stderr, "usage: inspect_bench [--threads 1,2] [--layers 35] [--compare] SURFACE...\n");
    return 2;
  }
  if (is_compared) {
    threads = {threads.back()};
    std::printf(
        "| surface | triangles | full %%: predicted | envelope | compressed %%: predicted | envelope | collapsed %%: predicted | envelope | envelope s "
        "|\n|---|---|---|---|---|---|---|---|---|\n");
  } else {
    std::printf(
        "| surface | triangles | threads | read s | join s | inspect s | s per million | processor s per million |\n|---|---|---|---|---|---|---|---|\n");
  }
  for (const std::string& path : paths)
    for (const int n : threads) run(path, n, layers, is_compared);
}
