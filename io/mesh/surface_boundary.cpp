#include "io/mesh/surface_boundary.h"

#include <array>

#include "io/mesh/surface_builder.h"

namespace sterna::io {

HybridMesh as_boundary(const TriMesh& mesh, Winding winding) {
  HybridMesh boundary;
  boundary.points.raw() = mesh.points.raw();
  boundary.patches = mesh.patches;
  boundary.boundary_triangles.reserve(mesh.n_triangles());
  for (const TriangleId t : mesh.triangles.ids()) {
    const TriangleVertices& v = mesh.triangles[t];
    const NodeId a(v[0].value()), b(v[1].value()), c(v[2].value());
    boundary.boundary_triangles.push_back({winding == Winding::kept ? std::array{a, b, c} : std::array{a, c, b}, mesh.triangle_patch[t]});
  }
  return boundary;
}

SurfaceSoup boundary_soup(const HybridMesh& mesh, const std::string& source, const RunContext& context) {
  SurfaceBuilder builder(source);
  builder.reserve_points(mesh.points.size());
  builder.reserve_polygons(mesh.boundary_triangles.size() + 2 * mesh.boundary_quads.size());
  for (const Point& p : mesh.points) builder.add_point(p);
  const auto add = [&](const auto& faces) {
    for (const auto& face : faces) {
      builder.set_patch(mesh.patches[face.patch].name);
      std::array<std::uint32_t, 4> corners{};
      for (std::size_t k = 0; k < face.nodes.size(); ++k) corners[k] = face.nodes[k].value();
      builder.add_polygon(std::span(corners).first(face.nodes.size()));
    }
  };
  add(mesh.boundary_triangles);
  add(mesh.boundary_quads);
  SurfaceSoup soup = builder.finish(context, true);
  soup.has_names = !mesh.patches.empty();
  soup.n_cells = static_cast<std::uint64_t>(count_cells(mesh).total());
  return soup;
}

SurfaceSoup boundary_soup(const FileBoundary& boundary, const std::string& source, const RunContext& context) {
  SurfaceSoup soup = boundary_soup(boundary.mesh, source, context);
  soup.n_cells = boundary.n_cells;
  return soup;
}

}  // namespace sterna::io
