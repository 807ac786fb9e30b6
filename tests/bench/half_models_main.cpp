// Compares half models with whole ones: cells, validity, symmetry plane, with layers as in docs/measurements/surfaces.md (25 layers, first height 1e-6 of the
// body length L, growth 1.3, farfield 20 L).
// usage: half_models [--threads 2] [--layers 25] [--write FOLDER] [--half-only] SURFACE...     surfaces are symmetric about y = 0
#include <chrono>
#include <cmath>
#include <cstdio>
#include <exception>
#include <filesystem>
#include <string>
#include <vector>

#include "geom/base/error.h"
#include "geom/mesh/half.h"
#include "io/file/surface_file.h"
#include "io/file/volume_file.h"
#include "surfmesh/stitch/stitch_surface.h"
#include "volmesh/volume_mesh.h"

namespace {

using namespace sterna;
using namespace sterna::volmesh;

struct Row {
  double cells = 0.0;
  bool is_valid = false;
};

Row row(const std::string& name, const TriMesh& wall, double length, int n_layers, const std::string& file, const RunContext& context) {
  MeshCase options;
  options.envelope.layers = n_layers;
  options.envelope.first_height = 1e-6 * length;
  options.envelope.max_growth = 1.3;
  options.envelope.max_thickness = 0.1 * length;
  options.farfield.farfield_radius = 20.0 * length;
  const auto start = std::chrono::steady_clock::now();
  try {
    const VolumeMeshResult result = volume_mesh(wall, options, context);
    const double seconds = std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
    double off = 0.0;
    const auto look = [&](const auto& faces) {
      for (const auto& face : faces)
        if (result.mesh.patches[face.patch].kind == PatchKind::symmetry)
          for (const NodeId node : face.nodes) off = std::max(off, std::abs(result.mesh.points[node].y));
    };
    look(result.mesh.boundary_triangles);
    look(result.mesh.boundary_quads);
    const CellCounts& cells = result.check.cells;
    std::printf("| %s | %zu | %lld | %lld | %zu | %.2f | %.3f | %.1e | %s |\n", name.c_str(), wall.n_triangles(),
                static_cast<long long>(cells.prisms + cells.pyramids), static_cast<long long>(cells.tetrahedra), result.mesh.boundary_quads.size(),
                100.0 * result.layer.coverage, seconds, off / length, result.check.is_valid() ? "VALID" : "INVALID");
    if (!file.empty()) io::write_volume_file(result.mesh, file, context);
    return {static_cast<double>(cells.total()), result.check.is_valid()};
  } catch (const Error& error) {
    std::printf("| %s | %zu | %s |\n", name.c_str(), wall.n_triangles(), error.what());
    return {};
  }
}

}  // namespace

int main(int argc, char** argv) {
  int threads = 2, n_layers = 25;
  std::string folder;
  bool is_half_only = false;
  std::vector<std::string> files;
  for (int i = 1; i < argc; ++i) {
    const std::string word = argv[i];
    if (word == "--half-only") is_half_only = true;
    else if (word == "--threads" && i + 1 < argc) threads = std::stoi(argv[++i]);
    else if (word == "--layers" && i + 1 < argc) n_layers = std::stoi(argv[++i]);
    else if (word == "--write" && i + 1 < argc) folder = argv[++i];
    else files.push_back(word);
  }
  const RunContext context({.threads = threads});
  std::printf(
      "| surface | triangles | prisms, pyramids | tetrahedra | side quads | coverage %% | s | largest |y| on the plane / L | "
      "|\n|---|---|---|---|---|---|---|---|---|\n");
  bool is_good = true;
  for (const std::string& file : files) {
    try {
      const std::string name = std::filesystem::path(file).stem().string();
      const SurfaceSoup soup = io::read_surface_file(file, context);
      const TriMesh full = surfmesh::stitch_surface({soup}, {}, context).mesh;
      const double length = body_length(full);
      const TriMesh half = half_of(full, {}, context);
      const Row of_half = row(name + ", half", half, length, n_layers, folder.empty() ? "" : folder + "/" + name + "_half.cgns", context);
      is_good = is_good && of_half.is_valid;
      if (is_half_only) continue;
      const Row of_full = row(name, full, length, n_layers, "", context);
      is_good = is_good && of_full.is_valid;
      if (of_full.cells > 0.0) std::printf("half over full: %.4f\n", of_half.cells / of_full.cells);
    } catch (const std::exception& error) {
      std::printf("| %s | %s |\n", file.c_str(), error.what());
      is_good = false;
    }
    std::fflush(stdout);
  }
  return is_good ? 0 : 1;
}
