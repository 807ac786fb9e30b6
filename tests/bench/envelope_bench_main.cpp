// Speed of each layer stage on real surfaces with the settings of docs/measurements/surfaces.md: 35 layers, first height 1e-6 of the body length L,
// feature angle 35 degrees, growth at most 1.4, thickness at most 0.1 L, wall perpendicularity 0.1.
// usage: envelope_bench [--threads 1,2] [--layers 35] [--nlopt 0] SURFACE...        the ladder of surfaces is made by tests/bench/make_ladder
// --nlopt N: also times N evaluations of NLopt's CCSAQ and MMA and of our descent from the envelope before stage 6 (compare_optimisers compares results).
// One table row for each surface, thread number and stage: wall-clock seconds, CPU seconds (equal to wall-clock times threads on a quiet machine), elements per
// second and core, peak resident memory during the stage.
#include <algorithm>
#include <chrono>
#include <cstdio>
#include <cstdlib>
#include <ctime>
#include <fstream>
#include <functional>
#include <numbers>
#include <optional>
#include <string>
#include <vector>

#include "geom/mesh/find_crossings.h"
#include "io/file/surface_file.h"
#include "surfmesh/stitch/stitch_surface.h"
#include "tests/support/envelope_surface.h"
#include "volmesh/envelope/build_envelope.h"
#include "volmesh/envelope/certificate.h"
#include "volmesh/envelope/nlopt_optimise.h"
#include "volmesh/envelope/optimise.h"
#include "volmesh/envelope/retract.h"
#include "volmesh/layer/extrude.h"
#include "volmesh/layer/first_node.h"
#include "volmesh/layer/layer_cells.h"

namespace {

using namespace sterna;
using namespace sterna::volmesh;
using Clock = std::chrono::steady_clock;

constexpr double k_bytes_per_mb = 1e6;

/// Resets the peak resident memory: Linux does so when 5 is written to clear_refs.
void reset_peak() { std::ofstream("/proc/self/clear_refs") << 5; }

double status_megabytes(const std::string& key) {
  std::ifstream status("/proc/self/status");
  for (std::string line; std::getline(status, line);)
    if (line.starts_with(key)) return std::strtod(line.c_str() + key.size() + 1, nullptr) * 1024.0 / k_bytes_per_mb;
  return 0.0;
}

struct Row {
  std::string surface;
  int threads;
  double peak = 0.0;  ///< MB, over all stages of this surface so far

  void timed(const char* stage, double n_elements, const char* element, const std::function<void()>& f) {
    reset_peak();
    const Clock::time_point start = Clock::now();
    const std::clock_t cpu_start = std::clock();
    f();
    const double cpu = static_cast<double>(std::clock() - cpu_start) / CLOCKS_PER_SEC;
    const double seconds = std::chrono::duration<double>(Clock::now() - start).count();
    const double here = status_megabytes("VmHWM:");
    peak = std::max(peak, here);
    std::printf("| %s | %d | %s | %.3f | %.3f | %.0f | %s/s/core | %.0f |\n", surface.c_str(), threads, stage, seconds, cpu, n_elements / seconds / threads,
                element, here);
    std::fflush(stdout);
  }
};

TriMesh read(const std::string& path, const RunContext& context) { return surfmesh::stitch_surface({io::read_surface_file(path, context)}, {}, context).mesh; }

/// Times every optimiser of stage 6, all from the same start.
void time_optimisers(Row& row, const LayerBase& base, EnvelopeOptions options, int n_evaluations, const RunContext& context) {
  options.optimiser = "none";
  const Envelope start = build_envelope(base, options, context);
  const Column<VertexId, double> h_u = upper_heights(base, start);
  const double h_l = scale_of(base, options).least_height();
  const double n = static_cast<double>(base.wall.n_vertices()) * n_evaluations;
  for (const NloptMethod method : {NloptMethod::ccsaq, NloptMethod::mma}) {
    NloptReport report;
    row.timed(method == NloptMethod::mma ? "MMA" : "CCSAQ", n, "vertex evaluations",
              [&] { nlopt_optimise(base, start, h_u, h_l, {.method = method, .max_evaluations = n_evaluations}, report, context); });
  }
  OptimiseReport report;
  row.timed("our descent", n, "vertex evaluations",
            [&] { optimise(base, start, h_u, h_l, {.max_evaluations = n_evaluations, .tolerance = 0.0}, report, context); });
}

struct Settings {
  std::vector<int> threads = {1, 2};
  int n_layers = 35;
  int n_nlopt = 0;
  std::vector<std::string> surfaces;
};

void run(const std::string& path, const TriMesh& wall, int threads, const Settings& settings) {
  const int n_layers = settings.n_layers;
  const RunContext context({.threads = threads, .log = [](LogLevel level, std::string_view text) {
                              if (level != LogLevel::debug || std::getenv("STERNA_BENCH_VERBOSE"))
                                std::fprintf(stderr, "%.*s\n", static_cast<int>(text.size()), text.data());
                            }});
  Row row{path.substr(path.rfind('/') + 1), threads};
  const double n = static_cast<double>(wall.n_triangles());
  const double n_prisms = n * n_layers;
  const double length = body_length(wall);
  EnvelopeOptions options;
  options.layers = n_layers;
  options.first_height = 1e-6 * length;
  options.max_thickness = 0.1 * length;
  options.feature_angle = 35.0 * std::numbers::pi / 180.0;
  const PrismOptions prisms{.wall_perpendicularity = 0.1};

  std::optional<LayerBase> base;
  Envelope envelope;
  Extrusion extrusion;
  LayerCertificate certificate;
  CrossingPairs crossings;
  std::printf("| %s | %d | triangles | | | %.0f | wall | %.0f |\n", row.surface.c_str(), threads, n, status_megabytes("VmRSS:"));
  row.timed("topology", n, "triangles", [&] { base.emplace(wall, context); });
  std::optional<Collider> collider;
  EnvelopeCertificate proof;
  row.timed("input tested for crossings", n, "triangles", [&] {
    collider.emplace(*base, nullptr, context);
    require_clear_input(*collider, context);
  });
  row.timed("envelope", n, "triangles", [&] { envelope = build_envelope(*base, options, *collider, context); });
  row.timed("certificate of the envelope", n, "triangles", [&] { proof = certify_envelope(*base, *collider, envelope, context); });
  collider.reset();
  const test::EnvelopeSurface surface = test::envelope_surface(*base, envelope, context);
  if (settings.n_nlopt > 0) time_optimisers(row, *base, options, settings.n_nlopt, context);
  row.timed("one exact self-intersection pass", n, "triangles", [&] { crossings = find_crossings(surface.points, surface.triangles, context); });
  row.timed("extrusion", n_prisms, "prisms", [&] { extrusion = extrude_prisms(*base, options, prisms, envelope, context); });
  row.timed("certificate of the prisms", n_prisms, "prisms", [&] { certificate = certify_layer(extrusion.layers, extrusion.points, context); });
  const FirstNodeReport first = first_node_report(*base, classify_vertices(*base, options, context), options, envelope, extrusion, context);
  std::printf("| %s | %d | all stages | | | | | %.0f |\n", row.surface.c_str(), threads, row.peak);
  std::printf("\n%s: %s\n", row.surface.c_str(), to_text(proof).c_str());
  const auto& c = extrusion.curving_shares;
  std::printf("%s: %lld crossing pairs; %lld of %lld cells proved, worst quality %.3g at (%.6g, %.6g, %.6g), layer %d\n", row.surface.c_str(),
              static_cast<long long>(crossings.total), static_cast<long long>(certificate.n_proved), static_cast<long long>(certificate.n_cells),
              certificate.min_quality, certificate.worst_location.x, certificate.worst_location.y, certificate.worst_location.z, certificate.worst_layer);
  std::printf("  c_t reduced on %lld of %zu lines: %lld straight, %lld up to 1/4, %lld to 1/2, %lld to 3/4, %lld below 1\n",
              static_cast<long long>(extrusion.n_straightened), extrusion.layers.n_lines(), static_cast<long long>(c[0]), static_cast<long long>(c[1]),
              static_cast<long long>(c[2]), static_cast<long long>(c[3]), static_cast<long long>(c[4]));
  std::printf(
      "  first node within 2 %%: %.3f %% of full lines (worst %.3g), %.3f %% of the smooth facets' area (mean of three %.3f %%, worst %.3g); %.2f %% of the "
      "area at ridges, "
      "%lld compressed, %lld collapsed\n\n",
      100.0 * first.vertex_share, first.worst_vertex, 100.0 * first.facet_share, 100.0 * first.facet_mean_share, first.worst_facet, 100.0 * first.ridge_area,
      static_cast<long long>(first.n_compressed), static_cast<long long>(first.n_collapsed));
}

}  // namespace

int main(int argc, char** argv) {
  Settings settings;
  for (int i = 1; i < argc; ++i) {
    const std::string argument = argv[i];
    if (argument == "--threads" && i + 1 < argc) {
      settings.threads.clear();
      for (char* at = argv[++i]; *at != '\0'; at += *at == ',') settings.threads.push_back(static_cast<int>(std::strtol(at, &at, 10)));
    } else if (argument == "--layers" && i + 1 < argc) {
      settings.n_layers = std::atoi(argv[++i]);
    } else if (argument == "--nlopt" && i + 1 < argc) {
      settings.n_nlopt = std::atoi(argv[++i]);
    } else {
      settings.surfaces.push_back(argument);
    }
  }
  if (settings.surfaces.empty()) {
    std::fprintf(stderr, "usage: envelope_bench [--threads 1,2] [--layers 35] [--nlopt 0] SURFACE...\n");
    return 2;
  }
  std::printf("| surface | threads | stage | seconds | processor | rate | per | peak MB |\n|---|---|---|---|---|---|---|---|\n");
  for (const std::string& path : settings.surfaces) {
    const TriMesh wall = read(path, RunContext());
    for (const int n : settings.threads) run(path, wall, n, settings);
  }
  return 0;
}
