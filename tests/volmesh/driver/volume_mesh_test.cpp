// The whole pipeline on shapes that are each difficult in one way, in every position and scale.
#include <gtest/gtest.h>

#include "geom/base/error.h"
#include "tests/support/error_of.h"
#include "tests/support/test_shapes.h"
#include "volmesh/volume_mesh.h"

namespace sterna::volmesh {
namespace {

MeshCase thin_layers(const TriMesh& wall, int n = 12) {
  MeshCase options;
  options.envelope.layers = n;
  options.envelope.first_height = 1e-5 * body_length(wall);
  options.farfield.farfield_radius = 10.0 * body_length(wall);
  return options;
}

void expect_valid(const TriMesh& wall, const MeshCase& options) {
  const VolumeMeshResult result = volume_mesh(wall, options, RunContext({.threads = 2}));
  EXPECT_TRUE(result.check.is_valid()) << to_text(result.check);
  EXPECT_EQ(result.check.cells.prisms + result.check.cells.pyramids, static_cast<std::int64_t>(wall.n_triangles()) * options.envelope.layers);
}

/// A wing-like wedge: unit chord and span, sharp trailing edge with an angle of `angle` radians.
TriMesh sharp_wedge(double angle) {
  TriMesh mesh;
  mesh.patches.push_back({"wedge", PatchKind::wall});
  const double half = std::tan(0.5 * angle);
  mesh.points = Column<VertexId, Point>({{0, 0, -half}, {0, 0, half}, {1, 0, 0}, {0, 1, -half}, {0, 1, half}, {1, 1, 0}});
  const auto add = [&](int a, int b, int c) {
    mesh.triangles.push_back({VertexId(a), VertexId(b), VertexId(c)});
    mesh.triangle_patch.push_back(PatchId(0));
  };
  add(0, 2, 1);                // root
  add(3, 4, 5);                // tip
  add(1, 2, 5), add(1, 5, 4);  // upper
  add(0, 3, 5), add(0, 5, 2);  // lower
  add(0, 1, 4), add(0, 4, 3);  // front
  return mesh;
}

TEST(VolumeMesh, CubeAndSphere) {
  expect_valid(test::cube(4), thin_layers(test::cube(4)));
  expect_valid(test::sphere(6), thin_layers(test::sphere(6), 30));
}

TriMesh two_spheres() {
  const TriMesh first = test::sphere(4);
  TriMesh both = first;
  for (const Point& p : first.points) both.points.push_back(0.5 * p + Vec3{4, 0, 0});
  const auto shifted = [&](VertexId v) { return VertexId(v.index() + first.n_vertices()); };
  for (const TriangleVertices& v : first.triangles) both.triangles.push_back({shifted(v[0]), shifted(v[1]), shifted(v[2])});
  both.patches.push_back({"store", PatchKind::wall});
  both.triangle_patch.raw().resize(both.n_triangles(), PatchId(both.patches.size() - 1));
  return both;
}

TEST(VolumeMesh, BodiesApartHaveTheirOwnLayers) {
  const TriMesh wall = two_spheres();
  MeshCase options = thin_layers(wall, 12);
  options.patches = {{.names = "store", .options = {{"layers", 5}, {"first_height", 1e-3}}}};
  const VolumeMeshResult result = volume_mesh(wall, options, RunContext({.threads = 2}));
  EXPECT_TRUE(result.check.is_valid()) << to_text(result.check);
  const std::int64_t n_each = static_cast<std::int64_t>(wall.n_triangles()) / 2;
  EXPECT_EQ(result.check.cells.prisms + result.check.cells.pyramids, n_each * (12 + 5));
  EXPECT_EQ(result.mesh.layers.n_layers, 12);
  EXPECT_EQ(result.mesh.layers.layers_of_line(0), 12);
  EXPECT_EQ(result.mesh.layers.layers_of_line(wall.n_vertices() - 1), 5);
  EXPECT_NEAR(result.mesh.request.first_height_of(wall.n_vertices() - 1), 1e-3, 2e-5);  // measured above the facets: 1.6 % more along the vertex normals of
                                                                                        // this sphere
  EXPECT_LT(result.check.gate(Measure::first_height).worst, 0.02);
  EXPECT_EQ(result.layer.first_node.vertex_share, 1.0);
  // Without a first height for all walls each patch must have its own.
  options.envelope.first_height = k_automatic;
  test::expect_error(ErrorCode::bad_argument, "first_height is not given for sphere", [&] { (void)volume_mesh(wall, options, RunContext({.threads = 2})); });
  // The nodes are the same for any number of threads.
  options = thin_layers(wall, 12);
  options.patches = {{.names = "store", .options = {{"layers", 5}, {"first_height", 1e-3}}}};
  EXPECT_EQ(volume_mesh(wall, options, RunContext({.threads = 7})).mesh.points, result.mesh.points);
}

TEST(VolumeMesh, RazorSharpTrailingEdges) {
  for (const double angle : {0.5, 0.1, 0.01, 1e-3}) {
    SCOPED_TRACE(angle);
    expect_valid(sharp_wedge(angle), thin_layers(sharp_wedge(angle)));
  }
}

TEST(VolumeMesh, MovedAndScaled) {
  for (const double scale : {1e-6, 1.0, 1e6}) {
    TriMesh wall = test::cube(3);
    for (Point& p : wall.points) p = scale * p;
    SCOPED_TRACE(scale);
    expect_valid(wall, thin_layers(wall));
  }
  TriMesh wall = test::sphere(5);
  for (Point& p : wall.points) p += Vec3{1e3, -1e3, 1e3};
  expect_valid(wall, thin_layers(wall));
}

TEST(VolumeMesh, SeveralBodiesFindTheirCavities) {
  TriMesh wall = test::cube(3);
  for (const double x : {1.3, 2.9}) {
    TriMesh other = test::sphere(5, 0.5);
    for (Point& p : other.points) p += Vec3{x + 0.3, 0.5, 0.5};
    append(wall, other);
  }
  expect_valid(wall, thin_layers(wall));
}

TEST(VolumeMesh, OneLayerAndManyLayers) {
  const TriMesh wall = test::cube(2);
  for (const int n : {1, 2, 60}) expect_valid(wall, thin_layers(wall, n));
}

TEST(VolumeMesh, NodesOfALineAreConsecutive) {
  const TriMesh wall = test::sphere(4);
  const VolumeMeshResult result = volume_mesh(wall, thin_layers(wall), RunContext({.threads = 2}));
  const LayerBlock& layers = result.mesh.layers;
  const double h0 = thin_layers(wall).envelope.first_height;
  for (std::uint32_t line = 0; line < layers.n_lines(); ++line) {
    EXPECT_EQ(result.mesh.points[layers.node(line, 0)], wall.points[VertexId(line)]);
    for (int j = 1; j <= layers.n_layers; ++j) EXPECT_EQ(layers.node(line, j).value(), layers.node(line, j - 1).value() + 1);
    EXPECT_NEAR(distance(result.mesh.points[layers.node(line, 0)], result.mesh.points[layers.node(line, 1)]), h0,
                0.02 * h0);  // above the facets; along the vertex normal of this sphere 1.4 % more
  }
}

TEST(VolumeMesh, FirstHeightIsRequired) {
  try {
    volume_mesh(test::cube(2), {}, RunContext({.threads = 2}));
    FAIL();
  } catch (const Error& error) {
    EXPECT_EQ(error.code(), ErrorCode::bad_argument);
    EXPECT_NE(std::string(error.what()).find("first_height"), std::string::npos);
  }
}

TEST(VolumeMesh, OpenWallsAreRefusedWithTheirEdges) {
  TriMesh open = test::cube(2);
  open.triangles.resize(open.n_triangles() - 1);
  open.triangle_patch.resize(open.n_triangles());
  try {
    volume_mesh(open, thin_layers(open), RunContext({.threads = 2}));
    FAIL() << "accepted";
  } catch (const Error& error) {
    EXPECT_EQ(error.code(), ErrorCode::open_surface);
    EXPECT_NE(std::string(error.what()).find("1 open boundaries with 3 edges"), std::string::npos) << error.what();
  }
}

TEST(VolumeMesh, SameMeshForAnyNumberOfThreads) {
  const TriMesh wall = test::cube(5);
  const VolumeMeshResult first = volume_mesh(wall, thin_layers(wall), RunContext({.threads = 1}));
  for (const int threads : {2, 7}) {
    const VolumeMeshResult result = volume_mesh(wall, thin_layers(wall), RunContext({.threads = threads}));
    EXPECT_EQ(result.mesh.points, first.mesh.points);
    EXPECT_EQ(result.mesh.tetrahedra, first.mesh.tetrahedra);
  }
}

TEST(VolumeMesh, StopsOnRequest) {
  std::stop_source source;
  source.request_stop();
  const TriMesh wall = test::cube(2);
  try {
    volume_mesh(wall, thin_layers(wall), RunContext({.threads = 2, .stop = source.get_token()}));
    FAIL();
  } catch (const Error& error) {
    EXPECT_EQ(error.code(), ErrorCode::cancelled);
  }
}

}  // namespace
}  // namespace sterna::volmesh
