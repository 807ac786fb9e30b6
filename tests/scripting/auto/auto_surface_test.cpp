// --auto, repair and the union of CAD parts that stand in each other, as users call them.
#include <gmock/gmock.h>

#include <nlohmann/json.hpp>

#include "tests/scripting/script_fixture.h"
#include "tests/support/process.h"

namespace sterna::scripting {
namespace {

using testing::HasSubstr;
using testing::Not;

class AutoSurfaceTest : public ScriptFixture {
 protected:
  AutoSurfaceTest() { std::filesystem::copy(test::corpus() / "scripts" / "box.stl", folder_ / "box.stl"); }
  test::ProcessResult sterna(const std::vector<std::string>& arguments) { return test::run_process(test::sterna_program(), arguments, folder_); }
  /// box.stl without its first facet.
  void write_open_box() {
    run("read_surface('" + (folder_ / "box.stl").string() + "'):write(" + out("whole.off") + ")");
    std::ifstream whole(folder_ / "whole.off");
    std::string word, points;
    std::size_t n_points = 0, n_facets = 0, n_edges = 0;
    whole >> word >> n_points >> n_facets >> n_edges;
    std::ofstream file(folder_ / "open.off");
    file << "OFF\n" << n_points << " " << n_facets - 1 << " 0";
    std::getline(whole, word);
    for (std::size_t i = 0; i < n_points + n_facets; ++i) {
      do std::getline(whole, word);
      while (word.empty() || word[0] == '#');
      if (i != n_points) file << "\n" << word;  // the first facet is left out
    }
    file << "\n";
  }
  std::vector<std::string> mesh(const std::string& name, const std::string& output, const std::vector<std::string>& more) const {
    std::vector<std::string> words = {"mesh", name, "-o", output, "--layers", "5", "--first-height", "1e-3", "--threads", "1"};
    words.insert(words.end(), more.begin(), more.end());
    return words;
  }
};

TEST_F(AutoSurfaceTest, WhatIsCleanGivesTheSameBytes) {
  ASSERT_EQ(sterna(mesh("box.stl", "a.su2", {})).status, 0);
  const test::ProcessResult result = sterna(mesh("box.stl", "b.su2", {"--auto"}));
  ASSERT_EQ(result.status, 0) << result.errors;
  EXPECT_THAT(result.output + result.errors, Not(HasSubstr("changed")));
  EXPECT_EQ(text_of("a.su2"), text_of("b.su2"));
}

TEST_F(AutoSurfaceTest, WhatIsOpenIsRepairedAndToldFirst) {
  write_open_box();
  const test::ProcessResult refused = sterna(mesh("open.off", "a.su2", {}));
  EXPECT_EQ(refused.status, 1);
  EXPECT_THAT(refused.errors, HasSubstr("open"));
  const test::ProcessResult result = sterna(mesh("open.off", "b.su2", {"--auto"}));
  ASSERT_EQ(result.status, 0) << result.errors;
  EXPECT_THAT(result.output + result.errors, HasSubstr("changed     repaired: holes filled: 1 place"));
  const nlohmann::json manifest = nlohmann::json::parse(text_of("b.su2.json"));
  ASSERT_EQ(manifest.at("changes").size(), 1u);
  EXPECT_THAT(manifest.at("changes").at(0).get<std::string>(), HasSubstr("holes filled"));
  EXPECT_EQ(manifest.at("verdict"), "VALID");
}

TEST_F(AutoSurfaceTest, RepairWritesWhatItChanged) {
  write_open_box();
  const test::ProcessResult result = sterna({"repair", "open.off", "-o", "mended.stl", "--changes", "changes.vtu", "--report", "changes.json"});
  ASSERT_EQ(result.status, 0) << result.errors;
  EXPECT_THAT(text_of("changes.vtu"), HasSubstr("UnstructuredGrid"));
  const nlohmann::json report = nlohmann::json::parse(text_of("changes.json"));
  ASSERT_EQ(report.at("changes").size(), 1u);
  EXPECT_EQ(report.at("changes").at(0).at("kind"), "filled");
  EXPECT_THAT(run("print(read_surface " + out("mended.stl") + ")"), HasSubstr("closed"));
}

TEST_F(AutoSurfaceTest, WrapWritesWhatItClosed) {
  write_open_box();
  const test::ProcessResult result =
      sterna({"wrap", "open.off", "-o", "closed.stl", "--edge", "0.1", "--gap", "0.8", "--changes", "closures.vtu", "--report", "wrap.json"});
  ASSERT_EQ(result.status, 0) << result.errors;
  EXPECT_THAT(text_of("closures.vtu"), HasSubstr("UnstructuredGrid"));
  const nlohmann::json report = nlohmann::json::parse(text_of("wrap.json"));
  ASSERT_EQ(report.at("closures").size(), 1u);
  EXPECT_EQ(report.at("closures").at(0).at("kind"), "opening");
  EXPECT_NEAR(report.at("closures").at(0).at("area").get<double>(), 0.5, 0.25);  // half a side of the box, and its rim
  EXPECT_TRUE(report.at("leaks").empty());
  // Told before the work.
  EXPECT_THAT(sterna({"wrap", "open.off", "-o", "closed.stl", "--report", "nowhere/wrap.json"}).errors, HasSubstr("create the folder first"));
  EXPECT_THAT(sterna({"wrap", "open.off", "-o", "closed.stl", "--edge", "0.1", "--gap", "0.01"}).errors, HasSubstr("is below the edge"));
}

TEST_F(AutoSurfaceTest, SinglePrecisionThatMergesVerticesIsTold) {
  // A box far away, one of its corners cut off by less than single precision tells apart.
  std::ofstream(folder_ / "far.off") << "OFF\n6 8 0\n1000 0 0\n1001 0 0\n1000.5 1 0\n1000.5 0.5 1\n1000.5 0.50000001 1\n1000.5 0.5 -1\n"
                                        "3 0 1 3\n3 1 4 3\n3 1 2 4\n3 2 0 4\n3 0 3 4\n3 1 0 5\n3 2 1 5\n3 0 2 5\n";
  const test::ProcessResult stl = sterna({"repair", "far.off", "-o", "far.stl"}), obj = sterna({"repair", "far.off", "-o", "far.obj"});
  ASSERT_EQ(stl.status, 0) << stl.errors;
  EXPECT_THAT(stl.output + stl.errors, HasSubstr("STL is single precision, which puts 1 of 6 vertices onto others"));
  EXPECT_THAT(obj.output + obj.errors, Not(HasSubstr("single precision")));
}

TEST_F(AutoSurfaceTest, UnitsOfTriangulationsAreHeeded) {
  const test::ProcessResult result = sterna({"surface", "box.stl", "--auto", "--unit", "mm", "-o", "small.stl"});
  ASSERT_EQ(result.status, 0) << result.errors;
  EXPECT_THAT(run("print(read_surface(" + out("small.stl") + ").length)"), HasSubstr("0.001"));
}

TEST_F(AutoSurfaceTest, ReadSurfaceTakesTheSame) {
  write_open_box();
  const std::string open = out("open.off");
  EXPECT_THAT(error("read_surface{ " + open + " }"), HasSubstr("open"));
  for (const char* asked : {"repair = true", "repair = { hole = 0.5 }", "auto = true"})
    EXPECT_THAT(run("print(read_surface{ " + open + ", " + asked + " })"), HasSubstr("closed")) << asked;
  EXPECT_THAT(run("print(repair{ read_surface{ " + open + ", allow_open = true } })"), HasSubstr("closed"));
  EXPECT_THAT(error("read_surface{ " + open + ", repair = true, wrap = true }"), HasSubstr("at most one of repair, wrap and auto"));
  EXPECT_THAT(error("read_surface{ " + open + ", repair = { hoel = 1 } }"), HasSubstr("hole"));
}

TEST_F(AutoSurfaceTest, PartsOfCadThatStandInEachOtherAreUnited) {
  run("box{ {0, 0, 0}, {1, 1, 1}, name = 'a' }:write(" + out("a.step") + ") box{ {0.5, 0.25, 0.25}, {2, 0.75, 0.75}, name = 'b' }:write(" + out("b.step") +
      ")");
  const test::ProcessResult result = sterna({"surface", "a.step", "b.step", "-o", "hull.stl"});
  ASSERT_EQ(result.status, 0) << result.errors;
  EXPECT_THAT(result.output + result.errors, HasSubstr("2 closed parts stand in each other and were united: 1 closed now"));
}

}  // namespace
}  // namespace sterna::scripting
