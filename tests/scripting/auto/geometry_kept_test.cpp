// Properties of a geometry that repair, wrap and --auto must preserve or warn about: unions of ducts, cavities, open domains, touching parts, nested bodies,
// baffles.
#include <gmock/gmock.h>

#include <cmath>
#include <nlohmann/json.hpp>
#include <numbers>

#include "geom/boolean/union_meshes.h"
#include "geom/math/measures.h"
#include "scripting/values/repair_surfaces.h"
#include "tests/scripting/script_fixture.h"
#include "tests/support/process.h"

namespace sterna::scripting {
namespace {

using testing::Contains;
using testing::HasSubstr;

using Triangles = std::vector<std::array<Vec3, 3>>;

struct NamedPart {
  std::string name;
  Triangles triangles;
};

void add_quad(Triangles& triangles, const Vec3& a, const Vec3& b, const Vec3& c, const Vec3& d) {
  triangles.push_back({a, b, c});
  triangles.push_back({a, c, d});
}

Triangles turned_over(Triangles triangles) {
  for (auto& t : triangles) std::swap(t[1], t[2]);
  return triangles;
}

/// Makes a pipe along an axis from `from` to `to`, about `center`, with the first corner at `phase`. Returns its side, its end at `from` and its end at `to`;
/// normals point outwards.
std::array<Triangles, 3> pipe(double radius, double from, double to, int n, std::size_t axis, const Vec3& center, double phase = 0.0) {
  const auto at = [&](double x, int k, double r) {
    const double angle = phase + 2.0 * std::numbers::pi * (k % n) / n;
    Vec3 p = center;
    p[axis] = x;
    p[(axis + 1) % 3] += r * std::cos(angle);
    p[(axis + 2) % 3] += r * std::sin(angle);
    return p;
  };
  std::array<Triangles, 3> parts;
  for (int k = 0; k < n; ++k) {
    add_quad(parts[0], at(from, k, radius), at(from, k + 1, radius), at(to, k + 1, radius), at(to, k, radius));
    parts[1].push_back({at(from, 0, 0.0), at(from, k + 1, radius), at(from, k, radius)});
    parts[2].push_back({at(to, 0, 0.0), at(to, k, radius), at(to, k + 1, radius)});
  }
  return parts;
}

Triangles all_of(const std::array<Triangles, 3>& parts) {
  Triangles all = parts[0];
  for (const std::size_t k : {1u, 2u}) all.insert(all.end(), parts[k].begin(), parts[k].end());
  return all;
}

Triangles block(const Vec3& a, const Vec3& b) {
  const auto p = [&](int x, int y, int z) { return Vec3{x ? b.x : a.x, y ? b.y : a.y, z ? b.z : a.z}; };
  Triangles t;
  add_quad(t, p(0, 0, 0), p(0, 1, 0), p(1, 1, 0), p(1, 0, 0));
  add_quad(t, p(0, 0, 1), p(1, 0, 1), p(1, 1, 1), p(0, 1, 1));
  add_quad(t, p(0, 0, 0), p(1, 0, 0), p(1, 0, 1), p(0, 0, 1));
  add_quad(t, p(0, 1, 0), p(0, 1, 1), p(1, 1, 1), p(1, 1, 0));
  add_quad(t, p(0, 0, 0), p(0, 0, 1), p(0, 1, 1), p(0, 1, 0));
  add_quad(t, p(1, 0, 0), p(1, 1, 0), p(1, 1, 1), p(1, 0, 1));
  return t;
}

double signed_volume(const Triangles& triangles) {
  double volume = 0.0;
  for (const auto& t : triangles) volume += tet_volume({}, t[0], t[1], t[2]);
  return volume;
}

double volume_of(const TriMesh& mesh) {
  double volume = 0.0;
  for (const TriangleId t : mesh.triangles.ids()) {
    const auto c = corners(mesh, t);
    volume += tet_volume({}, c[0], c[1], c[2]);
  }
  return volume;
}

std::vector<std::string> patches_of(const TriMesh& mesh) {
  std::vector<std::string> names;
  for (const Patch& patch : mesh.patches) names.push_back(patch.name);
  return names;
}

class GeometryKept : public ScriptFixture {
 protected:
  /// Writes an ASCII STL file with one solid for each part.
  InputPath write(const std::vector<NamedPart>& parts, const std::string& name = "in.stl") {
    std::ofstream file(folder_ / name);
    file.precision(12);
    for (const NamedPart& part : parts) {
      file << "solid " << part.name << "\n";
      for (const auto& t : part.triangles) {
        file << "facet normal 0 0 0\nouter loop\n";
        for (const Vec3& p : t) file << "vertex " << p.x << " " << p.y << " " << p.z << "\n";
        file << "endloop\nendfacet\n";
      }
      file << "endsolid " << part.name << "\n";
    }
    return {name, folder_ / name};
  }
  SurfaceValue automatic(const std::vector<NamedPart>& parts, const std::string& fluid = "outside") {
    const std::array files{write(parts)};
    AutoSurface options;
    options.stitching.fluid = fluid;
    log_.clear();
    const RunContext context({.threads = 1, .log = [&](LogLevel level, std::string_view line) {
                                log_ += (level == LogLevel::warning ? "warning: " : "") + std::string(line) + "\n";
                              }});
    return auto_triangles(files, options, {}, context);
  }
  test::ProcessResult sterna(const std::vector<std::string>& arguments) { return test::run_process(test::sterna_program(), arguments, folder_); }
};

/// Volume of the union by an independent method: exact corefinement.
double volume_of_union(const std::vector<Triangles>& solids) {
  std::vector<UnionPart> parts;
  for (const Triangles& solid : solids) {
    SurfaceSoup soup;
    soup.patch_names = {"wall"};
    for (const auto& t : solid) {
      const auto first = static_cast<std::uint32_t>(soup.points.size());
      soup.points.insert(soup.points.end(), t.begin(), t.end());
      soup.triangles.push_back({first, first + 1, first + 2});
      soup.patch.push_back(0);
    }
    parts.push_back({"part" + std::to_string(parts.size()), surfmesh::stitch_surface({soup}, {}, RunContext()).mesh});
  }
  return volume_of(unite_meshes(parts, {.remesh = false}, RunContext()).mesh);  // strips with new triangles would not be exact
}

TEST_F(GeometryKept, PipeTeeIsTheUnionOfInsides) {
  const auto main = pipe(0.2, -1, 1, 20, 0, {}), branch = pipe(0.15, 0, 1, 18, 2, {0.1, 0, 0}, 0.1);
  const SurfaceValue wall = automatic(
      {{"main", main[0]}, {"inlet", main[1]}, {"outlet", main[2]}, {"branch", branch[0]}, {"inner_end", branch[1]}, {"branch_out", branch[2]}}, "inside");
  EXPECT_THAT(patches_of(wall.mesh), Contains("branch_out"));
  EXPECT_NEAR(-volume_of(wall.mesh), volume_of_union({all_of(main), all_of(branch)}), 1e-6);
  EXPECT_THAT(log_, HasSubstr("warning: repair: the result has no patch \"inner_end\""));
}

TEST_F(GeometryKept, PipesThroughPlenumKeepEndsAndInnerBody) {
  const auto one = pipe(0.2, -2, 2, 12, 0, {}), other = pipe(0.1, -2, 2, 10, 1, {0.3, 0, 0.2}, 0.05);
  const Triangles plenum = block({-1, -1, -1}, {1, 1, 1}), body = block({-0.9, 0.4, 0.4}, {-0.5, 0.8, 0.8});
  const SurfaceValue wall = automatic(
      {{"plenum", plenum}, {"pipe", one[0]}, {"in", one[1]}, {"out", one[2]}, {"cross", other[0]}, {"left", other[1]}, {"right", other[2]}, {"body", body}},
      "inside");
  for (const char* name : {"in", "out", "left", "right", "plenum", "body"}) EXPECT_THAT(patches_of(wall.mesh), Contains(name));
  EXPECT_NEAR(-volume_of(wall.mesh), volume_of_union({plenum, all_of(one), all_of(other)}) - signed_volume(body), 1e-6);
}

TEST_F(GeometryKept, OppositeInnerShellIsKeptWhereItTouches) {
  const auto wheel = pipe(0.5, -0.2, 0.2, 12, 1, {0, 0, 0.5}, std::numbers::pi);  // touches the floor along one edge
  const Triangles box = block({-4, -2, 0}, {4, 2, 3});
  for (const char* fluid : {"outside", "inside"}) {
    const SurfaceValue wall = automatic({{"box", box}, {"wheel", turned_over(all_of(wheel))}}, fluid);
    EXPECT_THAT(patches_of(wall.mesh), Contains("wheel")) << fluid;
    EXPECT_NEAR(std::abs(volume_of(wall.mesh)), signed_volume(box) - signed_volume(all_of(wheel)), 1e-3 * signed_volume(box)) << fluid;
    EXPECT_THAT(log_, HasSubstr("touch")) << fluid;
  }
}

TEST_F(GeometryKept, PartsThatTouchAlongALineAreJoined) {
  const auto tube = pipe(0.5, 0, 4, 12, 0, {});
  std::vector<NamedPart> parts{{"tube", all_of(tube)}};
  double area = 0.0;
  parts.push_back({"fin1", block({1, -0.05, 0.5}, {3, 0.05, 1.5})});
  parts.push_back({"fin2", block({1, 0.5, -0.05}, {3, 1.5, 0.05})});
  for (const NamedPart& part : parts)
    for (const auto& t : part.triangles) area += triangle_area(t[0], t[1], t[2]);
  const SurfaceValue wall = automatic(parts);
  EXPECT_EQ(wall.report.n_components, 1);
  double now = 0.0;
  for (const TriangleId t : wall.mesh.triangles.ids()) {
    const auto c = corners(wall.mesh, t);
    now += triangle_area(c[0], c[1], c[2]);
  }
  EXPECT_NEAR(now, area, 1e-3 * area);
  EXPECT_THAT(log_, HasSubstr("touching parts joined"));
  EXPECT_THAT(log_, HasSubstr("are one part of the result"));
}

/// A body of revolution about x, from x = 0 to 1, with normals outwards. The result covers the angles from `first` on, over the fraction `share` of a turn.
Triangles spindle(double first, double share, int n, int m, double offset = 0.0) {
  const auto at = [&](int i, int k) {
    const double x = 0.5 * (1.0 - std::cos(std::numbers::pi * i / n)), r = i == 0 || i == n ? 0.0 : 0.2 * std::sqrt(x * (1.0 - x));
    const double angle = 2.0 * std::numbers::pi * (first + share * k / m);
    const auto clean = [](double v) { return std::abs(v) < 1e-12 ? 0.0 : v; };
    return Vec3{x, offset + clean(r * std::cos(angle)), clean(r * std::sin(angle))};
  };
  Triangles t;
  for (int i = 0; i < n; ++i)
    for (int k = 0; k < m; ++k) {
      if (i > 0) t.push_back({at(i, k), at(i, k + 1), at(i + 1, k)});
      if (i + 1 < n) t.push_back({at(i, k + 1), at(i + 1, k + 1), at(i + 1, k)});
    }
  return t;
}

TEST_F(GeometryKept, QuarterOfABodyIsAnOpenDomain) {
  const SurfaceValue wall = automatic({{"body", spindle(0.0, 0.25, 12, 5)}});
  EXPECT_FALSE(wall.report.is_closed);
  EXPECT_TRUE(changes_of(wall.history).empty());
  EXPECT_THAT(log_, HasSubstr("planes y = 0 m and z = 0 m"));
}

TEST_F(GeometryKept, HalfBesideTheOriginIsAnOpenDomain) {
  const SurfaceValue wall = automatic({{"body", spindle(-0.25, 0.5, 12, 8, 0.7)}});
  EXPECT_FALSE(wall.report.is_closed);
  EXPECT_THAT(log_, HasSubstr("plane y = 0.7 m"));
}

TEST_F(GeometryKept, SectionBetweenTwoPlanesIsAnOpenDomain) {
  const SurfaceValue wall = automatic({{"section", pipe(0.5, 0.2, 0.8, 16, 1, {})[0]}});
  EXPECT_FALSE(wall.report.is_closed);
  EXPECT_THAT(log_, HasSubstr("planes y = 0.2 m and y = 0.8 m"));
}

TEST_F(GeometryKept, LongTubeAndFaceHoleAreClosed) {
  EXPECT_TRUE(automatic({{"tube", pipe(0.5, 0, 9, 16, 0, {})[0]}}).report.is_closed);
  Triangles box = block({0, 0, 0}, {1, 1, 1});
  box.pop_back();
  EXPECT_TRUE(automatic({{"box", box}}).report.is_closed);
}

TEST_F(GeometryKept, InwardHalfModelWithFarfieldIsABody) {
  write({{"body", turned_over(spindle(-0.25, 0.5, 12, 8))}});
  const std::vector<std::string> more = {"--layers", "3", "--first-height", "2e-3", "--threads", "1", "-o", "m.su2"};
  const std::vector<std::vector<std::string>> beginnings = {{"mesh", "in.stl", "--auto"}, {"mesh", "in.stl", "--allow-open", "--farfield-radius", "10"}};
  for (const std::vector<std::string>& first : beginnings) {
    std::vector<std::string> words = first;
    words.insert(words.end(), more.begin(), more.end());
    const test::ProcessResult result = sterna(words);
    EXPECT_EQ(result.status, 0) << result.errors;
    EXPECT_THAT(result.output + result.errors, HasSubstr("with inward normals")) << first.back();
  }
}

TEST_F(GeometryKept, InnerBodyIsNamedWhereItBecomesCavity) {
  const std::array files{write({{"zone", block({-2, -2, -2}, {2, 2, 2})}, {"propeller", block({-1, -1, -0.1}, {1, 1, 0.1})}})};
  log_.clear();
  const RunContext context({.threads = 1, .log = [&](LogLevel level, std::string_view line) {
                              log_ += (level == LogLevel::warning ? "warning: " : "") + std::string(line) + "\n";
                            }});
  read_wall(files, {}, context);
  EXPECT_THAT(log_, HasSubstr("warning: part \"propeller\""));
  EXPECT_THAT(log_, HasSubstr("lies inside part \"zone\""));
}

TEST_F(GeometryKept, OpenSheetIsWarnedOf) {
  Triangles ground;
  const auto at = [](int i, int j) { return Vec3{0.1 * i, 0.1 * j, 0.02 * std::sin(1.7 * i) * std::cos(1.3 * j)}; };
  for (int i = 0; i < 8; ++i)
    for (int j = 0; j < 8; ++j) add_quad(ground, at(i, j), at(i + 1, j), at(i + 1, j + 1), at(i, j + 1));
  automatic({{"terrain", ground}});
  EXPECT_THAT(log_, HasSubstr("warning: auto: the surface is an open sheet"));
  EXPECT_THAT(log_, HasSubstr("give sides and a lid"));
}

TEST_F(GeometryKept, PatchLostInReadingIsWarnedOf) {
  // Closed, but without thickness: its two sides have different diagonals.
  Triangles sheet{{Vec3{2, 0, 0}, Vec3{3, 0, 0}, Vec3{3, 1, 0}},
                  {Vec3{2, 0, 0}, Vec3{3, 1, 0}, Vec3{2, 1, 0}},
                  {Vec3{2, 0, 0}, Vec3{2, 1, 0}, Vec3{3, 0, 0}},
                  {Vec3{3, 0, 0}, Vec3{2, 1, 0}, Vec3{3, 1, 0}}};
  write({{"box", block({0, 0, 0}, {1, 1, 1})}, {"sheet", sheet}});
  run("read_surface(" + out("in.stl") + ")");
  EXPECT_THAT(log_, HasSubstr("warning: reading: the result has no patch \"sheet\""));
}

TEST_F(GeometryKept, EveryVerbNotesFiguresForTheManifest) {
  write({{"box", block({0, 0, 0}, {1, 1, 1})}, {"rod", block({0.4, 0.4, 0.5}, {0.6, 0.6, 2})}});
  ASSERT_EQ(sterna({"mesh", "in.stl", "--auto", "--layers", "2", "--first-height", "1e-2", "--threads", "1", "-o", "m.su2"}).status, 0);
  const nlohmann::json changed = nlohmann::json::parse(text_of("m.su2.json")).at("changed");
  ASSERT_GE(changed.size(), 1u);
  EXPECT_EQ(changed.at(0).at("by"), "repair");
  EXPECT_NEAR(changed.at(0).at("volume").at("before").get<double>(), 1.06, 1e-9);
  EXPECT_NEAR(changed.at(0).at("volume").at("after").get<double>(), 1.04, 1e-6);
  EXPECT_EQ(changed.at(0).at("joined_parts").size(), 1u);
}

}  // namespace
}  // namespace sterna::scripting
