// Number, growth and total height of layers, each derived from the others, and members of a mesh family.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <functional>

#include "geom/base/error.h"
#include "tests/support/test_shapes.h"
#include "volmesh/case/growth_law.h"
#include "volmesh/case/layer_choice.h"
#include "volmesh/volume_mesh.h"

namespace sterna::volmesh {
namespace {

std::string message_of(const std::function<void()>& work) {
  try {
    work();
  } catch (const Error& error) {
    return error.what();
  }
  return "no error";
}

TEST(SolveLayers, TheFewestLayersThatReachTheHeight) {
  for (const double growth : {1.0, 1.1, 1.2, 1.4}) {
    const EnvelopeOptions requested{.layers = 30, .first_height = 1e-4, .max_growth = growth, .total_height = 0.01};
    const int n = solve_layers(requested, "layers", "walls").layers;
    EXPECT_GE(layer_height(1e-4, growth, n), 0.01 * (1 - 1e-9)) << growth;
    EXPECT_LT(layer_height(1e-4, growth, n - 1), 0.01) << growth;
  }
}

TEST(SolveLayers, TheGrowthThatReachesTheHeight) {
  const EnvelopeOptions solved = solve_layers({.layers = 25, .first_height = 2e-5, .max_growth = 9.0, .total_height = 0.01}, "max_growth", "walls");
  EXPECT_NEAR(layer_height(2e-5, solved.max_growth, 25), 0.01, 1e-12);
}

TEST(SolveLayers, RefusesWhatCannotBe) {
  const EnvelopeOptions requested{.layers = 10, .first_height = 1e-4, .max_growth = 1.2, .total_height = 0.05};
  EXPECT_THAT(message_of([&] { solve_layers(requested, "none", "patch wing"); }),
              testing::AllOf(testing::HasSubstr("patch wing"), testing::HasSubstr("needs a growth of"), testing::HasSubstr("26 layers are enough")));
  EXPECT_THAT(message_of([] { solve_layers({.layers = 10, .first_height = 1e-2, .max_growth = 1.2, .total_height = 0.05}, "max_growth", "walls"); }),
              testing::HasSubstr("give at most 5 layers"));
  EXPECT_THAT(message_of([] { solve_layers({.layers = 10, .first_height = 1e-1, .max_growth = 1.2, .total_height = 0.05}, "layers", "walls"); }),
              testing::HasSubstr("no room for one layer"));
  EXPECT_THAT(message_of([] { solve_layers({.layers = 3, .first_height = 1e-6, .max_growth = 1.2, .total_height = 0.05}, "max_growth", "walls"); }),
              testing::HasSubstr("give more layers"));
  EXPECT_THAT(message_of([] { solved_for(true, true, true, "volume_mesh"); }), testing::HasSubstr("cannot all be given"));
  EXPECT_THAT(message_of([] { solved_for(false, false, true, "volume_mesh"); }), testing::HasSubstr("needs layers or max_growth"));
  EXPECT_EQ(solved_for(true, false, true, ""), "max_growth");
  EXPECT_EQ(solved_for(false, true, true, ""), "layers");
  EXPECT_EQ(solved_for(true, true, false, ""), "none");
}

TEST(Refined, FirstHeightGrowthAndLayersAreExact) {
  MeshCase medium;
  medium.envelope.layers = 30;
  medium.envelope.first_height = 1e-4;
  medium.envelope.max_growth = 1.3;
  medium.farfield.farfield_sides = parse_sides("x_min=inflow x_max=outflow,edge:0.5");
  medium.patches = {{.names = "a", .options = {{"layers", 20}, {"first_height", 1e-3}, {"max_growth", 1.2}, {"total_height", 0.1}}}, {.names = "b"}};
  medium.size.size_max = 3.0;
  medium.sources = {{.size = 0.1}};
  medium.discs = {{.radius = 1.2}};
  medium.family.refinement = 1.5;
  const MeshCase fine = refined(medium);
  EXPECT_EQ(fine.envelope.layers, 45);
  EXPECT_DOUBLE_EQ(fine.envelope.first_height, 1e-4 / 1.5);
  EXPECT_DOUBLE_EQ(std::pow(fine.envelope.max_growth, 1.5), 1.3);
  EXPECT_EQ(value_or(fine.patches[0], "layers", 0), 30);
  EXPECT_DOUBLE_EQ(value_or(fine.patches[0], "first_height", 0.0), 1e-3 / 1.5);
  EXPECT_EQ(value_or(fine.patches[0], "total_height", 0.0), 0.1);
  EXPECT_TRUE(fine.patches[1].options.empty());
  EXPECT_DOUBLE_EQ(fine.size.size_max, 2.0);
  EXPECT_DOUBLE_EQ(fine.size.size_growth, 1.0 + 0.3 / 1.5);
  EXPECT_DOUBLE_EQ(fine.sources[0].size, 0.1 / 1.5);
  EXPECT_DOUBLE_EQ(fine.discs[0].edge, 0.1 / 1.5);
  EXPECT_EQ(fine.farfield.farfield_sides[1].edge, 0.5 / 1.5);
  // The heights of every k-th cell boundary nearly coincide: both laws are samples of one exponential.
  EXPECT_NEAR(layer_height(1e-4 / 1.5, fine.envelope.max_growth, 45) / layer_height(1e-4, 1.3, 30), 1.0, 0.06);
}

/// Makes a member of a family; its wall has edges of about 1/frequency.
VolumeMeshResult member(int frequency, double f, const MeshCase& medium) {
  MeshCase options = medium;
  options.family.refinement = f;
  return volume_mesh(test::sphere(frequency), options, RunContext({.threads = 2}));
}

TEST(Refined, NodesGrowWithTheThirdPower) {
  MeshCase medium;
  medium.envelope.layers = 8;
  medium.envelope.first_height = 0.01;
  medium.envelope.max_growth = 1.3;
  medium.farfield.farfield_radius = 12.0;
  const VolumeMeshResult coarse = member(5, 0.5, medium), fine = member(10, 1.0, medium);
  const double ratio = static_cast<double>(fine.mesh.points.size()) / static_cast<double>(coarse.mesh.points.size());
  EXPECT_GT(ratio, 8.0 * 0.75);  // coarse meshes have fewer tetrahedra than their sizes imply: only a few edges from wall to farfield
  EXPECT_LT(ratio, 8.0 * 1.25);
  EXPECT_EQ(coarse.mesh.layers.n_layers * 2, fine.mesh.layers.n_layers);
}

TEST(TotalHeight, IsMetWhereSpaceIsFree) {
  const TriMesh wall = test::sphere(8);
  MeshCase options;
  options.envelope.layers = 12;
  options.envelope.first_height = 0.004;
  options.envelope.total_height = 0.12;
  options.envelope.solve_for = "max_growth";
  std::string log;
  const RunContext context({.threads = 2, .log = [&](LogLevel, std::string_view line) { log += std::string(line) + "\n"; }});
  const VolumeMeshResult result = volume_mesh(wall, options, context);
  EXPECT_NEAR(result.layer.mean_height, 0.12, 0.12 * 0.02);  // on chords of a sphere: the planes of the facets are a little lower
  EXPECT_GT(result.layer.coverage, 0.99);
  EXPECT_THAT(log, testing::HasSubstr("12 layers grow by 1.155 "));
}

TEST(TotalHeight, OfAPatchAlone) {
  TriMesh wall = test::sphere(8);
  wall.patches.push_back({"north", PatchKind::wall});
  for (const TriangleId t : wall.triangles.ids())
    if (wall.points[wall.triangles[t][0]].z > 0.0) wall.triangle_patch[t] = PatchId(wall.patches.size() - 1);
  MeshCase options;
  options.envelope.layers = 10;
  options.envelope.first_height = 0.004;
  options.envelope.max_growth = 1.1;
  options.patches = {{.names = "north", .options = {{"total_height", 0.15}, {"blend", 0.3}}}};
  const EnvelopeOptions& e = options.envelope;
  const Column<PatchId, double> tallest = [&] {
    const VolumeMeshResult result = volume_mesh(wall, options, RunContext({.threads = 2}));
    Column<PatchId, double> heights(result.mesh.patches.size(), 0.0);
    for (std::uint32_t line = 0; line < result.mesh.layers.n_lines(); ++line) {
      const Point top = result.mesh.points[result.mesh.layers.top(line)];
      const Point base_point = wall.points[VertexId(line)];
      double& height = heights[PatchId(base_point.z > 0.3 ? 1 : 0)];
      if (std::abs(base_point.z) > 0.9) height = std::max(height, distance(top, base_point));
    }
    return heights;
  }();
  EXPECT_NEAR(tallest[PatchId(1)], 0.15, 0.07 * 0.15);  // if heights vary, smoothing may lower them to height_floor
  EXPECT_NEAR(tallest[PatchId(0)], layer_height(e.first_height, 1.1, 10), 0.003);
}

}  // namespace
}  // namespace sterna::volmesh
