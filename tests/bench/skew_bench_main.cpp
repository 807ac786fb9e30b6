// Skew (13), coverage, heights and minima of the certificate of the extruded layer, with and without the optimiser. Settings: docs/measurements/surfaces.md.
// usage: skew_bench surface...        Markdown table on standard output; histograms of 45 bins of 2 degrees as lines "histogram NAME none|descent counts..."
// (tests/tools/draw_skew.py draws them). Join several parts of one body with +: PART+PART+...
#include <algorithm>
#include <array>
#include <chrono>
#include <cstdio>
#include <ctime>
#include <filesystem>
#include <numbers>
#include <string>
#include <vector>

#include "geom/base/parallel.h"
#include "geom/mesh/quality.h"
#include "io/file/surface_file.h"
#include "surfmesh/stitch/stitch_surface.h"
#include "volmesh/envelope/build_envelope.h"
#include "volmesh/layer/extrude.h"
#include "volmesh/layer/layer_cells.h"
#include "volmesh/layer/layer_report.h"

namespace {

using namespace sterna;
using namespace sterna::volmesh;

constexpr double k_degrees = 180.0 / std::numbers::pi;
constexpr std::size_t k_bins = 45;  ///< bins of 2 degrees; the last one also counts the cells beside compressed and collapsed vertices

/// Histogram of the skew of the prisms; below() returns a share in per cent.
struct Skew {
  std::array<std::int64_t, k_bins> bins{};
  std::int64_t n = 0;
  double below(double degrees) const {
    std::int64_t sum = 0;
    for (std::size_t i = 0; i < static_cast<std::size_t>(degrees / 2.0); ++i) sum += bins[i];
    return 100.0 * static_cast<double>(sum) / static_cast<double>(n);
  }
};

Skew measure_skew(const EnvelopeOptions& options, const Envelope& envelope, const Extrusion& x, const RunContext& context) {
  const LayerBlock& layers = x.layers;
  const double compressed_below = options.layers * options.first_height;
  return parallel_reduce(
      context, layers.n_columns(), Skew{},
      [&](std::size_t begin, std::size_t end) {
        Skew part;
        for (std::size_t c = begin; c < end; ++c) {
          const auto& lines = layers.base[c];
          const bool is_short = std::any_of(lines.begin(), lines.end(), [&](std::uint32_t line) { return envelope.height[VertexId(line)] < compressed_below; });
          for (int j = 0; j < layers.n_layers; ++j, ++part.n) {
            if (is_short) {
              ++part.bins[k_bins - 1];
              continue;
            }
            WedgePoints p;
            for (std::size_t k = 0; k < 3; ++k) {
              p[k] = x.points[layers.node(lines[k], j).index()];
              p[k + 3] = x.points[layers.node(lines[k], j + 1).index()];
            }
            ++part.bins[std::min(static_cast<std::size_t>(skew_angle(p) * k_degrees / 2.0), k_bins - 1)];
          }
        }
        return part;
      },
      [](Skew a, const Skew& b) {
        for (std::size_t i = 0; i < k_bins; ++i) a.bins[i] += b.bins[i];
        a.n += b.n;
        return a;
      });
}

/// Share of wall triangles whose mean corner angle between angle-weighted vertex normal and facet normal is below `degrees`.
double ceiling(const LayerBase& base, double degrees) {
  double n = 0.0;
  for (const TriangleId t : base.wall.triangles.ids()) {
    double mean = 0.0;
    for (const VertexId v : base.wall.triangles[t]) mean += angle_between(base.vertex_normal[v], base.unit_normal[t]) * k_degrees / 3.0;
    n += mean < degrees ? 1.0 : 0.0;
  }
  return 100.0 * n / static_cast<double>(base.wall.n_triangles());
}

void run(const std::string& argument, const RunContext& context) {
  std::vector<SurfaceSoup> parts;
  for (std::size_t from = 0; from <= argument.size();) {
    const std::size_t to = std::min(argument.find('+', from), argument.size());
    parts.push_back(io::read_surface_file(argument.substr(from, to - from), context));
    from = to + 1;
  }
  const std::string name = std::filesystem::path(argument.substr(0, argument.find('+'))).filename().string();
  const TriMesh wall = surfmesh::stitch_surface(parts, {}, context).mesh;
  const LayerBase base(wall, context);
  EnvelopeOptions options;
  options.layers = 35;
  options.first_height = 1e-6 * base.body_length;
  options.max_growth = 1.4;
  options.max_thickness = 0.1 * base.body_length;
  options.feature_angle = 35.0 / k_degrees;
  for (const char* optimiser : {"none", "descent"}) {
    options.optimiser = optimiser;
    const std::clock_t clock = std::clock();
    const auto start = std::chrono::steady_clock::now();
    Envelope envelope = build_envelope(base, options, context);
    const double seconds = std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
    const double processor = static_cast<double>(std::clock() - clock) / CLOCKS_PER_SEC;
    const Extrusion x = extrude_prisms(base, options, {.wall_perpendicularity = 0.1}, envelope, context);
    const Skew skew = measure_skew(options, envelope, x, nullptr, context);
    const LayerReport report = report_layer(base, options, envelope, x, nullptr, context);
    const LayerCertificate certificate = certify_layer(x.layers, x.points, context);
    std::printf("| %s | %zu | %s | %.1f | %.1f | %.2f | %.1f | %.1f | %.2f | %.2f | %.3f | %.2g | %.2f | %.2f |\n", name.c_str(), wall.n_triangles(), optimiser,
                skew.below(6.0), skew.below(18.0), 100.0 - skew.below(60.0), ceiling(base, 6.0), ceiling(base, 18.0), 100.0 * report.mean_height_share,
                100.0 * report.coverage, report.target_over_eq1, certificate.min_quality, seconds, processor);
    std::fprintf(stderr, "histogram %s %s", name.c_str(), optimiser);
    for (const std::int64_t count : skew.bins) std::fprintf(stderr, " %.4f", 100.0 * static_cast<double>(count) / static_cast<double>(skew.n));
    std::fprintf(stderr, "\n");
    std::fflush(stdout);
  }
}

}  // namespace

int main(int argc, char** argv) {
  const RunContext context({.threads = 2});
  std::puts(
      "| surface | triangles | optimiser | < 6 deg % | < 18 deg % | > 60 deg % | ceiling 6 | ceiling 18 | mean h / h_target % | coverage % | h_target / eq. "
      "(1) | least scaled Jacobian | envelope s | processor s |");
  std::puts("|---|---|---|---|---|---|---|---|---|---|---|---|---|---|");
  for (int i = 1; i < argc; ++i) run(argv[i], context);
}
