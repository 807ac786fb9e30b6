// The surface mesher on whole models: CAD files, .smx and CPACS aircraft (united). One row each; processor time of the meshing alone.
// usage: surface_models [-max METRES] [-angle DEGREES] [-growth G] [-refine F] [-narrow N] [-threads N] [-parts] [-nocheck] [-out FOLDER] [-v] FILE ...
//   -parts: aircraft are not united; -nocheck: crossings are not looked for; -out: writes FOLDER/<stem>.vtu and .su2; -v: the worst faces too
#include <algorithm>
#include <chrono>
#include <cstdio>
#include <cstdlib>
#include <cstring>
#include <ctime>
#include <filesystem>
#include <numbers>
#include <string>

#include "geom/base/error.h"
#include "geom/cad/aircraft_union.h"
#include "geom/math/measures.h"
#include "geom/model/components.h"
#include "geom/model/cpacs.h"
#include "geom/model/smx.h"
#include "io/cad_file.h"
#include "io/surface_file.h"
#include "surfmesh/model/surface_mesh.h"

using namespace sterna;

namespace {

constexpr double k_deg = std::numbers::pi / 180.0;

struct Settings {
  surfmesh::SurfaceMeshOptions options;
  int threads = 0;
  bool has_parts = false, is_verbose = false;
  std::string folder;
};

Model read_model(const std::filesystem::path& path, const Settings& settings, const RunContext& context) {
  const std::string extension = path.extension().string();
  if (extension != ".smx" && extension != ".xml") return io::read_cad(path, {}, context).model;
  const Aircraft aircraft = extension == ".smx" ? read_smx(path, context).aircraft : read_cpacs(path, context).aircraft;
  if (settings.has_parts) return make_components(aircraft, context);
  return cad::unite_aircraft(aircraft, {}, context).model;
}

void print_row(const std::filesystem::path& path, const Settings& settings) {
  const RunContext context({.threads = settings.threads});
  const auto start = std::chrono::steady_clock::now();
  const auto seconds = [&] { return std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count(); };
  std::string name = path.filename().string();
  try {
    const Model model = read_model(path, settings, context);
    const double reading = seconds();
    if (settings.is_verbose) std::fprintf(stderr, "%s read, %zu faces\n", name.c_str(), model.faces.size());
    const bool is_closed = free_edges(model).empty();
    const std::clock_t clock = std::clock();
    try {
      const surfmesh::SurfaceMesh mesh = surfmesh::mesh_model(model, settings.options, {}, context);
      const double meshing = static_cast<double>(std::clock() - clock) / CLOCKS_PER_SEC;
      const surfmesh::SurfaceMeshReport& r = mesh.report;
      const auto n = static_cast<double>(mesh.mesh.n_triangles());
      std::string worst = "-";
      if (r.worst_face.is_valid()) worst = r.faces[r.worst_face.index()].name + " " + format_point(r.faces[r.worst_face.index()].worst_place);
      double normal_angle = 0.0;
      for (const auto& face : r.faces) normal_angle = std::max(normal_angle, face.max_normal_angle);
      std::printf("| %s | %zu | %s | %zu | %.2f | %.0f | %.2f | %.1f | %.3f | %.0f | %.1e | %lld | %zu | %d | %s | %.1f |\n", name.c_str(), model.faces.size(), is_closed ? "closed" : "open", mesh.mesh.n_triangles(), meshing,
                  n / meshing * 1e-3, r.min_angle / k_deg, r.angle_quantile_1 / k_deg, 100.0 * r.share_20_130, normal_angle / k_deg, r.max_edge_distance, static_cast<long long>(r.n_crossings), r.absorbed.size(), r.n_rounds, worst.c_str(), reading);
      if (settings.is_verbose) {
        std::vector<surfmesh::FaceMeshSummary> faces = r.faces;
        std::sort(faces.begin(), faces.end(), [](const auto& a, const auto& b) { return a.n_outside_20_130 > b.n_outside_20_130; });
        for (std::size_t i = 0; i < std::min<std::size_t>(8, faces.size()); ++i)
          std::printf("    face %u \"%s\" %s: %lld triangles, %lld outside, angles %.2f .. %.1f at %s, normals %.1f at %s\n", faces[i].face.value(), faces[i].name.c_str(), model.faces[faces[i].face].surface->kind().c_str(),
                      static_cast<long long>(faces[i].n_triangles), static_cast<long long>(faces[i].n_outside_20_130), faces[i].min_angle / k_deg, faces[i].max_angle / k_deg, format_point(faces[i].worst_place).c_str(),
                      faces[i].max_normal_angle / k_deg, format_point(faces[i].normal_place).c_str());
        for (const auto& a : r.absorbed) std::printf("    absorbed %s %g m at %s\n", a.what.c_str(), a.size, format_point(a.place).c_str());
        std::printf("    edge distance %g at %s\n", r.max_edge_distance, format_point(r.edge_distance_place).c_str());
      }
      if (!settings.folder.empty()) {
        const std::filesystem::path stem = std::filesystem::path(settings.folder) / path.stem();
        io::write_surface_file(mesh.mesh, stem.string() + ".vtu", context);
        io::write_surface_file(mesh.mesh, stem.string() + ".su2", context);
      }
    } catch (const Error& error) {
      std::printf("| %s | %zu | %s | MESHING: %s |\n", name.c_str(), model.faces.size(), is_closed ? "closed" : "open", error.what());
    }
  } catch (const Error& error) {
    std::printf("| %s | READING: %s |\n", name.c_str(), error.what());
  }
  std::fflush(stdout);
}

}  // namespace

int main(int argc, char** argv) {
  Settings settings;
  std::puts("| file | faces | model | triangles | cpu s | k/s | min angle | 1 % | in [20, 130] % | normals | edges to faces, m | crossings | absorbed | rounds | worst | read s |");
  std::puts("|---|---|---|---|---|---|---|---|---|---|---|---|---|---|---|---|");
  for (int i = 1; i < argc; ++i) {
    const auto number = [&] { return i + 1 < argc ? std::strtod(argv[++i], nullptr) : 0.0; };
    const auto is = [&](const char* option) { return std::strcmp(argv[i], option) == 0; };
    if (is("-max")) settings.options.max_edge = number();
    else if (is("-angle")) settings.options.curvature_angle = number() * k_deg;
    else if (is("-growth")) settings.options.growth = number();
    else if (is("-refine")) settings.options.refinement = number();
    else if (is("-narrow")) settings.options.narrow = number();
    else if (is("-threads")) settings.threads = static_cast<int>(number());
    else if (is("-limit")) settings.options.max_triangles = static_cast<int>(number());
    else if (is("-nocheck")) settings.options.check_crossings = false;
    else if (is("-parts")) settings.has_parts = true;
    else if (is("-v")) settings.is_verbose = true;
    else if (is("-out") && i + 1 < argc) settings.folder = argv[++i];
    else print_row(argv[i], settings);
  }
}
