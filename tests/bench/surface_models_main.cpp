// The surface mesher on whole models: CAD files, .smx and CPACS aircraft (united). One table row each; CPU time of the meshing alone.
// usage: surface_models [-max METRES] [-angle DEGREES] [-growth G] [-refine F] [-narrow N] [-gaps CELLS] [-thickness FACTOR] [-intersection FACTOR] [-wing
// FACTOR] [-nostrips] [-threads N] [-parts] [-nocheck] [-strict] [-out FOLDER] [-raw FOLDER] [-distance MESH] [-v] FILE ...
//   -parts: aircraft are not united; -nocheck: no search for crossings; -strict: crossings are errors (default: counted);
//   -out: writes FOLDER/<stem>.vtu and .su2; -v: also lists the worst faces
//   -raw: writes FOLDER/<stem>.tri, the input of tools/compare_gmsh: int64 points, int64 triangles, points as 3 doubles, triangles as 3 int32
//   -distance: distance of the triangles of such meshes (given before FILE) from FILE's faces; FILE is then not meshed
#include <algorithm>
#include <array>
#include <chrono>
#include <cstdint>
#include <cstdio>
#include <cstdlib>
#include <cstring>
#include <ctime>
#include <filesystem>
#include <fstream>
#include <numbers>
#include <string>
#include <utility>
#include <vector>

#include "geom/base/error.h"
#include "geom/base/parallel.h"
#include "geom/cad/aircraft_union.h"
#include "geom/math/measures.h"
#include "geom/model/components.h"
#include "geom/model/cpacs.h"
#include "geom/model/projection.h"
#include "geom/model/smx.h"
#include "io/file/cad_file.h"
#include "io/file/surface_file.h"
#include "surfmesh/model/surface_mesh.h"
#include "tests/support/triangle_quality.h"

using namespace sterna;

namespace {

constexpr double k_deg = std::numbers::pi / 180.0;

struct Settings {
  surfmesh::SurfaceMeshOptions options;
  int threads = 0;
  bool has_parts = false, is_verbose = false;
  std::string folder, raw_folder;
  std::vector<std::string> measured;
};

Model read_model(const std::filesystem::path& path, const Settings& settings, const RunContext& context) {
  const std::string extension = path.extension().string();
  if (extension != ".smx" && extension != ".xml") return io::read_cad(path, {}, context).model;
  const Aircraft aircraft = extension == ".smx" ? read_smx(path, context).aircraft : read_cpacs(path, context).aircraft;
  if (settings.has_parts) return make_components(aircraft, context);
  return cad::unite_aircraft(aircraft, {}, context).model;
}

void write_raw(const TriMesh& mesh, const std::filesystem::path& path) {
  std::ofstream out(path, std::ios::binary);
  const std::int64_t sizes[2] = {static_cast<std::int64_t>(mesh.n_vertices()), static_cast<std::int64_t>(mesh.n_triangles())};
  out.write(reinterpret_cast<const char*>(sizes), sizeof sizes);
  for (const Point& p : mesh.points) {
    const double xyz[3] = {p.x, p.y, p.z};
    out.write(reinterpret_cast<const char*>(xyz), sizeof xyz);
  }
  for (const TriangleVertices& t : mesh.triangles) {
    const std::int32_t corners[3] = {static_cast<std::int32_t>(t[0].value()), static_cast<std::int32_t>(t[1].value()), static_cast<std::int32_t>(t[2].value())};
    out.write(reinterpret_cast<const char*>(corners), sizeof corners);
  }
  out.close();
  if (!out) throw Error({.code = ErrorCode::write_failed, .attempted = "to write a mesh", .problem = "cannot write " + path.string()});
}

struct RawMesh {
  std::vector<std::array<double, 3>> points;
  std::vector<std::array<std::int32_t, 3>> triangles;
};

RawMesh read_raw(const std::filesystem::path& path) {
  std::ifstream in(path, std::ios::binary);
  std::int64_t sizes[2] = {};
  RawMesh mesh;
  in.read(reinterpret_cast<char*>(sizes), sizeof sizes);
  if (in) {
    mesh.points.resize(static_cast<std::size_t>(sizes[0]));
    mesh.triangles.resize(static_cast<std::size_t>(sizes[1]));
    in.read(reinterpret_cast<char*>(mesh.points.data()), static_cast<std::streamsize>(mesh.points.size() * sizeof mesh.points[0]));
    in.read(reinterpret_cast<char*>(mesh.triangles.data()), static_cast<std::streamsize>(mesh.triangles.size() * sizeof mesh.triangles[0]));
  }
  if (!in) throw Error({.code = ErrorCode::file_malformed, .attempted = "to read a mesh", .problem = path.string() + " is shorter than its sizes say"});
  return mesh;
}

/// A face as a projection target: its untrimmed surface over the (u, v) box of its borders.
struct FaceTarget {
  SurfaceProjector projector;
  Box box;
};

FaceTarget make_target(const Model& model, const ModelFace& face) {
  constexpr int k_border_samples = 64, k_box_samples = 24;
  constexpr double k_box_margin = 0.05;  // of the samples' longest side, for the surface between samples
  Interval u{1e300, -1e300}, v{1e300, -1e300};
  for (const Border& border : face.borders)
    for (const EdgeUse& use : border)
      for (int i = 0; i <= k_border_samples; ++i) {
        const Interval range = model.edges[use.edge].range;
        const Uv at = use.parameter->point(range.from + range.length() * i / k_border_samples);
        u = {std::min(u.from, at.u), std::max(u.to, at.u)};
        v = {std::min(v.from, at.v), std::max(v.to, at.v)};
      }
  const ParameterBox domain = face.surface->domain();
  const auto fit = [](Interval used, const Interval& all, bool is_periodic) {
    if (!is_periodic) return Interval{std::max(used.from, all.from), std::min(used.to, all.to)};
    return Interval{used.from, std::min(used.to, used.from + all.length())};
  };
  u = fit(u, domain.u, face.surface->is_periodic_u());
  v = fit(v, domain.v, face.surface->is_periodic_v());
  Box box;
  for (int i = 0; i <= k_box_samples; ++i)
    for (int j = 0; j <= k_box_samples; ++j) box.add(face.surface->point({u.from + u.length() * i / k_box_samples, v.from + v.length() * j / k_box_samples}));
  const double margin = k_box_margin * box.longest_side();
  box.min = box.min - Vec3{margin, margin, margin};
  box.max = box.max + Vec3{margin, margin, margin};
  return {SurfaceProjector(face.surface, {u, v}), box};
}

double distance_to_box(const Point& p, const Box& box) {
  const Vec3 d{std::max({box.min.x - p.x, 0.0, p.x - box.max.x}), std::max({box.min.y - p.y, 0.0, p.y - box.max.y}),
               std::max({box.min.z - p.z, 0.0, p.z - box.max.z})};
  return norm(d);
}

double distance_to_faces(const Point& p, const std::vector<FaceTarget>& targets) {
  std::vector<std::pair<double, std::size_t>> order;
  for (std::size_t i = 0; i < targets.size(); ++i) order.emplace_back(distance_to_box(p, targets[i].box), i);
  std::sort(order.begin(), order.end());
  double best = 1e300;
  for (const auto& [bound, i] : order) {
    if (bound >= best) break;
    best = std::min(best, targets[i].projector.nearest(p).distance);
  }
  return best;
}

/// Prints the largest and mean distance of the midpoints of edges and triangles, for at most k_most triangles at even steps.
void print_distances(const Model& model, const std::vector<std::string>& meshes, const RunContext& context) {
  constexpr std::size_t k_most = 10'000;
  std::vector<FaceTarget> targets;
  for (const ModelFace& face : model.faces) targets.push_back(make_target(model, face));
  for (const std::string& path : meshes) {
    const RawMesh mesh = read_raw(path);
    const std::size_t step = (mesh.triangles.size() + k_most - 1) / k_most, n = step == 0 ? 0 : mesh.triangles.size() / step;
    std::vector<double> edges(n), middles(n);
    parallel_for(
        context, n,
        [&](std::size_t i) {
          Point p[3];
          for (std::size_t k = 0; k < 3; ++k) {
            const auto& x = mesh.points[static_cast<std::size_t>(mesh.triangles[i * step][k])];
            p[k] = {x[0], x[1], x[2]};
          }
          for (std::size_t k = 0; k < 3; ++k) edges[i] = std::max(edges[i], distance_to_faces(0.5 * (p[k] + p[(k + 1) % 3]), targets));
          middles[i] = distance_to_faces((p[0] + p[1] + p[2]) / 3.0, targets);
        },
        64);
    double most = 0.0, sum = 0.0;
    for (std::size_t i = 0; i < n; ++i) most = std::max({most, edges[i], middles[i]}), sum += middles[i];
    std::printf("DISTANCE %s %zu %.6e %.6e\n", path.c_str(), n, most, sum / static_cast<double>(std::max<std::size_t>(n, 1)));
    std::fflush(stdout);
  }
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
    if (!settings.measured.empty()) return print_distances(model, settings.measured, context);
    const bool is_closed = free_edges(model).empty();
    const std::clock_t clock = std::clock();
    try {
      const surfmesh::SurfaceMesh mesh = surfmesh::mesh_model(model, settings.options, {}, context);
      const double meshing = static_cast<double>(std::clock() - clock) / CLOCKS_PER_SEC;
      const surfmesh::SurfaceMeshReport& r = mesh.report;
      const auto n = static_cast<double>(mesh.mesh.n_triangles());
      std::string worst = "-";
      if (r.worst_face.is_valid()) worst = r.faces[r.worst_face.index()].name + " " + format_point(r.faces[r.worst_face.index()].worst_location);
      double normal_angle = 0.0;
      for (const auto& face : r.faces) normal_angle = std::max(normal_angle, face.max_normal_angle);
      const test::TriangleQuality q = test::measure_triangles(mesh.mesh.points.raw(), mesh.mesh.triangles.raw());
      std::printf("| %s | %zu | %s | %zu | %.2f | %.0f | %.2f | %.1f | %.4f | %.1f | %.3f | %.0f | %.1e | %lld | %zu | %d | %s | %.1f |\n", name.c_str(),
                  model.faces.size(), is_closed ? "closed" : "open", mesh.mesh.n_triangles(), meshing, n / meshing * 1e-3, r.min_angle / k_deg,
                  r.angle_quantile_1 / k_deg, q.radius_ratio, 100.0 * q.share_of_six, 100.0 * r.share_20_130, normal_angle / k_deg, r.max_edge_distance,
                  static_cast<long long>(r.n_crossings), r.absorbed.size(), r.n_rounds, worst.c_str(), reading);
      if (settings.is_verbose) {
        std::vector<surfmesh::FaceMeshSummary> faces = r.faces;
        std::sort(faces.begin(), faces.end(), [](const auto& a, const auto& b) { return a.n_outside_20_130 > b.n_outside_20_130; });
        for (std::size_t i = 0; i < std::min<std::size_t>(8, faces.size()); ++i)
          std::printf("    face %u \"%s\" %s: %lld triangles, %lld outside, angles %.2f .. %.1f at %s, normals %.1f at %s\n", faces[i].face.value(),
                      faces[i].name.c_str(), model.faces[faces[i].face].surface->kind().c_str(), static_cast<long long>(faces[i].n_triangles),
                      static_cast<long long>(faces[i].n_outside_20_130), faces[i].min_angle / k_deg, faces[i].max_angle / k_deg,
                      format_point(faces[i].worst_location).c_str(), faces[i].max_normal_angle / k_deg, format_point(faces[i].normal_location).c_str());
        for (const auto& a : r.absorbed) std::printf("    absorbed %s %g m at %s\n", a.what.c_str(), a.size, format_point(a.location).c_str());
        std::printf("    edge distance %g at %s\n", r.max_edge_distance, format_point(r.edge_distance_location).c_str());
      }
      if (!settings.raw_folder.empty()) write_raw(mesh.mesh, (std::filesystem::path(settings.raw_folder) / path.stem()).string() + ".tri");
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
  settings.options.crossings = "warn";
  std::puts(
      "| file | faces | model | triangles | cpu s | k/s | min angle | 1 % | radius ratio | six % | in [20, 130] % | normals | edges to faces, m | crossings | "
      "absorbed | rounds | worst | read s |");
  std::puts("|---|---|---|---|---|---|---|---|---|---|---|---|---|---|---|---|---|---|");
  for (int i = 1; i < argc; ++i) {
    const auto number = [&] { return i + 1 < argc ? std::strtod(argv[++i], nullptr) : 0.0; };
    const auto is = [&](const char* option) { return std::strcmp(argv[i], option) == 0; };
    if (is("-max")) settings.options.sizes.max_edge = number();
    else if (is("-angle")) settings.options.sizes.curvature_angle = number() * k_deg;
    else if (is("-growth")) settings.options.sizes.growth = number();
    else if (is("-refine")) settings.options.sizes.refinement = number();
    else if (is("-narrow")) settings.options.sizes.narrow = number();
    else if (is("-gaps")) settings.options.sizes.gap_cells = number();
    else if (is("-thickness")) settings.options.sizes.thickness_factor = number();
    else if (is("-intersection")) settings.options.intersection_factor = number();
    else if (is("-wing")) settings.options.leading_edge_factor = settings.options.trailing_edge_factor = number();
    else if (is("-nostrips")) settings.options.tip_strips = false;
    else if (is("-threads")) settings.threads = static_cast<int>(number());
    else if (is("-limit")) settings.options.sizes.max_triangles = static_cast<int>(number());
    else if (is("-nocheck")) settings.options.crossings = "ignore";
    else if (is("-strict")) settings.options.crossings = "error";
    else if (is("-parts")) settings.has_parts = true;
    else if (is("-v")) settings.is_verbose = true;
    else if (is("-out") && i + 1 < argc) settings.folder = argv[++i];
    else if (is("-raw") && i + 1 < argc) settings.raw_folder = argv[++i];
    else if (is("-distance") && i + 1 < argc) settings.measured.push_back(argv[++i]);
    else print_row(argv[i], settings);
  }
}
