#include "geom/mesh/edit_mesh.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <random>
#include <vector>

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

/// Returns the twins of half-edges without those of the last triangle.
Column<HalfedgeId, HalfedgeId> without_last(const Column<HalfedgeId, HalfedgeId>& twins) {
  Column<HalfedgeId, HalfedgeId> left = twins;
  left.resize(twins.size() - 3);
  for (HalfedgeId& twin : left)
    if (twin.is_valid() && twin.index() >= left.size()) twin = {};
  return left;
}

/// Returns vertices minus edges plus triangles.
std::int64_t euler_characteristic(const EditMesh& mesh) {
  std::int64_t sum = std::ranges::count_if(mesh.outgoing, [](HalfedgeId h) { return h.is_valid(); });
  for (const HalfedgeId h : mesh.twins.ids())
    if (!mesh.is_removed(triangle_of(h)) && !(mesh.twins[h] < h)) --sum;
  return sum + std::ranges::count_if(mesh.triangles, [](const TriangleVertices& v) { return v[0].is_valid(); });
}

/// Returns true if the edge of `h` is inside the surface, at most one of its ends is on the boundary, and its ends have only two common neighbours.
bool may_collapse(const EditMesh& mesh, HalfedgeId h) {
  std::vector<VertexId> around;
  std::array<bool, 2> is_at_boundary{};
  for (const std::size_t i : {0, 1}) {
    const VertexId v = i == 0 ? mesh.from(h) : mesh.to(h);
    mesh.for_out(v, [&](HalfedgeId e) { is_at_boundary[i] = is_at_boundary[i] || !mesh.twins[e].is_valid() || !mesh.twins[previous(e)].is_valid(); });
    mesh.for_ring(v, [&](VertexId w) { around.push_back(w); });
  }
  std::ranges::sort(around);
  std::size_t n_common = 0;
  for (std::size_t i = 0; i + 1 < around.size(); ++i) n_common += around[i] == around[i + 1] ? 1 : 0;
  return mesh.twins[h].is_valid() && !(is_at_boundary[0] && is_at_boundary[1]) && n_common == 2;
}

/// Splits, flips and collapses edges at random. Never collapses if only a few vertices are left.
void change(EditMesh& mesh, std::mt19937& random) {
  const HalfedgeId h(static_cast<std::uint64_t>(random() % mesh.twins.size())), o = mesh.twins[h];
  if (mesh.is_removed(triangle_of(h))) return;
  const auto n_vertices = std::ranges::count_if(mesh.outgoing, [](HalfedgeId e) { return e.is_valid(); });
  switch (random() % 4) {
    case 0: mesh.split(h); break;
    case 1: mesh.rotate(triangle_of(h), static_cast<int>(random() % 3)); break;
    case 2:
      if (!o.is_valid() || mesh.apex(h) == mesh.apex(o) || mesh.is_edge(mesh.apex(h), mesh.apex(o))) break;
      mesh.flip(h, {mesh.from(h), mesh.apex(o), mesh.apex(h)}, {mesh.apex(o), mesh.to(h), mesh.apex(h)});
      break;
    default:
      if (n_vertices > 6 && may_collapse(mesh, h)) mesh.collapse(h);
  }
}

TEST(EditMesh, RandomChangesKeepClosedAndOpenSurfacesSound) {
  for (const bool is_open : {false, true}) {
    EditMesh mesh = octahedron();
    if (is_open)
      mesh = EditMesh(6, Column<TriangleId, TriangleVertices>(std::vector(mesh.triangles.begin(), mesh.triangles.end() - 1)), without_last(mesh.twins));
    std::mt19937 random(11);
    for (int n = 0; n < 1500; ++n) {
      change(mesh, random);
      if (n % 10 == 0) expect_sound(mesh);
      ASSERT_EQ(euler_characteristic(mesh), is_open ? 1 : 2) << n;
    }
  }
}

}  // namespace
}  // namespace sterna
