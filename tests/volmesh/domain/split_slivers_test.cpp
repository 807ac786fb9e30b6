// Needles and caps (sliver triangles) of given walls, flipped and split before the layer is made.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <memory>
#include <vector>

#include "geom/math/measures.h"
#include "geom/mesh/topology.h"
#include "tests/support/test_constants.h"
#include "tests/support/test_shapes.h"
#include "tests/volmesh/domain/long_strips.h"
#include "tests/volmesh/domain/room.h"
#include "volmesh/domain/split_slivers.h"
#include "volmesh/layer_domain/layer_domain.h"
#include "volmesh/parts/joint_envelope.h"
#include "volmesh/stages.h"
#include "volmesh/volume_mesh.h"

namespace sterna::volmesh {
namespace {

using test::k_context;
using test::k_degree;

const SliverOptions k_rich = {.needle_budget = 50.0};

Column<PatchId, std::uint8_t> all_layered(const TriMesh& mesh) { return Column<PatchId, std::uint8_t>(mesh.patches.size(), 1); }

double smallest_angle(const TriMesh& mesh, TriangleId t) {
  const auto [a, b, c] = corners(mesh, t);
  return std::min({corner_angle(a, b, c), corner_angle(b, c, a), corner_angle(c, a, b)});
}

std::int64_t slivers_below(const TriMesh& mesh, double angle) {
  std::int64_t n = 0;
  for (const TriangleId t : mesh.triangles.ids()) n += smallest_angle(mesh, t) < angle ? 1 : 0;
  return n;
}

std::vector<double> patch_areas(const TriMesh& mesh) {
  std::vector<double> areas(mesh.patches.size(), 0.0);
  for (const TriangleId t : mesh.triangles.ids()) {
    const auto [a, b, c] = corners(mesh, t);
    areas[mesh.triangle_patch[t].index()] += triangle_area(a, b, c);
  }
  return areas;
}

/// Expects a closed, manifold mesh of the same body with the same patches.
void expect_same_body(const TriMesh& split, const TriMesh& given) {
  EXPECT_EQ(Topology(split, k_context).n_boundary_halfedges(), 0u);
  EXPECT_NEAR(test::volume_of(split), test::volume_of(given), 1e-12 * test::volume_of(given));
  const std::vector<double> areas = patch_areas(split), given_areas = patch_areas(given);
  ASSERT_EQ(areas.size(), given_areas.size());
  for (std::size_t p = 0; p < areas.size(); ++p) EXPECT_NEAR(areas[p], given_areas[p], 1e-12 * given_areas[p]);
  for (const VertexId v : given.points.ids()) ASSERT_EQ(split.points[v], given.points[v]);
}

/// Expects that new corners are at the positions given by their weights in the source triangle.
void expect_weights(const TriMesh& split, const TriMesh& given, const SliverSplits& splits) {
  ASSERT_EQ(splits.sources.size(), split.n_triangles());
  std::int64_t n_known = 0;
  for (const TriangleId t : split.triangles.ids()) {
    EXPECT_EQ(split.triangle_patch[t], given.triangle_patch[splits.sources[t]]);
    if (splits.weights[t] == CornerWeights{}) continue;
    ++n_known;
    const auto of_given = corners(given, splits.sources[t]);
    for (std::size_t k = 0; k < 3; ++k) {
      Point p;
      for (std::size_t j = 0; j < 3; ++j) p += splits.weights[t][k][j] * of_given[j];
      EXPECT_NEAR(distance(p, split.points[split.triangles[t][k]]), 0.0, 1e-14);
    }
  }
  EXPECT_GT(n_known, 0);
}

/// A cube with points close to edges inside its faces, which makes caps.
TriMesh cube_with_caps() {
  const TriMesh cube = test::cube(4);
  const Topology topology(cube, k_context);
  TriMesh mesh = cube;
  for (const TriangleId t : cube.triangles.ids()) {
    if (t.index() % 5 != 0) continue;
    for (int k = 0; k < 3; ++k) {
      const HalfedgeId h = halfedge(t, k);
      const auto [a, b, c] = corners(cube, t);
      const auto [d, e, f] = corners(cube, triangle_of(topology.twin(h)));
      if (dot(normalized(area_vector(a, b, c)), normalized(area_vector(d, e, f))) < 0.9) continue;
      const TriangleVertices v = cube.triangles[t];
      const VertexId from = topology.from(h), to = topology.to(h), other = v[static_cast<std::size_t>((k + 2) % 3)];
      const VertexId p = mesh.points.push_back(0.4875 * cube.points[from] + 0.4875 * cube.points[to] + 0.025 * cube.points[other]);
      mesh.triangles[t] = {from, to, p};
      for (const auto& [x, y] : {std::pair{to, other}, std::pair{other, from}}) {
        mesh.triangles.push_back({x, y, p});
        mesh.triangle_patch.push_back(mesh.triangle_patch[t]);
      }
      break;
    }
  }
  return mesh;
}

TEST(SplitNeedles, CapsOfFlatWallsAreFlippedAway) {
  const TriMesh given = cube_with_caps();
  ASSERT_GT(slivers_below(given, 5 * k_degree), 10);
  TriMesh split = given;
  const SliverSplits splits = split_slivers(split, all_layered(given), {.needle_budget = 0.0}, k_context);
  expect_same_body(split, given);
  EXPECT_EQ(split.n_triangles(), given.n_triangles());
  EXPECT_EQ(slivers_below(split, 5 * k_degree), 0);
  EXPECT_EQ(splits.report.n_slivers, slivers_below(given, 5 * k_degree));
  EXPECT_EQ(splits.report.n_left, 0);
  EXPECT_FALSE(splits.report.is_over_budget);
}

TEST(SplitNeedles, LongStripsBetweenCreasesAreSplitCompletely) {
  const TriMesh given = long_strips(48, 20.0);
  ASSERT_EQ(slivers_below(given, 5 * k_degree), 96);
  TriMesh split = given;
  const SliverSplits splits = split_slivers(split, all_layered(given), k_rich, k_context);
  expect_same_body(split, given);
  expect_weights(split, given, splits);
  EXPECT_EQ(slivers_below(split, 5 * k_degree), 0);
  EXPECT_EQ(splits.report.n_left, 0);
  EXPECT_EQ(splits.report.n_triangles, static_cast<std::int64_t>(split.n_triangles()));
  // Pieces of 20 m / 16 and strips of 0.13 m have 6 degrees; the factor of 2 allows for pieces of different levels.
  EXPECT_LT(split.n_triangles(), 2u * 16u * 96u);
}

TEST(SplitNeedles, BudgetIsKeptAndRemainderIsReported) {
  const TriMesh given = long_strips(48, 20.0);
  TriMesh split = given;
  const SliverSplits splits = split_slivers(split, all_layered(given), {.needle_budget = 0.5}, k_context);
  expect_same_body(split, given);
  EXPECT_LE(split.n_triangles(), given.n_triangles() * 3 / 2);
  EXPECT_EQ(splits.report.n_left, slivers_below(split, 5 * k_degree));
  EXPECT_GT(splits.report.n_left, 0);
}

TEST(SplitNeedles, NeverMakesAWallWorse) {
  for (const double length : {3.0, 20.0, 300.0, 1e4}) {
    SCOPED_TRACE(length);
    const TriMesh given = long_strips(24, length);
    for (const double budget : {0.0, 0.3, 1.0, 50.0}) {
      TriMesh split = given;
      split_slivers(split, all_layered(given), {.needle_budget = budget}, k_context);
      expect_same_body(split, given);
      double sum = 0.0, given_sum = 0.0;
      for (const TriangleId t : split.triangles.ids())
        if (smallest_angle(split, t) < 5 * k_degree) sum += 1.0 / smallest_angle(split, t);
      for (const TriangleId t : given.triangles.ids())
        if (smallest_angle(given, t) < 5 * k_degree) given_sum += 1.0 / smallest_angle(given, t);
      EXPECT_LE(sum, 1.001 * given_sum);
    }
  }
}

TEST(SplitNeedles, WithoutNeedlesAndWithoutLeaveNothingChanges) {
  const TriMesh sphere = test::sphere(6), strips = long_strips(48, 20.0);
  const auto expect_unchanged = [](const TriMesh& given, const SliverOptions& options) {
    TriMesh split = given;
    const SliverSplits splits = split_slivers(split, all_layered(given), options, k_context);
    EXPECT_FALSE(splits.report.has_changed());
    EXPECT_TRUE(splits.sources.empty());
    EXPECT_EQ(split.triangles, given.triangles);
    EXPECT_EQ(split.points, given.points);
  };
  expect_unchanged(sphere, {});
  expect_unchanged(strips, {.split_needles = 0.0});
  expect_unchanged(strips, {.needle_budget = 50.0, .flip_angle = 0.0});
  expect_unchanged(long_strips(24, 1e4), k_rich);  // a thousand pieces each: beyond the limit
}

TEST(SplitNeedles, PatchesWithoutLayersAndRimsDoNotChange) {
  TriMesh given = long_strips(48, 20.0);
  const PatchId slip = given.patches.push_back({"slip", PatchKind::slip});
  for (const TriangleId t : given.triangles.ids()) {
    const auto [a, b, c] = corners(given, t);
    if (given.triangle_patch[t] == PatchId(0) && (a + b + c).x > 0.0) given.triangle_patch[t] = slip;
  }
  Column<PatchId, std::uint8_t> has_layer = all_layered(given);
  has_layer[slip] = 0;
  TriMesh split = given;
  split_slivers(split, has_layer, k_rich, k_context);
  expect_same_body(split, given);
  EXPECT_GT(split.n_triangles(), given.n_triangles());
  const auto triangles_of = [&](const TriMesh& mesh) {
    std::vector<TriangleVertices> list;
    for (const TriangleId t : mesh.triangles.ids())
      if (mesh.triangle_patch[t] == slip) list.push_back(mesh.triangles[t]);
    return list;
  };
  EXPECT_EQ(triangles_of(split), triangles_of(given));
}

TEST(SplitNeedles, TheSameBytesForAnyNumberOfThreads) {
  const TriMesh given = long_strips(48, 20.0);
  TriMesh first = given;
  split_slivers(first, all_layered(given), k_rich, RunContext({.threads = 1}));
  for (const int threads : {2, 7}) {
    TriMesh split = given;
    split_slivers(split, all_layered(given), k_rich, RunContext({.threads = threads}));
    EXPECT_EQ(split.triangles, first.triangles);
    EXPECT_EQ(split.points, first.points);
    EXPECT_EQ(split.triangle_patch, first.triangle_patch);
  }
}

TEST(SplitNeedles, MeshesHaveFinerWallAlsoByManualSteps) {
  const TriMesh wall = long_strips(24, 6.0);
  MeshCase options = layers(6, 1e-3);
  options.farfield.farfield_radius = 60.0;
  options.needles = k_rich;
  const VolumeMeshResult whole = volume_mesh(wall, options, k_context);
  EXPECT_TRUE(whole.check.is_valid());
  EXPECT_EQ(whole.slivers.n_slivers, 48);
  EXPECT_EQ(whole.slivers.n_left, 0);
  EXPECT_GE(whole.mesh.layers.n_columns(), static_cast<std::size_t>(whole.slivers.n_triangles));  // more if an engine splits triangles
  EXPECT_GT(whole.slivers.n_triangles, static_cast<std::int64_t>(wall.n_triangles()));

  const EnvelopeStage envelope = make_envelope(wall, options, {}, k_context);
  const VolumeMeshResult by_hand = finish_mesh(wall, make_tetrahedra(wall, envelope, options, {}, k_context), options, k_context);
  EXPECT_EQ(by_hand.mesh.points, whole.mesh.points);
  EXPECT_EQ(by_hand.mesh.tetrahedra, whole.mesh.tetrahedra);
  EXPECT_EQ(by_hand.slivers, whole.slivers);
}

TEST(SplitNeedles, HalfModelsKeepTheirRims) {
  const TriMesh wall = long_strips(24, 6.0, true);
  MeshCase options = layers(6, 1e-3);
  options.needles = k_rich;
  const VolumeMeshResult result = volume_mesh(wall, options, k_context);
  EXPECT_TRUE(result.check.is_valid());
  EXPECT_GT(result.slivers.n_triangles, result.slivers.n_given);
  EXPECT_EQ(border_edges(result), (Edges{{"symmetry", 24}}));
}

TEST(SplitNeedles, PartsWithChangedWallAreMadeInPlace) {
  TriMesh surface = test::sphere(6);
  for (Point& p : surface.points) p.x += 10.0;
  const auto sphere = std::make_shared<const TriMesh>(surface), strips = std::make_shared<const TriMesh>(long_strips(24, 6.0));
  const auto n_vertices = static_cast<std::uint32_t>(surface.n_vertices()), n_triangles = static_cast<std::uint32_t>(surface.n_triangles());
  append(surface, *strips);
  MeshCase options = layers(6, 1e-3);
  options.needles = k_rich;
  options.parts = {{.own = sphere}, {.own = strips, .first_triangle = n_triangles, .first_vertex = n_vertices}};
  const LayerDomain layer_domain(surface, options, k_context);
  const std::vector<WholePart> parts = whole_parts(layer_domain.domain, layer_domain.options.parts, k_context);
  ASSERT_EQ(parts.size(), 1u);
  EXPECT_EQ(parts[0].part, 0u);
  EXPECT_TRUE(volume_mesh(surface, options, k_context).check.is_valid());
}

}  // namespace
}  // namespace sterna::volmesh
