#include "geom/mesh/topology.h"

#include <gtest/gtest.h>

#include <set>

#include "geom/base/error.h"
#include "tests/support/test_shapes.h"

namespace sterna {
namespace {

using test::cube;
using test::sphere;

TriMesh single_triangle() {
  TriMesh mesh;
  mesh.patches.push_back({"one", PatchKind::wall});
  mesh.points = {Point{0, 0, 0}, Point{1, 0, 0}, Point{0, 1, 0}};
  mesh.triangles.push_back({VertexId(0), VertexId(1), VertexId(2)});
  mesh.triangle_patch.push_back(PatchId(0));
  return mesh;
}

void expect_consistent(const TriMesh& mesh, const Topology& topology) {
  ASSERT_EQ(topology.n_halfedges(), 3 * mesh.n_triangles());
  std::vector<std::set<VertexId>> neighbours(mesh.n_vertices());
  std::size_t n_boundary = 0;
  for (std::uint32_t i = 0; i < topology.n_halfedges(); ++i) {
    const HalfedgeId h(i);
    EXPECT_EQ(topology.from(h), mesh.triangles[triangle_of(h)][static_cast<std::size_t>(corner_of(h))]);
    EXPECT_EQ(next(previous(h)), h);
    EXPECT_EQ(topology.from(next(h)), topology.to(h));
    neighbours[topology.from(h).index()].insert(topology.to(h));
    neighbours[topology.to(h).index()].insert(topology.from(h));
    if (topology.is_boundary(h)) {
      ++n_boundary;
      continue;
    }
    const HalfedgeId t = topology.twin(h);
    EXPECT_NE(t, h);
    EXPECT_EQ(topology.twin(t), h);
    EXPECT_EQ(topology.from(t), topology.to(h));
    EXPECT_EQ(topology.to(t), topology.from(h));
  }
  EXPECT_EQ(topology.n_boundary_halfedges(), n_boundary);
  std::size_t n_outgoing = 0;
  for (const VertexId v : mesh.points.ids()) {
    const auto out = topology.outgoing(v);
    n_outgoing += out.size();
    EXPECT_TRUE(std::is_sorted(out.begin(), out.end()));
    for (const HalfedgeId h : out) EXPECT_EQ(topology.from(h), v);
    const auto around = topology.neighbours(v);
    EXPECT_TRUE(std::equal(around.begin(), around.end(), neighbours[v.index()].begin(), neighbours[v.index()].end()));
  }
  EXPECT_EQ(n_outgoing, topology.n_halfedges());
}

TEST(Topology, TwinsNeighboursAndEulerNumberOfClosedShapes) {
  const RunContext context({.threads = 2});
  for (const TriMesh& mesh : {cube(1), cube(4), sphere(1), sphere(16)}) {
    const Topology topology(mesh, context);
    expect_consistent(mesh, topology);
    EXPECT_EQ(topology.n_boundary_halfedges(), 0u);
    EXPECT_EQ(mesh.n_vertices() - topology.n_halfedges() / 2 + mesh.n_triangles(), 2u);
    EXPECT_EQ(connected_components(mesh, topology).count, 1u);
  }
}

TEST(Topology, OpenSurfacesHaveBoundaryHalfedges) {
  const RunContext context;
  TriMesh mesh = single_triangle();
  expect_consistent(mesh, Topology(mesh, context));
  mesh = cube(3);
  mesh.triangles.raw().pop_back();
  mesh.triangle_patch.raw().pop_back();
  const Topology topology(mesh, context);
  expect_consistent(mesh, topology);
  EXPECT_EQ(topology.n_boundary_halfedges(), 3u);
}

TEST(Topology, EmptyMeshAndUnusedVerticesAreFine) {
  const RunContext context;
  EXPECT_EQ(Topology(TriMesh{}, context).n_halfedges(), 0u);
  TriMesh mesh = single_triangle();
  mesh.points.push_back({5, 5, 5});
  const Topology topology(mesh, context);
  EXPECT_TRUE(topology.outgoing(VertexId(3)).empty());
  EXPECT_TRUE(topology.neighbours(VertexId(3)).empty());
}

TEST(Topology, ComponentsAreNumberedByTheirFirstTriangle) {
  TriMesh mesh = cube(2);
  append(mesh, sphere(2, 0.1));
  append(mesh, single_triangle());
  const Components components = connected_components(mesh, Topology(mesh, RunContext()));
  EXPECT_EQ(components.count, 3u);
  EXPECT_EQ(components.component[TriangleId(0)], 0u);
  EXPECT_EQ(components.component[TriangleId(48)], 1u);
  EXPECT_EQ(components.component.raw().back(), 2u);
  EXPECT_TRUE(std::is_sorted(components.component.begin(), components.component.end()));
}

TEST(Topology, EdgeOfThreeTrianglesIsErrorWithLocation) {
  TriMesh mesh = cube(1);
  const TriangleVertices first = mesh.triangles.raw().front();
  const VertexId apex = mesh.points.push_back({5, 5, 5});
  mesh.triangles.push_back({first[0], first[1], apex});
  mesh.triangle_patch.push_back(PatchId(0));
  try {
    const Topology topology(mesh, RunContext());
    FAIL();
  } catch (const Error& error) {
    EXPECT_EQ(error.code(), ErrorCode::non_manifold_surface);
    ASSERT_EQ(error.n_locations(), 1);
    EXPECT_EQ(error.info().locations[0].position, 0.5 * (mesh.points[first[0]] + mesh.points[first[1]]));
    EXPECT_NE(std::string(error.what()).find("3 triangles where 2 are allowed, patch cube"), std::string::npos) << error.what();
    EXPECT_EQ(error.info().geometry.edges.size(), 1u);
  }
}

TEST(Topology, FlippedTriangleIsErrorAtThreeEdges) {
  TriMesh mesh = sphere(4);
  TriangleVertices& v = mesh.triangles.raw()[100];
  std::swap(v[0], v[1]);
  std::vector<std::string> messages;
  for (const int threads : {1, 2, 7}) {
    try {
      const Topology topology(mesh, RunContext({.threads = threads}));
      FAIL();
    } catch (const Error& error) {
      EXPECT_EQ(error.code(), ErrorCode::non_manifold_surface);
      EXPECT_EQ(error.n_locations(), 3);
      messages.push_back(error.what());
    }
  }
  EXPECT_NE(messages[0].find("two triangles of opposite orientation"), std::string::npos) << messages[0];
  EXPECT_EQ(messages[0], messages[1]);
  EXPECT_EQ(messages[0], messages[2]);
}

TEST(Topology, TwinsAreEqualForAnyThreadsOnSphere) {
  const TriMesh mesh = sphere(60);
  const Topology one(mesh, RunContext({.threads = 1}));
  for (const int threads : {2, 7}) {
    const Topology other(mesh, RunContext({.threads = threads}));
    for (std::uint32_t h = 0; h < one.n_halfedges(); ++h) ASSERT_EQ(one.twin(HalfedgeId(h)), other.twin(HalfedgeId(h)));
  }
}

}  // namespace
}  // namespace sterna
