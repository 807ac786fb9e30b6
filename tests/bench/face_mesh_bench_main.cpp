// Triangles per second (CPU time) and quality of the mesher of one face, compared with a planar triangulation of as many points in the same run.
// usage: face_mesh_bench [FACTOR ...]    edges are divided by each factor; [-name NAME] only that face; [-vtk FILE] writes the last mesh
#include <cstdio>
#include <cstdlib>
#include <cstring>
#include <ctime>
#include <numbers>
#include <random>
#include <string>
#include <vector>

#include "geom/base/error.h"
#include "geom/delaunay/planar.h"
#include "tests/support/face_shapes.h"
#include "tests/support/triangle_quality.h"

namespace {

using namespace sterna;

double seconds_since(std::clock_t start) { return static_cast<double>(std::clock() - start) / CLOCKS_PER_SEC; }

void write_vtk(const char* path, const surfmesh::FaceMesh& mesh) {
  std::FILE* file = std::fopen(path, "w");
  if (file == nullptr) return;
  std::fprintf(file, "# vtk DataFile Version 3.0\nface\nASCII\nDATASET POLYDATA\nPOINTS %zu double\n", mesh.points.size());
  for (const Point& p : mesh.points) std::fprintf(file, "%.9g %.9g %.9g\n", p.x, p.y, p.z);
  std::fprintf(file, "POLYGONS %zu %zu\n", mesh.triangles.size(), 4 * mesh.triangles.size());
  for (const TriangleVertices& v : mesh.triangles) std::fprintf(file, "3 %u %u %u\n", v[0].value(), v[1].value(), v[2].value());
  std::fclose(file);
}

double planar_seconds(std::size_t n, const RunContext& context) {
  std::mt19937_64 random(1);
  std::uniform_real_distribution<double> uniform;
  std::vector<Vec2> points(n);
  for (Vec2& p : points) p = {uniform(random), uniform(random)};
  const std::clock_t start = std::clock();
  delaunay::triangulate_plane(points, {}, delaunay::Extent::hull, context);
  return seconds_since(start);
}

void measure(const test::FaceShape& shape, double factor, const char* vtk) {
  const RunContext context({.threads = 1});
  const double size = shape.size / factor;
  const surfmesh::FaceBorder border = test::box_border(*shape.surface, shape.box, size);
  surfmesh::FaceMeshOptions options;
  options.curvature_angle = 0.6;
  const std::clock_t start = std::clock();
  const surfmesh::FaceMesh mesh = surfmesh::mesh_face(
      *shape.surface, border, [&](Uv, const Point&) { return size; }, options, context);
  const double seconds = seconds_since(start);
  const surfmesh::FaceMeshReport& r = mesh.report;
  const double deg = 180.0 / std::numbers::pi;
  const double n = static_cast<double>(mesh.triangles.size());
  const test::TriangleQuality q = test::measure_triangles(mesh.points, mesh.triangles);
  std::printf(
      "%-13s x%-5g %8zu tris %7.3f s %6.0f k/s (%.1f x plane) ratio %.4f 1%% %.1f six %.1f %% angles %5.1f..%5.1f outside %lld (%.3f %%) folded %lld | unfold "
      "%lld size %lld quality %lld refused %lld flips %lld moves %lld collapses %lld worst %s\n",
      shape.name.c_str(), factor, mesh.triangles.size(), seconds, n / seconds * 1e-3, seconds / planar_seconds(mesh.points.size(), context), q.radius_ratio,
      q.angle_quantile_1, 100.0 * q.share_of_six, r.min_angle * deg, r.max_angle * deg, static_cast<long long>(r.n_outside_20_130),
      100.0 * static_cast<double>(r.n_outside_20_130) / n, static_cast<long long>(r.n_folded), static_cast<long long>(r.n_unfolding),
      static_cast<long long>(r.n_first_pass), static_cast<long long>(r.n_second_pass), static_cast<long long>(r.n_refused), static_cast<long long>(r.n_flips),
      static_cast<long long>(r.n_moves), static_cast<long long>(r.n_collapses), format_point(r.worst_location).c_str());
  if (vtk != nullptr) write_vtk(vtk, mesh);
}

}  // namespace

int main(int argc, char** argv) {
  std::vector<double> factors;
  std::string name;
  const char* vtk = nullptr;
  for (int i = 1; i < argc; ++i) {
    if (std::strcmp(argv[i], "-name") == 0 && i + 1 < argc) name = argv[++i];
    else if (std::strcmp(argv[i], "-vtk") == 0 && i + 1 < argc) vtk = argv[++i];
    else factors.push_back(std::strtod(argv[i], nullptr));
  }
  if (factors.empty()) factors = {1.0, 4.0};
  for (const test::FaceShape& shape : test::face_shapes())
    for (const double factor : factors)
      if (name.empty() || name == shape.name) measure(shape, factor, vtk);
  return 0;
}
