// Steps after the failure of an engine: failures that another engine may resolve, and the messages about them.
#include <gmock/gmock.h>

#include <filesystem>
#include <fstream>

#include "tests/support/data.h"
#include "tests/support/test_shapes.h"
#include "tests/volmesh/tetra/cases.h"
#include "volmesh/tetra/engine_process.h"

namespace sterna::volmesh {
namespace {

using test::both;
using test::Domain;
using test::domain_around;
using test::error_info_of;
using test::expect_tiling;
using test::transformed;
using testing::Contains;
using testing::ElementsAre;
using testing::HasSubstr;
using testing::IsEmpty;

constexpr const char* k_crash = "kill -SEGV $$";

class Ladder : public testing::Test {
 protected:
  /// Returns a folder where TetGen's helper is a shell script, and HXT's is the real one or also a script.
  std::string folder(const std::string& name, const std::string& tetgen, const std::string& hxt = {}) {
    const std::filesystem::path folder = test::scratch() / name;
    std::filesystem::remove_all(folder);
    std::filesystem::create_directories(folder);
    write_script(folder / "sterna-tet-tetgen", tetgen);
    if (hxt.empty()) std::filesystem::create_symlink(find_helper("sterna-tet-hxt", {}), folder / "sterna-tet-hxt");
    else write_script(folder / "sterna-tet-hxt", hxt);
    return folder.string();
  }
  static void write_script(const std::filesystem::path& path, const std::string& text) {
    std::ofstream(path) << "#!/bin/sh\n" << text << "\n";
    std::filesystem::permissions(path, std::filesystem::perms::owner_all);
  }
  TetraResult fill(const Domain& domain, const TetraOptions& options) {
    log_.clear();
    return volmesh::fill(domain.boundary(), nullptr, options, RunContext({.log = [this](LogLevel level, std::string_view text) {
                           if (level == LogLevel::warning) log_.emplace_back(text);
                         }}));
  }
  Domain domain_ = domain_around(test::cube(2), 10.0);
  std::vector<std::string> log_;
};

TEST_F(Ladder, NoStepWhenNothingFails) {
  const TetraResult result = fill(domain_, {.engine = "tetgen"});
  EXPECT_EQ(result.engine, "tetgen");
  EXPECT_TRUE(result.is_reproducible);
  EXPECT_THAT(result.failures, IsEmpty());
  EXPECT_THAT(log_, IsEmpty());
}

TEST_F(Ladder, TheOtherEngineAfterACrash) {
  const TetraResult result = fill(domain_, {.engine = "tetgen", .helper_folder = folder("crash", k_crash)});
  expect_tiling(domain_, result);
  EXPECT_EQ(result.engine, "hxt");
  EXPECT_TRUE(result.is_reproducible);
  EXPECT_THAT(result.failures, ElementsAre(HasSubstr("signal 11")));
  EXPECT_THAT(log_, ElementsAre(HasSubstr("signal 11"), HasSubstr("trying HXT")));
}

TEST_F(Ladder, AutomaticIsHxtThenTetgen) {
  EXPECT_EQ(fill(domain_, {}).engine, "hxt");
  const std::string helpers = folder("hxt_crashes", "", k_crash);
  std::filesystem::remove(std::filesystem::path(helpers) / "sterna-tet-tetgen");
  std::filesystem::create_symlink(find_helper("sterna-tet-tetgen", {}), std::filesystem::path(helpers) / "sterna-tet-tetgen");
  const TetraResult result = fill(domain_, {.helper_folder = helpers});
  expect_tiling(domain_, result);
  EXPECT_EQ(result.engine, "tetgen");
  EXPECT_THAT(result.failures, ElementsAre(HasSubstr("signal 11")));
}

TEST_F(Ladder, TheOtherEngineAfterAWrongAnswer) {
  const TetraResult result = fill(domain_, {.engine = "tetgen", .helper_folder = folder("liar", "printf 'STETREP3' >&4; head -c 48 /dev/zero >&4")});
  expect_tiling(domain_, result);
  EXPECT_THAT(result.failures, ElementsAre(HasSubstr("points returned of")));
}

TEST_F(Ladder, TheOtherEngineAfterTooManyPoints) {
  const TetraResult free = fill(domain_, {.engine = "tetgen"}), other = fill(domain_, {.engine = "hxt"});
  const std::size_t fewer = std::min(free.new_points.size(), other.new_points.size()), more = std::max(free.new_points.size(), other.new_points.size());
  ASSERT_LT(fewer, more);
  const char* greedy = free.new_points.size() == more ? "tetgen" : "hxt";
  const TetraResult result = fill(domain_, {.engine = greedy, .max_new_points = static_cast<double>(fewer)});
  EXPECT_NE(result.engine, greedy);
  EXPECT_THAT(result.failures, ElementsAre(HasSubstr("limit")));
  EXPECT_THAT(error_info_of([&] { fill(domain_, {.engine = greedy, .max_new_points = static_cast<double>(fewer - 1)}); }).problem, HasSubstr("new points"));
}

TEST_F(Ladder, CanBeForbidden) {
  const ErrorInfo error = error_info_of([&] { fill(domain_, {.engine = "tetgen", .try_other_engine = false, .helper_folder = folder("crash", k_crash)}); });
  EXPECT_EQ(error.code, ErrorCode::tetra_engine_failed);
  EXPECT_THAT(error.problem, HasSubstr("signal 11"));
  EXPECT_THAT(log_, ElementsAre(HasSubstr("signal 11")));
}

TEST_F(Ladder, ReportsFirstEngineErrorWhenAllFail) {
  const ErrorInfo error = error_info_of([&] { fill(domain_, {.engine = "tetgen", .helper_folder = folder("both", "echo first >&2; exit 3", k_crash)}); });
  EXPECT_THAT(error.problem, HasSubstr("first"));
  EXPECT_THAT(log_, Contains(HasSubstr("signal 11")));
}

TEST_F(Ladder, FailureWithoutLocationNamesDifficultLocations) {
  TriMesh plate = test::cube(1);
  for (Point& p : plate.points) p.z *= 1e-4;  // its sides are slivers
  const Domain domain = domain_around(plate, 10.0);
  const ErrorInfo error = error_info_of([&] { fill(domain, {.helper_folder = folder("crash", k_crash, k_crash)}); });
  EXPECT_EQ(error.code, ErrorCode::tetra_engine_failed);
  ASSERT_FALSE(error.locations.empty());
  EXPECT_THAT(error.locations.front().what, HasSubstr("difficult for tetrahedra engines"));
  EXPECT_FALSE(error.geometry.triangles.empty());  // drawn in the VTU file
}

TEST_F(Ladder, NoEngineWhenTheBoundaryCrossesItself) {
  Domain crossing;
  crossing.add(both(test::sphere(3), transformed(test::sphere(4), 0.7, {0.55, 0.1, 0.4})));
  crossing.add(test::inside_out(transformed(test::cube(2), 10.0, {-5, -5, -5})));
  EXPECT_EQ(error_info_of([&] { fill(crossing, {.helper_folder = "/nowhere"}); }).code, ErrorCode::self_intersection);
  EXPECT_THAT(log_, testing::Not(Contains(HasSubstr("trying"))));
}

/// A helper's reply that its CPU time limit was reached.
constexpr const char* k_out_of_time = "printf 'STETREP3\\005\\0\\0\\0' >&4; head -c 44 /dev/zero >&4; exit 1";

TEST_F(Ladder, EndlessEngineIsStoppedAndLadderEnds) {
  // Another engine may succeed; the choice of the engine then depended on a clock.
  const TetraResult result = fill(domain_, {.engine = "tetgen", .helper_folder = folder("no_end", k_out_of_time)});
  expect_tiling(domain_, result);
  EXPECT_EQ(result.engine, "hxt");
  EXPECT_FALSE(result.is_reproducible);
  EXPECT_THAT(result.failures, ElementsAre(HasSubstr("processor time")));
  // No engine succeeds: no splits are tried, and the error gives the result of each engine, the difficult locations, and a remedy.
  TriMesh plate = test::cube(1);
  for (Point& p : plate.points) p.z *= 1e-4;
  const Domain domain = domain_around(plate, 10.0);
  const ErrorInfo error = error_info_of([&] { fill(domain, {.helper_folder = folder("no_end_at_all", k_out_of_time, k_crash)}); });
  EXPECT_EQ(error.code, ErrorCode::tetra_engine_failed);
  EXPECT_THAT(error.problem,
              testing::AllOf(HasSubstr("(HXT): the helper died of signal 11"), HasSubstr("(TetGen): stopped after"), HasSubstr("processor time")));
  EXPECT_THAT(error.hint, testing::AllOf(HasSubstr("re-mesh the surface"), HasSubstr("tetrahedra.time_limit")));
  ASSERT_FALSE(error.locations.empty());
  EXPECT_THAT(error.locations.front().what, HasSubstr("difficult for tetrahedra engines"));
  EXPECT_THAT(log_, testing::Not(Contains(HasSubstr("splits"))));
}

TEST_F(Ladder, EngineHelpersCountProcessorTime) {
  // The real engines under a CPU limit of one second, inherited from the parent process, with work for several seconds.
  const std::string limited = "ulimit -S -t 1; exec ";
  const Domain domain = domain_around(test::sphere(70));
  const std::string helpers = folder("limited", limited + find_helper("sterna-tet-tetgen", {}), limited + find_helper("sterna-tet-hxt", {}));
  const ErrorInfo error = error_info_of([&] { fill(domain, {.helper_folder = helpers}); });
  EXPECT_THAT(error.problem,
              testing::AllOf(HasSubstr("(HXT): stopped after 1 s of processor time"), HasSubstr("(TetGen): stopped after 1 s of processor time")));
}

TEST_F(Ladder, EndsAtALimitUnlessToldOtherwise) {
  EXPECT_THAT(error_info_of([&] { fill(domain_, {.engine = "tetgen", .time_limit = 0.2, .helper_folder = folder("endless", "sleep 100")}); }).problem,
              HasSubstr("time limit"));
  EXPECT_THAT(log_, testing::SizeIs(1));
  // Killed from outside, as the system does when memory is short.
  TetraOptions options = {.engine = "tetgen", .helper_folder = folder("killed", "kill -KILL $$")};
  EXPECT_THAT(error_info_of([&] { fill(domain_, options); }).problem, HasSubstr("signal 9"));
  options.fall_back_on_limits = true;
  const TetraResult result = fill(domain_, options);
  EXPECT_EQ(result.engine, "hxt");
  EXPECT_FALSE(result.is_reproducible);
  EXPECT_THAT(result.failures, ElementsAre(HasSubstr("signal 9")));
}

TEST_F(Ladder, MissingEngineIsNamed) {
  const std::string only_hxt = folder("only_hxt", "");
  std::filesystem::remove(std::filesystem::path(only_hxt) / "sterna-tet-tetgen");
  const ErrorInfo error = error_info_of([&] { fill(domain_, {.engine = "tetgen", .helper_folder = only_hxt}); });
  EXPECT_EQ(error.code, ErrorCode::tetra_engine_missing);
  EXPECT_THAT(error.attempted, HasSubstr("sterna-tet-tetgen"));
  EXPECT_THAT(error.problem, HasSubstr("was not built"));
  const TetraResult result = fill(domain_, {.helper_folder = only_hxt});  // automatic: any available engine
  EXPECT_EQ(result.engine, "hxt");
  EXPECT_TRUE(result.is_reproducible);
}

}  // namespace
}  // namespace sterna::volmesh
