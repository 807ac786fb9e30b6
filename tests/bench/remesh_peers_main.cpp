// Compares remesh_surface with CGAL's isotropic remeshing and Gmsh's reparametrisation in one run. Both peers get the edge length that yields as many triangles
// as ours, and keep edges that bend by more than 40 degrees.
// usage: remesh_peers surface...        Markdown table on standard output. Each peer runs in a separate process, at most 120 s.
#include <CGAL/Exact_predicates_inexact_constructions_kernel.h>
#include <CGAL/Polygon_mesh_processing/detect_features.h>
#include <CGAL/Polygon_mesh_processing/remesh.h>
#include <CGAL/Surface_mesh.h>
#include <gmsh.h>
#include <sys/wait.h>
#include <unistd.h>

#include <cstdio>
#include <ctime>
#include <filesystem>
#include <functional>
#include <map>
#include <numbers>

#include "geom/base/error.h"
#include "geom/math/measures.h"
#include "geom/mesh/find_crossings.h"
#include "io/file/surface_file.h"
#include "surfmesh/remesh/remesh_report.h"
#include "surfmesh/stitch/stitch_surface.h"

using namespace sterna;

namespace {

constexpr double k_degrees = 180.0 / std::numbers::pi;
constexpr double k_feature = 40.0;  // degrees
const RunContext k_one({.threads = 1});

void add_triangle(TriMesh& mesh, VertexId a, VertexId b, VertexId c) {
  mesh.triangles.push_back({a, b, c});
  mesh.triangle_patch.push_back(PatchId(0));
}

TriMesh by_cgal(const TriMesh& wall, double edge) {
  using Mesh = CGAL::Surface_mesh<CGAL::Exact_predicates_inexact_constructions_kernel::Point_3>;
  namespace pmp = CGAL::Polygon_mesh_processing;
  Mesh mesh;
  std::vector<Mesh::Vertex_index> ids;
  for (const Point& p : wall.points) ids.push_back(mesh.add_vertex({p.x, p.y, p.z}));
  for (const TriangleVertices& v : wall.triangles) mesh.add_face(ids[v[0].index()], ids[v[1].index()], ids[v[2].index()]);
  auto sharp = mesh.add_property_map<Mesh::Edge_index, bool>("e:sharp", false).first;
  pmp::detect_sharp_edges(mesh, k_feature, sharp);
  pmp::isotropic_remeshing(mesh.faces(), edge, mesh, pmp::parameters::number_of_iterations(5).edge_is_constrained_map(sharp).relax_constraints(true));
  mesh.collect_garbage();
  TriMesh out;
  out.patches.push_back({"wall", PatchKind::wall});
  for (const auto v : mesh.vertices()) out.points.push_back({mesh.point(v).x(), mesh.point(v).y(), mesh.point(v).z()});
  for (const auto f : mesh.faces()) {
    std::vector<VertexId> v;
    for (const auto k : mesh.vertices_around_face(mesh.halfedge(f))) v.emplace_back(static_cast<std::uint64_t>(k));
    add_triangle(out, v[0], v[1], v[2]);
  }
  return out;
}

TriMesh by_gmsh(const TriMesh& wall, double edge) {
  const std::filesystem::path file = std::filesystem::temp_directory_path() / ("peer" + std::to_string(getpid()) + ".stl");
  io::write_surface_file(wall, file, k_one);
  gmsh::initialize();
  gmsh::option::setNumber("General.Terminal", 0);
  gmsh::merge(file);
  gmsh::model::mesh::classifySurfaces(k_feature / k_degrees, true, true, std::numbers::pi);
  gmsh::model::mesh::createGeometry();
  gmsh::option::setNumber("Mesh.MeshSizeExtendFromBoundary", 0);
  gmsh::option::setNumber("Mesh.MeshSizeMin", edge);
  gmsh::option::setNumber("Mesh.MeshSizeMax", edge);
  gmsh::model::mesh::generate(2);
  std::vector<std::size_t> nodes, triangles, numbers;
  std::vector<double> points, parameters;
  gmsh::model::mesh::getNodes(nodes, points, parameters);
  gmsh::model::mesh::getElementsByType(2, numbers, triangles);
  std::filesystem::remove(file);
  TriMesh out;
  out.patches.push_back({"wall", PatchKind::wall});
  std::map<std::size_t, VertexId> ids;
  for (std::size_t i = 0; i < nodes.size(); ++i) ids[nodes[i]] = out.points.push_back({points[3 * i], points[3 * i + 1], points[3 * i + 2]});
  for (std::size_t i = 0; i + 2 < triangles.size(); i += 3) add_triangle(out, ids[triangles[i]], ids[triangles[i + 1]], ids[triangles[i + 2]]);
  gmsh::finalize();
  return out;
}

void print(const std::string& file, const char* who, const TriMesh& wall, const TriMesh& mesh, double seconds) {
  if (mesh.n_triangles() == 0) {
    std::printf("| %s | %s | no triangles |\n", file.c_str(), who);
    return;
  }
  surfmesh::RemeshReport r;
  surfmesh::measure_angles(mesh, r);
  const auto out = surfmesh::surface_distance(mesh, wall, true, k_one), back = surfmesh::surface_distance(wall, mesh, false, k_one);
  std::int64_t n_slivers = 0;
  std::vector<std::array<std::uint32_t, 3>> list;
  for (const TriangleId t : mesh.triangles.ids()) {
    const auto [a, b, c] = corners(mesh, t);
    if (std::min({corner_angle(a, b, c), corner_angle(b, c, a), corner_angle(c, a, b)}) < surfmesh::k_sliver_angle) ++n_slivers;
    list.push_back({mesh.triangles[t][0].value(), mesh.triangles[t][1].value(), mesh.triangles[t][2].value()});
  }
  std::printf("| %s | %s | %zu | %.2f | %.1f | %.4f | %lld | %.1e | %.1e | %lld | %.2f | %.0f |\n", file.c_str(), who, mesh.n_triangles(),
              r.min_angle * k_degrees, r.angle_quantile_1 * k_degrees, r.mean_radius_ratio, static_cast<long long>(n_slivers), out.max / r.length,
              back.max / r.length, static_cast<long long>(find_crossings(mesh.points.raw(), list, k_one).total), seconds,
              static_cast<double>(mesh.n_triangles()) / seconds);
  std::fflush(stdout);
}

void run(const std::string& file, const char* who, const TriMesh& wall, const std::function<TriMesh()>& make) {
  const pid_t child = fork();
  if (child == 0) {
    alarm(120);
    try {
      const std::clock_t begin = std::clock();
      const TriMesh mesh = make();
      const double seconds = static_cast<double>(std::clock() - begin) / CLOCKS_PER_SEC;
      print(file, who, wall, mesh, seconds);
    } catch (const std::exception& error) {
      std::printf("| %s | %s | %.150s |\n", file.c_str(), who, error.what());
      std::fflush(stdout);
    } catch (...) {
      std::printf("| %s | %s | failed |\n", file.c_str(), who);
      std::fflush(stdout);
    }
    _exit(0);
  }
  int status = 0;
  waitpid(child, &status, 0);
  if (status != 0)
    std::printf("| %s | %s | %s |\n", file.c_str(), who, WIFSIGNALED(status) && WTERMSIG(status) == SIGALRM ? "no answer within 120 s" : "crashed");
  std::fflush(stdout);
}

}  // namespace

int main(int argc, char** argv) {
  std::printf(
      "| file | by | triangles | least angle | 1 %% | radius ratio | needles | new to given / L | given to new / L | crossings | CPU s | triangles/s |\n");
  std::printf("|---|---|---|---|---|---|---|---|---|---|---|---|\n");
  std::fflush(stdout);
  for (int i = 1; i < argc; ++i) {
    const std::filesystem::path path = argv[i];
    const std::string name = path.filename();
    const TriMesh wall = surfmesh::stitch_surface({io::read_surface_file(path, k_one)}, {.allow_open = true}, k_one).mesh;
    const std::clock_t begin = std::clock();
    const TriMesh ours = surfmesh::remesh_surface(wall, {}, {}, {}, k_one).mesh;
    print(name, "given", wall, wall, 1.0);
    print(name, "sterna", wall, ours, static_cast<double>(std::clock() - begin) / CLOCKS_PER_SEC);
    double area = 0.0;
    for (const TriangleId t : wall.triangles.ids()) {
      const auto [a, b, c] = corners(wall, t);
      area += triangle_area(a, b, c);
    }
    const double edge = std::sqrt(area / (0.433 * static_cast<double>(ours.n_triangles())));
    run(name, "CGAL", wall, [&] { return by_cgal(wall, edge); });
    run(name, "Gmsh", wall, [&] { return by_gmsh(wall, edge); });
  }
}
