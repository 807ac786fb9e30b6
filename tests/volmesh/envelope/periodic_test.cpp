// Walls between two periodic planes: the layer is the same at both sides, to the bit.
#include "volmesh/envelope/periodic_growth.h"

#include <gtest/gtest.h>

#include "tests/support/test_constants.h"
#include "tests/support/test_shapes.h"
#include "volmesh/envelope/build_envelope.h"
#include "volmesh/envelope/constrain_borders.h"
#include "volmesh/envelope/untangle.h"
#include "volmesh/envelope/validity.h"

namespace sterna::volmesh {
namespace {

using test::k_context;

/// A square bar of side 1 along y from 0 to `length`, open at its ends, n edges per side and `m` along it; normals outwards.
TriMesh bar(std::uint32_t n, std::uint32_t m, double length) {
  TriMesh mesh;
  const PatchId patch = mesh.patches.push_back({"bar", PatchKind::wall});
  for (std::uint32_t j = 0; j <= m; ++j)
    for (std::uint32_t i = 0; i < 4 * n; ++i) {
      const double t = static_cast<double>(i % n) / n;
      const double y = length * j / m;
      const std::array<Point, 4> side = {{{t, y, 0}, {1, y, t}, {1 - t, y, 1}, {0, y, 1 - t}}};
      mesh.points.push_back(side[i / n]);
    }
  for (std::uint32_t j = 0; j < m; ++j)
    for (std::uint32_t i = 0; i < 4 * n; ++i) {
      const std::uint32_t k = (i + 1) % (4 * n), a = 4 * n * j + i, b = 4 * n * j + k, c = b + 4 * n, d = a + 4 * n;
      mesh.triangles.push_back({VertexId(a), VertexId(b), VertexId(c)});
      mesh.triangles.push_back({VertexId(a), VertexId(c), VertexId(d)});
    }
  mesh.triangle_patch.assign(mesh.n_triangles(), patch);
  return mesh;
}

using Partners = std::vector<std::array<VertexId, 2>>;

/// Returns the pairs of vertices at both ends of a bar.
Partners ends_of_bar(std::uint32_t n, std::uint32_t m) {
  Partners partners;
  for (std::uint32_t i = 0; i < 4 * n; ++i) partners.push_back({VertexId(i), VertexId(4 * n * m + i)});
  return partners;
}

LayerBase base_between_planes(const TriMesh& wall, double length, const Partners& partners) {
  const std::array<ConstraintPlane, 2> planes = {ConstraintPlane({0, 0, 0}, {0, 1, 0}), ConstraintPlane({0, length, 0}, {0, -1, 0})};
  LayerBase base(wall, k_context, constraints_of_planes(wall, Topology(wall, k_context), planes));
  base.let_grow_alike(partners);
  return base;
}

EnvelopeOptions fifteen_layers() {
  EnvelopeOptions options;
  options.first_height = 1e-4;
  options.layers = 15;
  options.max_thickness = 0.2;
  return options;
}

TEST(Periodic, PartnersHaveNormalsAndEdgesOfAllTriangles) {
  TriMesh wall = bar(6, 10, 2.0);
  // One end is widened like a funnel and has longer triangles.
  for (Point& p : wall.points)
    if (p.y > 1.5) p = Vec3{0.5 + (p.x - 0.5) * (1.0 + 0.5 * (2.0 - p.y)), p.y, 0.5 + (p.z - 0.5) * (1.0 + 0.5 * (2.0 - p.y))};
  const Partners partners = ends_of_bar(6, 10);
  const LayerBase alone = base_between_planes(wall, 2.0, {}), base = base_between_planes(wall, 2.0, partners);
  EXPECT_TRUE(alone.groups.empty());
  EXPECT_EQ(base.groups.size(), 24u);
  for (const auto& [a, b] : partners) {
    EXPECT_EQ(base.vertex_normal[a], base.vertex_normal[b]);
    EXPECT_EQ(base.visible_direction[a], base.visible_direction[b]);
    EXPECT_EQ(base.visibility[a], base.visibility[b]);
    EXPECT_EQ(base.mean_edge[a], base.mean_edge[b]);
    EXPECT_GT(base.mean_edge[a], std::min(alone.mean_edge[a], alone.mean_edge[b]));
    EXPECT_LT(base.mean_edge[a], std::max(alone.mean_edge[a], alone.mean_edge[b]));
    EXPECT_LE(base.visibility[a], std::min(alone.visibility[a], alone.visibility[b]) + 1e-12);
    std::vector<VertexId> alike;
    for_each_alike(base, b, [&](VertexId v) { alike.push_back(v); });
    EXPECT_EQ(alike, (std::vector<VertexId>{a, b}));
  }
  for (const VertexId v : wall.points.ids()) {
    if (base.group[v] == LayerBase::k_no_group) {
      EXPECT_EQ(base.vertex_normal[v], alone.vertex_normal[v]);
    }
  }
}

TEST(Periodic, PairsInTwoDirectionsMakeOneGroup) {
  const TriMesh wall = bar(6, 10, 2.0);
  const VertexId a(0u), b(5u), c(7u), d(9u);
  LayerBase base(
      wall, k_context,
      constraints_of_planes(wall, Topology(wall, k_context), std::array{ConstraintPlane({0, 0, 0}, {0, 1, 0}), ConstraintPlane({0, 2, 0}, {0, -1, 0})}));
  base.let_grow_alike({{a, b}, {c, d}, {b, d}});
  ASSERT_EQ(base.groups.size(), 1u);
  EXPECT_EQ(base.groups[0], (std::vector<VertexId>{a, b, c, d}));
}

TEST(Periodic, PartnersHaveEqualHeightsAndDirections) {
  // A box beside one end only: the layer there is lower and leans.
  TriMesh wall = bar(6, 10, 2.0);
  TriMesh pod = test::cube(6);
  for (Point& p : pod.points) p = Vec3{1.13, 0.05, 0.3} + 0.4 * p;
  append(wall, pod);
  const Partners partners = ends_of_bar(6, 10);
  const LayerBase base = base_between_planes(wall, 2.0, partners);
  const EnvelopeOptions options = fifteen_layers();
  Collider collider(base, nullptr, k_context);
  Envelope envelope = build_envelope(base, options, k_context);
  ASSERT_TRUE(invalid_macros(base, envelope, k_context).empty());
  std::size_t n_different = 0;
  for (const auto& [a, b] : partners) n_different += envelope.height[a] != envelope.height[b] || envelope.direction[a] != envelope.direction[b];
  EXPECT_GT(n_different, 3u);
  const EnvelopeShape before = envelope;
  const std::vector<VertexId> changed = equalise_partners(base, options, &collider, envelope, k_context);
  EXPECT_FALSE(changed.empty());
  std::size_t n_standing = 0;
  for (const auto& [a, b] : partners) {
    EXPECT_EQ(envelope.height[a], envelope.height[b]);
    EXPECT_EQ(envelope.direction[a], envelope.direction[b]);
    EXPECT_EQ(envelope.direction[a].y, 0.0);
    n_standing += !envelope.is_collapsed(a);
  }
  EXPECT_EQ(n_standing, partners.size());
  for (const VertexId v : wall.points.ids()) EXPECT_LE(envelope.height[v], before.height[v]);
  EXPECT_TRUE(invalid_macros(base, envelope, k_context).empty());
  collider.move_top(envelope, k_context);
  EXPECT_TRUE(collider.crossings(k_context).empty());
  // A second call changes nothing.
  EXPECT_TRUE(equalise_partners(base, options, &collider, envelope, k_context).empty());
}

TEST(Periodic, OneCollapsedPartnerCollapsesTheOther) {
  const TriMesh wall = bar(6, 10, 2.0);
  const Partners partners = ends_of_bar(6, 10);
  const LayerBase base = base_between_planes(wall, 2.0, partners);
  const EnvelopeOptions options = fifteen_layers();
  Envelope envelope = build_envelope(base, options, k_context);
  lower(envelope, partners[4][1], 0.0, HeightLimit::gap, scale_of(base, options));
  unwarp(base, options, HeightLimit::warp, envelope, k_context);
  equalise_partners(base, options, nullptr, envelope, k_context);
  EXPECT_TRUE(envelope.is_collapsed(partners[4][0]));
  for (const auto& [a, b] : partners) EXPECT_EQ(envelope.height[a], envelope.height[b]);
  EXPECT_TRUE(invalid_macros(base, envelope, k_context).empty());
}

TEST(Periodic, SameBytesForAnyNumberOfThreads) {
  const TriMesh wall = bar(6, 10, 2.0);
  const Partners partners = ends_of_bar(6, 10);
  const LayerBase base = base_between_planes(wall, 2.0, partners);
  const Envelope start = build_envelope(base, fifteen_layers(), k_context);
  std::vector<Envelope> results;
  for (const int threads : {1, 2, 7}) {
    results.push_back(start);
    Envelope& envelope = results.back();
    lower(envelope, partners[7][0], 0.5 * envelope.height[partners[7][0]], HeightLimit::gap, scale_of(base, fifteen_layers()));
    equalise_partners(base, fifteen_layers(), nullptr, envelope, RunContext({.threads = threads}));
  }
  for (const Envelope& envelope : results) {
    EXPECT_EQ(envelope.height, results[0].height);
    EXPECT_EQ(envelope.direction, results[0].direction);
  }
}

}  // namespace
}  // namespace sterna::volmesh
