// A series with a reference case: a wing that bends keeps the reference's triangles and starts its envelope from the reference. The bytes are the same however
// the series is run.
#include <gmock/gmock.h>

#include <algorithm>
#include <fstream>
#include <sstream>

#include "tests/scripting/series/series_fixture.h"

namespace sterna::scripting {
namespace {

using testing::AllOf;
using testing::HasSubstr;
using testing::Not;

/// The wing of tests/data/shared, bent upwards by `bend` metres over 5 m of span; in a farfield without tunnel, at an angle of attack or as read.
std::string bend_series(const std::string& cases, const std::string& options, const std::string& surface_options = "") {
  return "local model = read_cad \"" + (test::shared_data() / "cad" / "tigl_simplewing_simplewing.brep").string() + "\"\n" +
         "series{ \"bend\", over = " + cases + ", reference = { bend = 0, alpha = 0 }, " + options + R"lua( case = function(p)
  local m = model:deform{ function(x, y, z) return 0, 0, p.bend*(y/5)^2 end }
  if p.alpha ~= 0 then m = m:rotate{ about = { 0.5, 0, 0 }, pitch = p.alpha*deg } end
  local wall = surface_mesh{ m, max_edge = 0.5, min_edge = 0.05, curvature_angle = 40*deg, growth = 1.8)lua" +
         surface_options + R"lua( }
  wall:write "wall.off"
  if p.surface_only then return wall.triangles end
  volume_mesh{ wall, layers = 5, first_height = 2e-3, max_growth = 1.5, farfield = sphere{ radius = 30 } }:write "mesh.su2"
end }
)lua";
}

/// Returns { {bend = 0, alpha = 0}, ... } in this order; the case names do not depend on the order.
std::string cases(const std::vector<std::pair<double, double>>& list, const std::string& more = "") {
  std::ostringstream text;
  text << "{ ";
  for (const auto& [bend, alpha] : list)
    text << "{ bend = " << bend << ", alpha = " << alpha << more << ", name = \"bend=" << bend << "_alpha=" << alpha << "\" }, ";
  return text.str() + "}";
}

/// Returns the triangle lines of an .off file, which follow its points.
std::string triangles_of(const std::string& off) {
  std::istringstream lines(off);
  std::string line, triangles;
  while (std::getline(lines, line))
    if (line.starts_with("3 ")) triangles += line + "\n";
  return triangles;
}

class ReferenceSeries : public SeriesFixture {
 protected:
  std::string reused(const std::string& name) const { return text_of("bend/" + name + "/measure.json"); }
  std::string wall(const std::string& name) const { return text_of("bend/" + name + "/wall.off"); }
};

TEST_F(ReferenceSeries, BentCasesReuseTrianglesAndEnvelope) {
  STERNA_NEEDS_SHARED_DATA();
  const test::ProcessResult result = run(bend_series(cases({{0, 0}, {0.1, 0}, {0.1, 3}, {0, 3}}), "cache = false,"), {"--tasks", "2", "--threads", "2"});
  ASSERT_EQ(result.status, 0) << result.errors;
  EXPECT_TRUE(std::filesystem::exists(folder_ / "bend/bend=0_alpha=0/reference.kept"));
  EXPECT_THAT(text_of("bend/bend=0.1_alpha=0/status.json"), HasSubstr("bend=0_alpha=0/reference.kept"));  // an input
  const std::string triangles = triangles_of(wall("bend=0_alpha=0"));
  EXPECT_GT(triangles.size(), 1000u);
  for (const std::string& name : {std::string("bend=0.1_alpha=0"), std::string("bend=0.1_alpha=3")}) {  // at the original position, and moved
    EXPECT_EQ(triangles_of(wall(name)), triangles) << name;
    EXPECT_NE(wall(name), wall("bend=0_alpha=0")) << name;
    EXPECT_THAT(reused(name), AllOf(HasSubstr(": topology of bend=0_alpha=0"), HasSubstr(": started from bend=0_alpha=0"))) << name;
    EXPECT_THAT(text_of("bend/" + name + "/status.json"), HasSubstr("VALID"));
  }
  EXPECT_THAT(reused("bend=0_alpha=3"), Not(HasSubstr("bend=0_alpha=0")));  // the reference's shape, only moved: reused as in any series
  EXPECT_THAT(result.output, HasSubstr("topology of bend=0_alpha=0"));      // in the table
  EXPECT_THAT(text_of("bend/series.json"), Not(HasSubstr("INVALID")));
}

TEST_F(ReferenceSeries, GivesTheSameBytesHoweverItIsRun) {
  STERNA_NEEDS_SHARED_DATA();
  run(bend_series(cases({{0, 0}, {0.1, 0}, {0.1, 3}, {0.3, 3}}), "cache = false,"), {"--tasks", "2", "--threads", "2"});
  const auto plain = results_only(snapshot(folder_ / "bend"));
  const std::string other_way_round = bend_series(cases({{0.3, 3}, {0.1, 3}, {0.1, 0}, {0, 0}}), "");
  const std::filesystem::path cached = folder_ / "cached";
  run(other_way_round, {"--tasks", "1", "--threads", "1"}, cached);  // cold cache
  EXPECT_EQ(difference(plain, results_only(snapshot(cached / "bend"))), "");
  const std::string told_cold = contents(cached / "bend/bend=0.1_alpha=3/log.txt");
  std::filesystem::remove_all(cached / "bend");
  run(other_way_round, {"--tasks", "2", "--threads", "7"}, cached);  // warm cache
  EXPECT_EQ(difference(plain, results_only(snapshot(cached / "bend"))), "");
  for (const std::string& text : {told_cold, contents(cached / "bend/bend=0.1_alpha=3/measure.json")})
    EXPECT_THAT(text, HasSubstr(": topology of bend=0_alpha=0"));
}

TEST_F(ReferenceSeries, UnsuitableReferencesAreRemeshedWithReason) {
  STERNA_NEEDS_SHARED_DATA();
  const std::string script =
      bend_series(cases({{0, 0}, {8, 0}, {0.1, 0}}, ", surface_only = true"), "cache = false,", ", max_edge = p.bend == 0.1 and 0.45 or 0.5");
  const test::ProcessResult result = run(std::string(script).replace(script.find("max_edge = 0.5, "), 16, ""), {"--tasks", "1", "--threads", "2"});
  ASSERT_EQ(result.status, 0) << result.errors;
  EXPECT_THAT(reused("bend=8_alpha=0"), AllOf(HasSubstr(": meshed again: "), HasSubstr(", at (")));
  EXPECT_NE(triangles_of(wall("bend=8_alpha=0")), triangles_of(wall("bend=0_alpha=0")));
  EXPECT_THAT(reused("bend=0.1_alpha=0"), HasSubstr(": meshed again: options differ from those of the reference: max_edge"));
}

TEST_F(ReferenceSeries, DamagedReferenceFileIsErrorOfDependentCases) {
  STERNA_NEEDS_SHARED_DATA();
  const std::string script = bend_series(cases({{0, 0}, {0.1, 0}}, ", surface_only = true"), "cache = false,");
  ASSERT_EQ(run(script, {"--threads", "2"}).status, 0);
  const std::filesystem::path kept = folder_ / "bend/bend=0_alpha=0/reference.kept";
  std::fstream(kept, std::ios::binary | std::ios::in | std::ios::out).seekp(5000).put('\x5a').put('\x5a');
  run(script, {"--threads", "2", "--series-case", "bend/2"});
  EXPECT_THAT(text_of("bend/bend=0.1_alpha=0/status.json"),
              AllOf(HasSubstr("\"failed\""), HasSubstr("reference.kept is damaged: its content does not match the stored hash"), HasSubstr("bend=0_alpha=0")));
  const test::ProcessResult healed =
      run(script, {"--threads", "2"});  // the reference no longer equals its record, so the reference and all cases that start from it are made again
  EXPECT_EQ(healed.status, 0) << healed.errors;
  EXPECT_THAT(text_of("bend/bend=0.1_alpha=0/status.json"), HasSubstr("\"done\""));
}

/// A wing in two bends: plain, with multi-normal fans along its sharp edges, and with a wake sheet behind its trailing edge.
constexpr const char* k_kinds_series = R"lua(
local model = aircraft{ wing{ name = "wing", symmetric = true, trailing_edge = 0, sections = {
  { y = 0, chord = 1, airfoil = "naca0012" }, { y = 1, chord = 0.8 } } } }
series{ "kinds", over = { kind = { "fans", "plain", "wakes" }, bend = { 0, 0.03 } }, reference = { kind = "plain", bend = 0 }, case = function(p)
  local bent = model:deform{ function(x, y, z) return 0, 0, p.bend*y^2 end }
  local wall = surface_mesh{ bent, max_edge = 0.15, min_edge = 0.04, curvature_angle = 40*deg }
  local mesh = volume_mesh{ wall, layers = 6, first_height = 2e-3, max_growth = 1.4, farfield = sphere{ radius = 20 },
    ridges = { open_ridges = p.kind == "fans" and "always" or "never" }, wakes = p.kind == "wakes" and "auto" or nil }
  mesh:check()
  mesh:write "mesh.su2"
end }
)lua";

TEST_F(ReferenceSeries, BentFansAndSheetsAreRemadeAndResumed) {
  const std::filesystem::path at_once = folder_ / "at_once", stopped = folder_ / "stopped";
  const test::ProcessResult result = run(k_kinds_series, {"--tasks", "2"}, at_once);
  ASSERT_EQ(result.status, 0) << result.errors;
  const auto all = results_only(snapshot(at_once / "kinds"));
  for (const char* kind : {"fans", "plain", "wakes"})
    for (const char* bend : {"0", "0.03"}) {
      const std::string name = std::string("bend=") + bend + "_kind=" + kind;
      EXPECT_THAT(contents(at_once / "kinds" / name / "status.json"), HasSubstr("VALID")) << name;
      EXPECT_GT(contents(at_once / "kinds" / name / "mesh.su2").size(), 100'000u) << name;
    }
  EXPECT_THAT(contents(at_once / "kinds/bend=0.03_kind=plain/measure.json"), HasSubstr(": started from bend=0_kind=plain"));
  for (const char* kind : {"fans", "wakes"})  // a wall other than the reference's
    EXPECT_THAT(contents(at_once / ("kinds/bend=0.03_kind=" + std::string(kind) + "/measure.json")),
                AllOf(HasSubstr(": topology of bend=0_kind=plain"), HasSubstr("made from scratch")));
  run(k_kinds_series, {"--tasks", "1"}, stopped, 1.5);  // s; if the series is finished by then, nothing is left to do
  ASSERT_EQ(run(k_kinds_series, {"--tasks", "2", "--threads", "2"}, stopped).status, 0);
  EXPECT_EQ(difference(all, results_only(snapshot(stopped / "kinds"))), "");
}

}  // namespace
}  // namespace sterna::scripting
