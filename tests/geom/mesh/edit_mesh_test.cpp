#include "geom/mesh/edit_mesh.h"

#include <gtest/gtest.h>

#include <algorithm>

namespace sterna {
namespace {

/// Returns a closed octahedron: vertices 0 to 3 around the equator, 4 above, 5 below.
EditMesh octahedron() {
  TriMesh mesh;
  mesh.points = Column<VertexId, Point>(6);
  for (std::uint32_t k = 0; k < 4; ++k) {
    const VertexId a(k), b((k + 1) % 4);
    mesh.triangles.push_back({a, b, VertexId(4u)});
    mesh.triangles.push_back({b, a, VertexId(5u)});
  }
  mesh.patches.push_back({});
  mesh.triangle_patch = Column<TriangleId, PatchId>(8, PatchId(0u));
  return EditMesh(mesh, Topology(mesh, RunContext{}));
}

/// Expects that twins are mutual, that both sides of an edge have one label, and that each vertex with triangles has an outgoing half-edge.
void expect_sound(const EditMesh& mesh) {
  for (const TriangleId t : mesh.triangles.ids()) {
    if (mesh.is_removed(t)) continue;
    for (int k = 0; k < 3; ++k) {
      const HalfedgeId h = halfedge(t, k), o = mesh.twins[h];
      EXPECT_EQ(mesh.from(mesh.outgoing[mesh.from(h)]), mesh.from(h));
      if (!o.is_valid()) continue;
      EXPECT_EQ(mesh.twins[o], h);
      EXPECT_EQ(mesh.labels[o], mesh.labels[h]);
      EXPECT_EQ(mesh.from(o), mesh.to(h));
      EXPECT_EQ(mesh.to(o), mesh.from(h));
    }
  }
}

int valence(const EditMesh& mesh, VertexId v) {
  int n = 0;
  mesh.for_ring(v, [&](VertexId) { ++n; });
  return n;
}

HalfedgeId edge(const EditMesh& mesh, VertexId a, VertexId b) {
  HalfedgeId found;
  mesh.for_out(a, [&](HalfedgeId h) {
    if (mesh.to(h) == b) found = h;
  });
  return found;
}

constexpr VertexId k_east(0u), k_north(1u), k_west(2u), k_top(4u), k_bottom(5u);

TEST(EditMesh, FlipTakesGivenTrianglesAndKeepsLabels) {
  EditMesh mesh = octahedron();
  const HalfedgeId h = edge(mesh, k_east, k_north), side = edge(mesh, k_north, k_top);
  mesh.labels[side] = mesh.labels[mesh.twins[side]] = 7;
  const TriangleVertices first{k_top, k_bottom, k_north}, second{k_east, k_bottom, k_top};
  const TriangleId t = triangle_of(h), u = triangle_of(mesh.twins[h]);
  mesh.flip(h, first, second);
  EXPECT_EQ(mesh.triangles[t], first);
  EXPECT_EQ(mesh.triangles[u], second);
  expect_sound(mesh);
  EXPECT_TRUE(mesh.is_edge(k_top, k_bottom));
  EXPECT_FALSE(mesh.is_edge(k_east, k_north));
  EXPECT_EQ(mesh.labels[edge(mesh, k_north, k_top)], 7);
  EXPECT_EQ(mesh.labels[edge(mesh, k_top, k_bottom)], k_no_label);
}

TEST(EditMesh, SplitAppendsTwoTrianglesAndOneVertex) {
  EditMesh mesh = octahedron();
  const HalfedgeId h = edge(mesh, k_east, k_north);
  mesh.labels[h] = mesh.labels[mesh.twins[h]] = 3;
  const VertexId m = mesh.split(h);
  EXPECT_EQ(m, VertexId(6u));
  EXPECT_EQ(mesh.triangles.size(), 10u);
  EXPECT_EQ(mesh.triangles[TriangleId(8u)], (TriangleVertices{m, k_north, k_top}));
  EXPECT_EQ(mesh.triangles[TriangleId(9u)], (TriangleVertices{m, k_east, k_bottom}));
  expect_sound(mesh);
  EXPECT_EQ(valence(mesh, m), 4);
  EXPECT_EQ(mesh.labels[edge(mesh, k_east, m)], 3);
  EXPECT_EQ(mesh.labels[edge(mesh, m, k_north)], 3);
  EXPECT_EQ(mesh.labels[edge(mesh, m, k_top)], k_no_label);
}

TEST(EditMesh, SplitOfBoundaryEdgeMakesOneTriangle) {
  EditMesh mesh(3, Column<TriangleId, TriangleVertices>{{VertexId(0u), VertexId(1u), VertexId(2u)}}, Column<HalfedgeId, HalfedgeId>(3));
  const VertexId m = mesh.split(HalfedgeId(1u));
  EXPECT_EQ(mesh.triangles.size(), 2u);
  expect_sound(mesh);
  EXPECT_EQ(valence(mesh, m), 3);
  EXPECT_TRUE(mesh.is_edge(VertexId(0u), m));
}

TEST(EditMesh, CollapseUndoesSplitOfEdge) {
  EditMesh mesh = octahedron();
  const VertexId m = mesh.split(edge(mesh, k_east, k_north));
  mesh.collapse(edge(mesh, m, k_north));
  expect_sound(mesh);
  EXPECT_FALSE(mesh.outgoing[m].is_valid());
  EXPECT_EQ(std::ranges::count_if(mesh.triangles, [](const TriangleVertices& v) { return v[0].is_valid(); }), 8);
  EXPECT_TRUE(mesh.is_edge(k_east, k_north));
  EXPECT_EQ(valence(mesh, k_north), 4);
}

TEST(EditMesh, RotationChangesOnlyTheFirstCorner) {
  EditMesh mesh = octahedron();
  const TriangleId t(0u);
  mesh.rotate(t, 2);
  EXPECT_EQ(mesh.triangles[t], (TriangleVertices{k_top, k_east, k_north}));
  expect_sound(mesh);
  EXPECT_EQ(valence(mesh, k_west), 4);
}

}  // namespace
}  // namespace sterna
