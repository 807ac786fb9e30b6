// Results of the tet engines on real surfaces, with the settings of docs/measurements/surfaces.md: 35 layers, first height 1e-6 of the body length L, growth
// at most 1.4, thickness at most 0.1 L, wall perpendicularity 0.1, farfield 20 L.
// usage: tetra_bench [--threads 2] [--engines hxt,tetgen] [--layers 35] SURFACE...        join parts of one body with +: wing.stl+flap.stl
// Prints one table row for each surface and engine. "ours" is the time of the stage without the engine's own run: boundary, size field, transfer, process,
// verification. Each run verifies that the boundary is returned to the bit (verify.h); a row that failed states the reason.
#include <algorithm>
#include <array>
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <exception>
#include <numbers>
#include <string>
#include <vector>

#include "geom/base/error.h"
#include "geom/math/measures.h"
#include "io/file/surface_file.h"
#include "surfmesh/stitch/stitch_surface.h"
#include "volmesh/volume_mesh.h"

namespace {

using namespace sterna;
using namespace sterna::volmesh;

constexpr double k_degrees = 180.0 / std::numbers::pi;
constexpr double k_bytes_per_mb = 1e6;

struct Settings {
  int threads = 2;
  int n_layers = 35;
  std::vector<std::string> engines = {"hxt", "tetgen"};
  std::vector<std::string> surfaces;
};

std::vector<std::string> split(const std::string& text, char separator) {
  std::vector<std::string> parts(1);
  for (const char c : text) {
    if (c == separator) parts.emplace_back();
    else parts.back() += c;
  }
  return parts;
}

TriMesh read(const std::string& paths, const RunContext& context) {
  std::vector<SurfaceSoup> soups;
  for (const std::string& path : split(paths, '+')) soups.push_back(io::read_surface_file(path, context));
  return surfmesh::stitch_surface(soups, {}, context).mesh;
}

double circumradius(const std::array<Vec3, 4>& p) {
  const Vec3 u = p[1] - p[0], v = p[2] - p[0], w = p[3] - p[0];
  return norm(norm2(u) * cross(v, w) + norm2(v) * cross(w, u) + norm2(w) * cross(u, v)) / (2.0 * std::abs(dot(u, cross(v, w))));
}

/// Quality of all tets of a mesh.
struct TetFigures {
  std::vector<double> angle;        ///< smallest dihedral, degrees, ascending
  std::vector<double> radius_edge;  ///< ascending
};

TetFigures figures_of(const HybridMesh& mesh) {
  TetFigures figures;
  for (const auto& nodes : mesh.tetrahedra) {
    std::array<Vec3, 4> p;
    for (std::size_t k = 0; k < 4; ++k) p[k] = mesh.points[nodes[k]];
    double shortest = distance(p[0], p[1]);
    for (const auto& [i, j] : {std::pair{0, 2}, {0, 3}, {1, 2}, {1, 3}, {2, 3}})
      shortest = std::min(shortest, distance(p[static_cast<std::size_t>(i)], p[static_cast<std::size_t>(j)]));
    figures.angle.push_back(k_degrees * tet_dihedral_range(p)[0]);
    figures.radius_edge.push_back(circumradius(p) / shortest);
  }
  std::ranges::sort(figures.angle);
  std::ranges::sort(figures.radius_edge);
  return figures;
}

double quantile(const std::vector<double>& sorted, double share) { return sorted[static_cast<std::size_t>(share * static_cast<double>(sorted.size() - 1))]; }

double seconds_of(const RunContext& context, const std::string& stage) {
  for (const StageTime& time : context.times())
    if (time.stage == stage) return time.seconds;
  return 0.0;
}

void print_row(const std::string& name, const std::string& engine, const Settings& settings) {
  const RunContext context({.threads = settings.threads});
  try {
    const TriMesh wall = read(name, context);
    const double length = body_length(wall);
    MeshCase options;
    options.envelope.layers = settings.n_layers;
    options.envelope.first_height = 1e-6 * length;
    options.envelope.max_growth = 1.4;
    options.envelope.max_thickness = 0.1 * length;
    options.envelope.feature_angle = 35.0 / k_degrees;
    options.prisms.wall_perpendicularity = 0.1;
    options.farfield.farfield_radius = 20.0 * length;
    options.tetrahedra.engine = engine;
    options.tetrahedra.try_other_engine = false;
    const VolumeMeshResult result = volume_mesh(wall, options, context);
    const TetFigures figures = figures_of(result.mesh);
    const auto n = static_cast<double>(result.mesh.tetrahedra.size());
    const double inside = result.tetra_engine_seconds, around = seconds_of(context, "tetrahedra") - inside;
    const GateResult& growth = result.check.gate(Measure::tet_growth);
    std::printf(
        "| %s | %zu | %s | %.0f | %.0f | %.2f | %.2f | %.0f | %.2f | %.0f | %lld | %lld | %lld | %.2f | %.2f | %.1f | %.1f | %.2f | %.2f | %.1f | %.3f |\n",
        name.substr(name.rfind('/') + 1).c_str(), wall.n_triangles(), result.tetra_engine.c_str(), n, n / inside / 1000.0, inside, around,
        100.0 * around / inside, seconds_of(context, "improve"), result.tetra_engine_peak_bytes / k_bytes_per_mb,
        static_cast<long long>(result.improvement.n_bad_before), static_cast<long long>(result.improvement.n_bad_after),
        static_cast<long long>(result.improvement.n_bad_free_after), k_degrees * result.improvement.min_angle_before, figures.angle.front(),
        quantile(figures.angle, 0.01), quantile(figures.angle, 0.5), quantile(figures.radius_edge, 0.5), quantile(figures.radius_edge, 0.99), growth.worst,
        100.0 * growth.share_within);
  } catch (const Error& error) {
    std::printf("| %s | | %s | %s: %s |\n", name.substr(name.rfind('/') + 1).c_str(), engine.c_str(), error.info().attempted.c_str(),
                error.info().problem.c_str());
  }
  std::fflush(stdout);
}

}  // namespace

int main(int argc, char** argv) {
  Settings settings;
  for (int i = 1; i < argc; ++i) {
    const std::string argument = argv[i];
    if (argument == "--threads" && i + 1 < argc) settings.threads = std::atoi(argv[++i]);
    else if (argument == "--layers" && i + 1 < argc) settings.n_layers = std::atoi(argv[++i]);
    else if (argument == "--engines" && i + 1 < argc) settings.engines = split(argv[++i], ',');
    else settings.surfaces.push_back(argument);
  }
  if (settings.surfaces.empty()) {
    std::fputs("usage: tetra_bench [--threads 2] [--engines hxt,tetgen] [--layers 35] SURFACE...\n", stderr);
    return 2;
  }
  std::puts(
      "| surface | triangles | engine | tets | k tets/s | engine s | ours s | ours % | improve s | engine MB | bad before | bad after | away from boundary | "
      "min deg before | min deg | 1 % deg | "
      "median deg | median R/l | 99 % R/l | worst growth | growth <= 4 % "
      "|\n|---|---|---|---|---|---|---|---|---|---|---|---|---|---|---|---|---|---|---|---|---|");
  for (const std::string& surface : settings.surfaces)
    for (const std::string& engine : settings.engines) print_row(surface, engine, settings);
  return 0;
}
