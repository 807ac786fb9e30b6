// --auto, repair and the union of intersecting CAD parts, as users call them.
#include <gmock/gmock.h>

#include <cmath>
#include <nlohmann/json.hpp>
#include <numbers>
#include <tuple>

#include "tests/scripting/script_fixture.h"
#include "tests/support/process.h"

namespace sterna::scripting {
namespace {

using testing::AllOf;
using testing::AnyOf;
using testing::HasSubstr;
using testing::Not;

class AutoSurfaceTest : public ScriptFixture {
 protected:
  AutoSurfaceTest() { std::filesystem::copy(test::corpus() / "scripts" / "box.stl", folder_ / "box.stl"); }
  test::ProcessResult sterna(const std::vector<std::string>& arguments) { return test::run_process(test::sterna_program(), arguments, folder_); }
  /// Writes box.stl without its first facet.
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
  // A file of an earlier run does not remain if nothing is changed.
  const std::string before = text_of("changes.vtu");
  ASSERT_EQ(sterna({"repair", "mended.stl", "-o", "again.stl", "--changes", "changes.vtu"}).status, 0);
  EXPECT_THAT(text_of("changes.vtu"), AllOf(HasSubstr("UnstructuredGrid"), Not(before)));
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
  EXPECT_NEAR(report.at("closures").at(0).at("area").get<double>(), 0.5, 0.25);  // half a side of the box, and its open boundary
  EXPECT_TRUE(report.at("leaks").empty());
  // Reported before any work is done.
  EXPECT_THAT(sterna({"wrap", "open.off", "-o", "closed.stl", "--report", "nowhere/wrap.json"}).errors, HasSubstr("create the folder first"));
  EXPECT_THAT(sterna({"wrap", "open.off", "-o", "closed.stl", "--edge", "0.1", "--gap", "0.01"}).errors, HasSubstr("is below the edge"));
}

TEST_F(AutoSurfaceTest, NeedlesGetNewTriangles) {
  // A box whose faces are triangle fans about corners, with many vertices along two edges.
  std::ofstream file(folder_ / "fans.off");
  constexpr int k_fan = 60;
  file << "OFF\n" << 2 * (k_fan + 1) + 4 << " " << 4 * k_fan + 8 << " 0\n";
  for (const int z : {0, 1})
    for (int i = 0; i <= k_fan; ++i) file << static_cast<double>(i) / k_fan << " 0 " << z << "\n";
  const int low = 0, high = k_fan + 1, back = 2 * (k_fan + 1);
  file << "0 1 0\n1 1 0\n0 1 1\n1 1 1\n";
  for (int i = 0; i < k_fan; ++i) {
    file << "3 " << low + i << " " << low + i + 1 << " " << high + i << "\n3 " << low + i + 1 << " " << high + i + 1 << " " << high + i << "\n";
    file << "3 " << low + i + 1 << " " << low + i << " " << back << "\n3 " << high + i << " " << high + i + 1 << " " << back + 2 << "\n";
  }
  const auto quad = [&](int a, int b, int c, int d) { file << "3 " << a << " " << b << " " << c << "\n3 " << a << " " << c << " " << d << "\n"; };
  file << "3 " << low + k_fan << " " << back << " " << back + 1 << "\n3 " << high + k_fan << " " << back + 3 << " " << back + 2 << "\n";
  quad(back, back + 2, back + 3, back + 1);
  quad(low, high, back + 2, back);
  quad(low + k_fan, back + 1, back + 3, high + k_fan);
  file.close();
  const test::ProcessResult result = sterna(mesh("fans.off", "fans.su2", {"--auto"}));
  ASSERT_EQ(result.status, 0) << result.errors;
  EXPECT_THAT(result.output + result.errors, HasSubstr("changed     remeshed: 248 ->"));
  const nlohmann::json manifest = nlohmann::json::parse(text_of("fans.su2.json"));
  EXPECT_TRUE(manifest.at("options").contains("remesh")) << manifest.at("options");
  EXPECT_THAT(sterna({"surface", "box.stl", "--auto", "-o", "same.off"}).output, Not(HasSubstr("remeshed")));
}

/// A bar of 1 x 0.03 x 0.03 m: each long side is two triangles whose short edge joins two corners.
void write_bar(const std::filesystem::path& path) {
  std::ofstream file(path);
  file << "OFF\n8 12 0\n";
  for (const double x : {0.0, 1.0})
    for (const double y : {0.0, 0.03})
      for (const double z : {0.0, 0.03}) file << x << " " << y << " " << z << "\n";
  for (const char* t : {"0 1 3", "0 3 2", "4 6 7", "4 7 5", "0 4 5", "0 5 1", "2 3 7", "2 7 6", "0 2 6", "0 6 4", "1 5 7", "1 7 3"}) file << "3 " << t << "\n";
}

TEST_F(AutoSurfaceTest, NeedlesBetweenCornersGetNewTriangles) {
  write_bar(folder_ / "bar.off");
  const test::ProcessResult result = sterna({"surface", "bar.off", "--auto", "-o", "new.off"});
  ASSERT_EQ(result.status, 0) << result.errors;
  EXPECT_THAT(result.output + result.errors, HasSubstr("changed: remeshed: 12 ->"));
}

TEST_F(AutoSurfaceTest, StagesTakeTheirOptions) {
  write_bar(folder_ / "bar.off");
  const test::ProcessResult bounded = sterna({"surface", "bar.off", "--auto", "-o", "same.off", "--set", "remesh.max_triangles=50"});
  ASSERT_EQ(bounded.status, 0) << bounded.errors;
  EXPECT_THAT(bounded.output + bounded.errors, AllOf(HasSubstr("remesh.max_triangles"), Not(HasSubstr("remeshed: 12 ->"))));
  const test::ProcessResult coarse = sterna({"surface", "bar.off", "--auto", "-o", "coarse.off", "--set", "remesh.max_edge=0.03", "--set", "repair.gap=1e-4"});
  EXPECT_THAT(coarse.output + coarse.errors, HasSubstr("edges of 0.03 to 0.03 m were requested")) << coarse.errors;
  EXPECT_THAT(sterna({"surface", "bar.off", "-o", "a.off", "--set", "remesh.max_edge=0.03"}).errors, HasSubstr("is given without --auto"));
}

TEST_F(AutoSurfaceTest, SmoothBodyIsNotDentedForItsBudget) {
  // Fine triangles, many of them needles: every third ring lies close to the preceding one.
  constexpr int k_rings = 60, k_sides = 80;
  std::ofstream file(folder_ / "car.off");
  file << "OFF\n" << (k_rings - 1) * k_sides + 2 << " " << 2 * (k_rings - 1) * k_sides << " 0\n";
  const auto power = [](double c, double e) { return std::copysign(std::pow(std::abs(c), e), c); };
  for (int i = 1; i < k_rings; ++i) {
    const double shift = i % 3 == 0 ? -0.97 : 0.0, a = 3.14159265358979 * (i + shift) / k_rings;
    for (int j = 0; j < k_sides; ++j) {
      const double b = 2.0 * 3.14159265358979 * j / k_sides;
      file << 2.0 * -power(std::cos(a), 0.7) << " " << 0.9 * power(std::sin(a), 0.7) * power(std::cos(b), 0.7) << " "
           << 0.6 * power(std::sin(a), 0.7) * power(std::sin(b), 0.7) << "\n";
    }
  }
  file << "-2 0 0\n2 0 0\n";
  const auto at = [](int i, int j) { return (i - 1) * k_sides + j % k_sides; };
  const int first = (k_rings - 1) * k_sides;
  for (int j = 0; j < k_sides; ++j) {
    file << "3 " << first << " " << at(1, j + 1) << " " << at(1, j) << "\n3 " << first + 1 << " " << at(k_rings - 1, j) << " " << at(k_rings - 1, j + 1)
         << "\n";
    for (int i = 1; i + 1 < k_rings; ++i)
      file << "3 " << at(i, j) << " " << at(i, j + 1) << " " << at(i + 1, j + 1) << "\n3 " << at(i, j) << " " << at(i + 1, j + 1) << " " << at(i + 1, j)
           << "\n";
  }
  file.close();
  const test::ProcessResult result = sterna({"surface", "car.off", "--auto", "-o", "same.off", "--set", "remesh.max_triangles=4000"});
  ASSERT_EQ(result.status, 0) << result.errors;
  EXPECT_THAT(result.output + result.errors, AllOf(HasSubstr("the triangles are kept"), Not(HasSubstr("changed: remeshed"))));
  const test::ProcessResult free = sterna({"surface", "car.off", "--auto", "-o", "new.off"});
  // With enough triangles the distance is the criterion: over new edges it is 0.255, above the limit of 0.2.
  EXPECT_THAT(free.output + free.errors, AllOf(HasSubstr("of their edges from the input triangles, the limit is 0.2"), HasSubstr("the triangles are kept")))
      << free.errors;
}

/// Half an ellipsoid, open along an axis, with its open boundary off the plane by up to `off`.
class AutoHalfTest : public AutoSurfaceTest, public testing::WithParamInterface<std::tuple<std::size_t, double>> {};

TEST_P(AutoHalfTest, IsRecognisedToldAndMeshed) {
  const auto [axis, off] = GetParam();
  constexpr int k_along = 24, k_around = 12;
  std::ofstream file(folder_ / "half.off");
  file << "OFF\n" << 2 + (k_along - 1) * (k_around + 1) << " " << 2 * (k_along - 1) * k_around << " 0\n";
  file.precision(15);
  int n = 0;
  const auto write = [&](double x, double y, double z, bool is_border) {
    if (is_border) y = off * std::sin(7.0 * ++n);
    const Point p = axis == 0 ? Point{y, x, z} : axis == 1 ? Point{x, y, z} : Point{x, z, y};
    file << p.x << " " << p.y << " " << p.z << "\n";
  };
  write(-0.5, 0.0, 0.0, true);
  for (int i = 1; i < k_along; ++i)
    for (int j = 0; j <= k_around; ++j) {
      const double u = std::numbers::pi * i / k_along, v = std::numbers::pi * j / k_around;
      write(-0.5 * std::cos(u), 0.15 * std::sin(u) * std::sin(v), 0.12 * std::sin(u) * std::cos(v), j == 0 || j == k_around);
    }
  write(0.5, 0.0, 0.0, true);
  const auto at = [](int i, int j) { return i == 0 ? 0 : i == k_along ? 1 + (k_along - 1) * (k_around + 1) : 1 + (i - 1) * (k_around + 1) + j; };
  const auto facet = [&](int a, int b, int c) {
    if (a != b && b != c && c != a) file << "3 " << a << " " << (axis == 1 ? b : c) << " " << (axis == 1 ? c : b) << "\n";
  };
  for (int i = 0; i < k_along; ++i)
    for (int j = 0; j < k_around; ++j) {
      facet(at(i, j), at(i + 1, j), at(i + 1, j + 1));
      facet(at(i, j), at(i + 1, j + 1), at(i, j + 1));
    }
  file.close();
  const test::ProcessResult result = sterna(mesh("half.off", "half.su2", {"--auto"}));
  ASSERT_EQ(result.status, 0) << result.errors;
  // Open boundaries that the reader finds flat form an open domain from the beginning; others are recognised as those of a half model.
  EXPECT_THAT(result.output + result.errors,
              AnyOf(HasSubstr("half model"), HasSubstr(std::string("all its open boundaries lie in the plane ") + "xyz"[axis] + " = 0 m")));
  EXPECT_THAT(result.output + result.errors, HasSubstr("VALID"));
  EXPECT_THAT(text_of("half.su2"), HasSubstr("MARKER_TAG= symmetry"));
}

INSTANTIATE_TEST_SUITE_P(Axes, AutoHalfTest, testing::Combine(testing::Values(0u, 1u, 2u), testing::Values(0.0, 1e-6, 1e-4, 1e-3)));

TEST_F(AutoSurfaceTest, SinglePrecisionThatMergesVerticesIsTold) {
  // A box far from the origin with one corner cut off by less than the resolution of single precision.
  std::ofstream(folder_ / "far.off") << "OFF\n6 8 0\n1000 0 0\n1001 0 0\n1000.5 1 0\n1000.5 0.5 1\n1000.5 0.50000001 1\n1000.5 0.5 -1\n"
                                        "3 0 1 3\n3 1 4 3\n3 1 2 4\n3 2 0 4\n3 0 3 4\n3 1 0 5\n3 2 1 5\n3 0 2 5\n";
  const test::ProcessResult stl = sterna({"repair", "far.off", "-o", "far.stl"}), obj = sterna({"repair", "far.off", "-o", "far.obj"});
  ASSERT_EQ(stl.status, 0) << stl.errors;
  EXPECT_THAT(stl.output + stl.errors, HasSubstr("STL is single precision, which merges 1 of 6 vertices with others"));
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
  for (const char* requested : {"repair = true", "repair = { hole = 0.5 }", "auto = true"})
    EXPECT_THAT(run("print(read_surface{ " + open + ", " + requested + " })"), HasSubstr("closed")) << requested;
  EXPECT_THAT(run("print(repair{ read_surface{ " + open + ", allow_open = true } })"), HasSubstr("closed"));
  EXPECT_THAT(error("read_surface{ " + open + ", repair = true, wrap = true }"), HasSubstr("at most one of repair, wrap and auto"));
  EXPECT_THAT(error("read_surface{ " + open + ", repair = { hoel = 1 } }"), HasSubstr("hole"));
}

TEST_F(AutoSurfaceTest, OverlappingCadPartsAreUnited) {
  run("box{ {0, 0, 0}, {1, 1, 1}, name = 'a' }:write(" + out("a.step") + ") box{ {0.5, 0.25, 0.25}, {2, 0.75, 0.75}, name = 'b' }:write(" + out("b.step") +
      ")");
  const test::ProcessResult result = sterna({"surface", "a.step", "b.step", "-o", "hull.stl"});
  ASSERT_EQ(result.status, 0) << result.errors;
  EXPECT_THAT(result.output + result.errors, HasSubstr("2 closed parts intersect and were united: 1 closed now"));
}

/// TetGen split boundary triangles here ("2 boundary triangles that are no face of a tetrahedron") until repair joined touching parts. A new input for such
/// splits of the wall is still to be found.
TEST_F(AutoSurfaceTest, TetGenFillsRocketAtFirstAttempt) {
  STERNA_NEEDS_SHARED_DATA();
  const test::ProcessResult split = sterna({"mesh", (test::shared_data() / "surfaces/nasty/martlet_rocket_Martlet2.stl").string(), "-o", "rocket.su2", "--auto",
                                            "--layers", "1", "--first-height", "0.1", "--engine", "tetgen", "--improve-rounds", "0", "--threads", "1"});
  ASSERT_EQ(split.status, 0) << split.errors;
  EXPECT_THAT(split.output + split.errors, Not(HasSubstr("trying")));
  EXPECT_EQ(nlohmann::json::parse(text_of("rocket.su2.json"))["verdict"], "VALID");
}

}  // namespace
}  // namespace sterna::scripting
