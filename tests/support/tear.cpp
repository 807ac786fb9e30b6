#include "tests/support/tear.h"

#include <cmath>
#include <random>

namespace sterna::test {
namespace {

/// Returns a random number in [0, 1); std::uniform_real_distribution differs between libraries.
double share(std::mt19937_64& random) { return static_cast<double>(random() >> 11) * 0x1p-53; }

}  // namespace

SurfaceSoup tear(const TriMesh& mesh, const TearOptions& options) {
  std::mt19937_64 random(options.seed);
  const double length = body_length(mesh);
  const auto any_point = [&] { return mesh.points[VertexId(random() % mesh.n_vertices())]; };
  std::vector<Vec3> holes, planes, normals;
  for (int i = 0; i < options.holes; ++i) holes.push_back(any_point());
  for (int i = 0; i < options.gaps; ++i) {
    planes.push_back(any_point());
    normals.push_back(normalized(Vec3{share(random) - 0.5, share(random) - 0.5, share(random) - 0.5}));
  }
  std::vector<Vec3> points(mesh.points.begin(), mesh.points.end());
  for (Vec3& p : points)
    for (std::size_t axis = 0; axis < 3; ++axis) p[axis] += options.jitter * length * (2.0 * share(random) - 1.0);

  SurfaceSoup soup;
  soup.source = "torn.stl";
  soup.has_names = mesh.patches.size() > 1;
  for (const Patch& patch : mesh.patches) soup.patch_names.push_back(patch.name);
  if (soup.patch_names.empty()) soup.patch_names.push_back("");
  for (const TriangleId t : mesh.triangles.ids()) {
    const auto c = corners(mesh, t);
    const Vec3 middle = (c[0] + c[1] + c[2]) / 3.0;
    bool is_gone = share(random) < options.missing;
    for (const Vec3& hole : holes) is_gone |= distance(middle, hole) < 0.5 * options.hole * length;
    for (std::size_t i = 0; i < planes.size(); ++i) is_gone |= std::abs(dot(middle - planes[i], normals[i])) < 0.5 * options.gap * length;
    const int copies = share(random) < options.doubled ? 2 : 1;
    for (int copy = 0; copy < copies; ++copy) {
      const bool is_turned = share(random) < options.flipped;
      if (is_gone) continue;
      const auto n = static_cast<std::uint32_t>(soup.points.size());
      for (const VertexId v : mesh.triangles[t]) soup.points.push_back(points[v.index()]);
      soup.triangles.push_back(is_turned ? std::array<std::uint32_t, 3>{n, n + 2, n + 1} : std::array<std::uint32_t, 3>{n, n + 1, n + 2});
      soup.patch.push_back(mesh.triangle_patch.empty() ? 0 : mesh.triangle_patch[t].value());
    }
  }
  return soup;
}

}  // namespace sterna::test
