#include "tests/support/model_meshes.h"

#include <gtest/gtest.h>

#include <map>

#include "geom/model/analytic_surfaces.h"
#include "geom/model/curves.h"
#include "geom/model/model_builder.h"

namespace sterna::test {

Model make_ball(double radius) {
  ModelBuilder builder({.name = "ball", .kind = ComponentKind::body});
  const auto surface = std::make_shared<SphereSurface>(Frame{}, radius);
  const ParameterBox box = surface->domain();
  const CornerId south = builder.corner(surface->point({box.u.from, box.v.from})), north = builder.corner(surface->point({box.u.from, box.v.to}));
  const EdgeId seam = builder.edge(std::make_shared<EllipseCurve>(Point{}, Vec3{radius, 0, 0}, Vec3{0, 0, radius}, box.v), box.v, south, north);
  builder.patch(surface, box, {builder.pole(south), seam, builder.pole(north), seam}, FaceRole::skin, "ball");
  return builder.closed_solid("ball");
}

void expect_joined(const Model& model, const surfmesh::SurfaceMesh& surface) {
  std::map<std::pair<VertexId, VertexId>, int> edges;
  for (const TriangleVertices& v : surface.mesh.triangles)
    for (std::size_t k = 0; k < 3; ++k) {
      EXPECT_NE(v[k], v[(k + 1) % 3]);
      ++edges[{v[k], v[(k + 1) % 3]}];
    }
  std::int64_t n_free = 0;
  for (const auto& [edge, n] : edges) {
    EXPECT_EQ(n, 1);
    if (!edges.contains({edge.second, edge.first})) ++n_free;
  }
  EXPECT_EQ(n_free, surface.report.n_free_edges);
  EXPECT_EQ(n_free == 0, free_edges(model).empty());
}

void expect_sound(const Model& model, const surfmesh::SurfaceMesh& surface) {
  expect_joined(model, surface);
  const TriMesh& mesh = surface.mesh;
  EXPECT_EQ(surface.report.n_crossings, 0);
  ASSERT_EQ(surface.locations.size(), mesh.n_vertices());
  ASSERT_EQ(surface.edge_locations.size(), mesh.n_vertices());
  ASSERT_EQ(surface.triangle_face.size(), mesh.n_triangles());
  const double length = bounding_box(mesh).longest_side();
  for (const VertexId v : mesh.points.ids()) {
    const VertexLocation& location = surface.locations[v];
    const surfmesh::EdgeLocation& on = surface.edge_locations[v];
    ASSERT_TRUE(location.face.is_valid());
    const double off = distance(model.faces[location.face].surface->point(location.at), mesh.points[v]);
    EXPECT_LE(off, on.edge.is_valid() ? surface.report.max_edge_distance + 1e-12 * length : std::max(1e-9 * length, surface.report.max_edge_distance));
    if (on.edge.is_valid()) {
      EXPECT_EQ(model.edges[on.edge].curve->point(on.t), mesh.points[v]);
    }
  }
  for (const TriangleId t : mesh.triangles.ids()) EXPECT_EQ(mesh.patches[mesh.triangle_patch[t]].name, model.faces[surface.triangle_face[t]].name);
}

}  // namespace sterna::test
