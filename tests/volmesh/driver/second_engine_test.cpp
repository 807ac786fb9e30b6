// If two engines mesh the domain, the mesh that keeps the hard limits is used; walls of needles and structured walls through the whole pipeline.
#include "volmesh/second_engine.h"

#include <gmock/gmock.h>

#include <filesystem>
#include <fstream>
#include <numbers>
#include <utility>

#include "geom/tets/recover.h"
#include "tests/support/data.h"
#include "tests/support/tessellated_cad.h"
#include "tests/support/test_shapes.h"
#include "volmesh/volume_mesh.h"

namespace sterna::volmesh {
namespace {

using testing::HasSubstr;

constexpr double k_degree = std::numbers::pi / 180.0;

/// The boundary between a cube and a room around it.
FillBoundary cube_in_a_room() {
  FillBoundary boundary;
  const auto add = [&](const TriMesh& mesh, const Vec3& low, double side, bool is_turned) {
    const auto first = static_cast<std::uint32_t>(boundary.points.size());
    for (const Point& p : mesh.points) boundary.points.push_back(low + side * p);
    for (const TriangleVertices& t : mesh.triangles) {
      std::array<std::uint32_t, 3> corners{};
      for (std::size_t k = 0; k < 3; ++k) corners[k] = static_cast<std::uint32_t>(first + t[k].index());
      if (is_turned) std::swap(corners[1], corners[2]);
      boundary.triangles.push_back(corners);
    }
  };
  add(test::cube(8), {0, 0, 0}, 1.0, false);
  add(test::cube(4), {-3, -3, -3}, 7.0, true);
  return boundary;
}

/// Returns tetrahedra without points in the volume: flat and long.
TetraResult unrefined(const FillBoundary& boundary, std::string engine) {
  tets::Recovery recovery = tets::recover(boundary.points, boundary.triangles, {}, RunContext{});
  TetraResult result;
  result.engine = std::move(engine);
  result.tetrahedra = std::move(recovery.mesh.nodes);
  result.new_points.assign(recovery.mesh.points.begin() + static_cast<std::ptrdiff_t>(boundary.points.size()), recovery.mesh.points.end());
  return result;
}

SecondEngine second_for_cube() { return {.tetrahedra = {}, .sources = {}, .sizes = {}, .holes = {{0.5, 0.5, 0.5}}}; }

TEST(SecondEngine, TheBetterMeshIsKept) {
  const FillBoundary boundary = cube_in_a_room();
  const TetraBoundary domain{.points = boundary.points, .triangles = boundary.triangles, .hole_points = {}};
  for (const auto& [first, other] : {std::pair{"hxt", "sterna"}, std::pair{"sterna", "hxt"}}) {
    TetraResult tets = unrefined(boundary, first);
    const HardMisses before = hard_misses(domain, tets, {}, RunContext{});
    EXPECT_GT(before.n_angles, 0);
    EXPECT_GT(before.n_growth, 0);
    ImproveReport report;
    const std::string choice = choose_engine(boundary, second_for_cube(), {}, {}, tets, report, RunContext({.threads = 2}));
    EXPECT_THAT(choice, HasSubstr(std::string("kept ") + other));
    EXPECT_EQ(tets.engine, other);
    EXPECT_EQ(hard_misses(domain, tets, {}, RunContext{}).n(), 0);
    EXPECT_GT(report.min_angle_after, 5.0 * k_degree);
    EXPECT_TRUE(tets.is_reproducible);
  }
}

TEST(SecondEngine, RunsOnlyWhereNeededAndAllowed) {
  const FillBoundary boundary = cube_in_a_room();
  ImproveReport report;
  SecondEngine second = second_for_cube();
  TetraResult bad = unrefined(boundary, "hxt");
  EXPECT_EQ(choose_engine(boundary, second, {}, {"TetGen failed"}, bad, report, RunContext{}), "");
  second.tetrahedra.engine = "hxt";
  EXPECT_EQ(choose_engine(boundary, second, {}, {}, bad, report, RunContext{}), "");
  second.tetrahedra = {.try_other_engine = false};
  EXPECT_EQ(choose_engine(boundary, second, {}, {}, bad, report, RunContext{}), "");
  TetraResult good = unrefined(boundary, "hxt");
  choose_engine(boundary, second_for_cube(), {}, {}, good, report, RunContext{});
  EXPECT_EQ(choose_engine(boundary, second_for_cube(), {}, {}, good, report, RunContext{}), "");
}

TEST(SecondEngine, ACrashOfItsHelperIsReported) {
  const FillBoundary boundary = cube_in_a_room();
  const std::filesystem::path folder = test::scratch();
  std::ofstream(folder / "sterna-tet-hxt") << "#!/bin/sh\nkill -SEGV $$\n";
  std::filesystem::permissions(folder / "sterna-tet-hxt", std::filesystem::perms::owner_all);
  SecondEngine second = second_for_cube();
  second.tetrahedra.helper_folder = folder.string();
  TetraResult tets = unrefined(boundary, "sterna");
  const TetraResult before = tets;
  ImproveReport report;
  std::string log;
  const RunContext context({.threads = 1, .log = [&](LogLevel, std::string_view text) { log += std::string(text) + "\n"; }});
  EXPECT_THAT(choose_engine(boundary, second, {}, {}, tets, report, context), HasSubstr("hxt: no result; kept sterna"));
  EXPECT_THAT(log, HasSubstr("the helper died of signal 11"));
  EXPECT_EQ(tets.tetrahedra, before.tetrahedra);
}

VolumeMeshResult meshed(const TriMesh& wall, double farfield_radius, int threads, std::string engine, std::string& log) {
  MeshCase options;
  options.envelope.layers = 10;
  options.envelope.first_height = 1e-3;
  options.farfield.farfield_radius = farfield_radius;
  options.tetrahedra.engine = std::move(engine);
  return volume_mesh(wall, options, RunContext({.threads = threads, .log = [&](LogLevel, std::string_view text) { log += std::string(text) + "\n"; }}));
}

/// Issue 42, D5: smallest angle 0.06 degrees, ten seconds of improvement.
TEST(SecondEngine, StructuredWallsByTheOwnEngine) {
  std::string log;
  const VolumeMeshResult result = meshed(test::cube(30), 20.0, 2, "sterna", log);
  EXPECT_GT(result.improvement.min_angle_after, 11.0 * k_degree) << log;
  EXPECT_LT(result.improvement.max_angle_after, 165.0 * k_degree);
}

/// Issue 42, D16: nine in ten triangles are needles, on which all engines give poor tetrahedra.
TEST(SecondEngine, DrilledPlatesOfNeedles) {
  std::string log;
  const VolumeMeshResult result = meshed(test::drilled_plate(2, 1, 48, 0.6, 0.3), 10.0, 2, "automatic", log);
  EXPECT_TRUE(result.check.is_valid());
  EXPECT_THAT(result.tetra_choice, HasSubstr("kept ")) << log;
  EXPECT_THAT(log, HasSubstr("choice of the engine: " + result.tetra_choice));
}

}  // namespace
}  // namespace sterna::volmesh
