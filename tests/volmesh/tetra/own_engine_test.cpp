// engine = "sterna": our own recovery and refinement, and the steps after a failure of either.
#include <gmock/gmock.h>

#include <filesystem>
#include <fstream>

#include "tests/support/data.h"
#include "tests/support/test_shapes.h"
#include "tests/volmesh/tetra/cases.h"
#include "volmesh/tetra/engine_process.h"
#include "volmesh/tetra/size_field.h"

namespace sterna::volmesh {
namespace {

using test::both;
using test::Domain;
using test::domain_around;
using test::error_info_of;
using test::expect_tiling;
using test::inside_out;
using test::proof_of_another_boundary;
using test::transformed;
using testing::ElementsAre;
using testing::HasSubstr;
using testing::IsEmpty;

class OwnEngine : public testing::Test {
 protected:
  TetraResult fill(const Domain& domain, TetraOptions options = {}, const std::vector<SizeSource>& sources = {}) {
    options.engine = "sterna";
    const RunContext context({.log = [this](LogLevel level, std::string_view text) {
      if (level == LogLevel::warning) warnings_.emplace_back(text);
    }});
    const SizeField sizes = build_size_field(domain.boundary(), sources, {}, context);
    return volmesh::fill(domain.boundary(), &sizes, options, context);
  }
  /// Returns a folder of helpers in which the given ones are scripts that crash and the others are the real ones.
  static std::string folder_where_crashes(const std::vector<std::string>& which) {
    const std::filesystem::path folder = test::scratch();
    for (const std::string name : {"sterna-tet-hxt", "sterna-tet-tetgen"}) {
      if (std::ranges::find(which, name) == which.end()) {
        std::filesystem::create_symlink(find_helper(name, {}), folder / name);
        continue;
      }
      std::ofstream(folder / name) << "#!/bin/sh\nkill -SEGV $$\n";
      std::filesystem::permissions(folder / name, std::filesystem::perms::owner_all);
    }
    return folder.string();
  }
  std::vector<std::string> warnings_;
};

TEST_F(OwnEngine, FillsAroundBodies) {
  const TriMesh wall = both(test::cube(4), transformed(test::sphere(4), 0.5, {3, 0, 0}));
  const Domain domain = domain_around(both(wall, transformed(test::cube(1), 0.25, {1.0001, 0.3, 0.3})));  // a gap of 1e-4
  const TetraResult result = fill(domain, {.try_other_engine = false});
  expect_tiling(domain, result);
  EXPECT_EQ(result.engine, "sterna");
  EXPECT_THAT(result.failures, IsEmpty());
  EXPECT_GT(result.engine_seconds, 0.0);
}

TEST_F(OwnEngine, FillsTwoRegionsOneInsideTheOther) {
  const TriMesh wall = both(both(test::sphere(5), inside_out(transformed(test::sphere(4), 0.5, {}))), transformed(test::cube(2), 0.1, {}));
  const Domain domain = domain_around(both(wall, transformed(test::cube(1), 0.3, {4, 0, 0})), 40.0);
  expect_tiling(domain, fill(domain, {.try_other_engine = false}));
}

TEST_F(OwnEngine, FollowsSources) {
  const Domain domain = domain_around(test::sphere(6), 10.0);
  const std::vector<SizeSource> sources = {{.kind = SourceKind::sphere, .from = {4, 0, 0}, .radius = 1.0, .size = 0.15}};
  const TetraResult result = fill(domain, {}, sources);
  expect_tiling(domain, result);
  const auto n_near = std::ranges::count_if(result.new_points, [](const Vec3& p) { return distance(p, {4, 0, 0}) < 1.0; });
  // A volume of 4/3 pi with one point per 0.8 to 1.2 times the volume of a cube of side 0.15.
  EXPECT_GT(n_near, 1000);
  EXPECT_LT(n_near, 2000);
}

/// Real surfaces, their own triangles as inner boundary: sharp edges, needles, several bodies.
TEST_F(OwnEngine, FillsAroundRealSurfaces) {
  STERNA_NEEDS_SHARED_DATA();
  for (const char* name : {"cgal_data_anchor_dense.off", "cgal_data_couplingdown.off", "caturbs_wing_wing.stl", "pygeo_bwb.stl"}) {
    SCOPED_TRACE(name);
    const Domain domain = domain_around(test::read_welded(test::shared_data() / "surfaces" / "clean" / name));
    const TetraResult result = fill(domain);
    expect_tiling(domain, result);
    EXPECT_EQ(result.engine, "sterna");
  }
}

TEST_F(OwnEngine, NeedsNoHelper) {
  const Domain domain = domain_around(test::sphere(5), 10.0);
  const TetraResult result = fill(domain, {.helper_folder = folder_where_crashes({"sterna-tet-hxt", "sterna-tet-tetgen"})});
  expect_tiling(domain, result);
  EXPECT_EQ(result.engine, "sterna");
  EXPECT_THAT(result.failures, IsEmpty());
  EXPECT_THAT(warnings_, IsEmpty());
}

TEST_F(OwnEngine, FailedRecoveryIsErrorOfAllEngines) {
  // Two balls cross, and the proof is that of another boundary: no engine can recover such a boundary.
  Domain crossing;
  crossing.add(both(test::sphere(3), transformed(test::sphere(4), 0.7, {0.55, 0.1, 0.4})));
  crossing.add(inside_out(transformed(test::cube(2), 10.0, {-5, -5, -5})));
  TetraBoundary boundary = crossing.boundary();
  boundary.clear = proof_of_another_boundary();
  const RunContext context({.log = [this](LogLevel level, std::string_view text) {
    if (level == LogLevel::warning) warnings_.emplace_back(text);
  }});
  const SizeField sizes = build_size_field(boundary, {}, {}, context);
  const ErrorInfo error = error_info_of([&] {
    volmesh::fill(boundary, &sizes,
                  {.engine = "sterna", .try_other_engine = false, .helper_folder = folder_where_crashes({"sterna-tet-hxt", "sterna-tet-tetgen"})}, context);
  });
  EXPECT_EQ(error.code, ErrorCode::tetra_engine_failed);
  EXPECT_THAT(error.problem, HasSubstr("signal 11"));
  EXPECT_THAT(warnings_, testing::Contains(HasSubstr("could not be recovered in the mesh, the first at")));
}

TEST_F(OwnEngine, EndsAtItsLimits) {
  const Domain domain = domain_around(test::sphere(6), 10.0);
  const std::vector<SizeSource> sources = {{.kind = SourceKind::sphere, .from = {6, 0, 0}, .radius = 4.0, .size = 0.05}};
  const ErrorInfo late = error_info_of([&] { fill(domain, {.time_limit = 0.2, .try_other_engine = false}, sources); });
  EXPECT_EQ(late.code, ErrorCode::tetra_engine_failed);
  EXPECT_THAT(late.problem, HasSubstr("time limit of 0.2 s"));
  EXPECT_THAT(late.hint, HasSubstr("tetrahedra.time_limit"));
  const ErrorInfo large = error_info_of([&] { fill(domain, {.memory_limit = 1e7, .try_other_engine = false}, sources); });
  EXPECT_THAT(large.problem, HasSubstr("out of memory: the limit is 10 MB"));
  EXPECT_THAT(large.hint, HasSubstr("memory_limit"));
}

TEST_F(OwnEngine, OtherEnginesFollowAfterTooManyPoints) {
  const Domain domain = domain_around(test::cube(2), 10.0);
  const TetraResult free = fill(domain);
  ASSERT_GT(free.new_points.size(), 10u);
  const ErrorInfo error = error_info_of([&] { fill(domain, {.max_new_points = 5.0, .try_other_engine = false}); });
  EXPECT_THAT(error.problem, HasSubstr(std::to_string(free.new_points.size()) + " new points, limit 5"));
}

TEST_F(OwnEngine, IsAutomaticWhereFewTrianglesAreNeedles) {
  const auto chosen = [](const TriMesh& wall, const std::string& helpers = {}) {
    const Domain domain = domain_around(wall, 10.0);
    const RunContext context;
    const SizeField sizes = build_size_field(domain.boundary(), {}, {}, context);
    return volmesh::fill(domain.boundary(), &sizes, {.helper_folder = helpers}, context).engine;
  };
  EXPECT_EQ(chosen(test::sphere(5)), "sterna");
  TriMesh plate = test::cube(4);
  for (Point& p : plate.points) p.z *= 0.02;  // four of six sides consist of needles
  EXPECT_EQ(chosen(plate), "hxt");
  EXPECT_EQ(chosen(plate, folder_where_crashes({"sterna-tet-hxt"})), "tetgen");
  EXPECT_EQ(chosen(plate, folder_where_crashes({"sterna-tet-hxt", "sterna-tet-tetgen"})), "sterna");
}

TEST_F(OwnEngine, WithoutSizesAnotherEngineIsTaken) {
  const Domain domain = domain_around(test::cube(2), 10.0);
  const TetraResult result = volmesh::fill(domain.boundary(), nullptr, {.engine = "sterna"}, RunContext{});
  EXPECT_EQ(result.engine, "hxt");
  EXPECT_THAT(result.failures, ElementsAre(HasSubstr("no size field")));
}

TEST_F(OwnEngine, DoesNotSplitAndHasOnePass) {
  const Domain domain = domain_around(test::cube(2), 10.0);
  EXPECT_EQ(error_info_of([&] { fill(domain, {.two_pass = true}); }).code, ErrorCode::bad_argument);
  EXPECT_THAT(error_info_of([&] { fill(domain, {.boundary_splits = "always"}); }).hint, HasSubstr("cannot split the boundary"));
}

TEST_F(OwnEngine, StopsInTheRefinement) {
  const Domain domain = domain_around(test::sphere(6), 10.0);
  std::stop_source stop;
  const RunContext context({.threads = 2, .stop = stop.get_token(), .log = [&](LogLevel, std::string_view text) {
                              if (text.find("refinement round 1:") != std::string_view::npos) stop.request_stop();
                            }});
  const SizeField sizes = build_size_field(domain.boundary(), {}, {}, context);
  EXPECT_EQ(error_info_of([&] { volmesh::fill(domain.boundary(), &sizes, {.engine = "sterna"}, context); }).code, ErrorCode::cancelled);
  EXPECT_TRUE(test::has_no_children());
}

}  // namespace
}  // namespace sterna::volmesh
