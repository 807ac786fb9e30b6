// inspect{} in scripts and `sterna inspect`: files with defects, real surfaces, return values and exit status.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <fstream>
#include <iostream>
#include <map>
#include <nlohmann/json.hpp>
#include <set>
#include <sstream>

#include "io/file/surface_file.h"
#include "scripting/values/inspect_surface.h"
#include "tests/scripting/script_fixture.h"
#include "tests/support/process.h"
#include "tests/support/test_shapes.h"

namespace sterna::scripting {
namespace {

namespace fs = std::filesystem;
using testing::HasSubstr;
using volmesh::FindingKind;
using PlainJson = nlohmann::json;

class InspectFiles : public ScriptFixture {
 protected:
  std::string write(const TriMesh& mesh, const std::string& name) const {
    io::write_surface_file(mesh, folder_ / name, RunContext({.threads = 1}));
    return (folder_ / name).string();
  }
  Inspection inspect(const std::string& path, const surfmesh::StitchOptions& options = {}) const {
    const std::vector<InputPath> files = {{path, path}};
    return inspect_files(files, options, {}, RunContext({.threads = 2}));
  }
  test::ProcessResult sterna(const std::vector<std::string>& words) const {
    std::vector<std::string> all = {"inspect", "--quiet"};
    all.insert(all.end(), words.begin(), words.end());
    return test::run_process(test::sterna_program(), all, folder_);
  }
};

TEST_F(InspectFiles, NameATriangleThatWasTurnedOver) {
  TriMesh mesh = test::cube(4);
  const TriangleId t(70);
  std::swap(mesh.triangles[t][1], mesh.triangles[t][2]);
  const volmesh::InspectReport report = inspect(write(mesh, "flipped.stl"));
  ASSERT_EQ(report.findings.size(), 2u);
  const volmesh::Finding* turned = report.find(FindingKind::turned);
  ASSERT_TRUE(turned);
  EXPECT_EQ(turned->count, 1);
  EXPECT_EQ(turned->severity, volmesh::Severity::note);
  const auto [a, b, c] = corners(mesh, t);
  EXPECT_LT(distance(turned->locations.at(0).position, (a + b + c) / 3.0), 1e-6);
  EXPECT_TRUE(report.find(FindingKind::not_looked_at));
}

TEST_F(InspectFiles, RefusedFilesAreReportedAndInspected) {
  TriMesh mesh = test::cube(4);
  TriMesh open;
  open.points = mesh.points;
  open.patches = mesh.patches;
  for (const TriangleId t : mesh.triangles.ids()) {
    if (t.value() == 9) continue;
    open.triangles.push_back(mesh.triangles[t]);
    open.triangle_patch.push_back(PatchId(0));
  }
  const volmesh::InspectReport holed = inspect(write(open, "open.stl"));
  EXPECT_FALSE(holed.is_ok());
  ASSERT_TRUE(holed.find(FindingKind::open));
  EXPECT_THAT(holed.find(FindingKind::open)->text, HasSubstr("open along 3 edges around 1 hole"));
  EXPECT_TRUE(holed.mesh.n_triangles() == open.n_triangles() && !holed.is_closed);

  TriMesh fin = mesh;  // a triangle that stands on an edge
  const VertexId top = fin.points.push_back({0.5, 0.5, 2.0});
  fin.triangles.push_back({fin.triangles[TriangleId(0)][0], fin.triangles[TriangleId(0)][1], top});
  fin.triangle_patch.push_back(PatchId(0));
  const volmesh::InspectReport crowded = inspect(write(fin, "fin.stl"));
  EXPECT_FALSE(crowded.is_ok());
  ASSERT_TRUE(crowded.find(FindingKind::non_manifold));
  EXPECT_FALSE(crowded.find(FindingKind::non_manifold)->locations.empty());
  EXPECT_TRUE(crowded.find(FindingKind::not_looked_at));
  EXPECT_EQ(crowded.mesh.n_triangles(), fin.n_triangles());
}

TEST_F(InspectFiles, MillimetresReadAsMetresAreDoubted) {
  const std::string path = write(test::sphere(6, 2000.0), "sphere.stl");
  EXPECT_TRUE(inspect(path).find(FindingKind::unit));
  const volmesh::InspectReport right = inspect(path, {.unit = 1e-3});
  EXPECT_FALSE(right.find(FindingKind::unit));
  EXPECT_NEAR(right.length, 4.0, 0.1);
}

// ---- Required first step --------------------------------------------------------------------------------------------------------------

class Preparing : public InspectFiles {
 protected:
  static TriMesh without(const TriMesh& mesh, const std::set<std::uint32_t>& facets) {
    TriMesh rest;
    rest.points = mesh.points;
    rest.patches = mesh.patches;
    for (const TriangleId t : mesh.triangles.ids()) {
      if (facets.contains(t.value())) continue;
      rest.triangles.push_back(mesh.triangles[t]);
      rest.triangle_patch.push_back(mesh.triangle_patch[t]);
    }
    return rest;
  }
  /// Returns what --auto did: "nothing", or the first word of its change.
  static std::string done_by_auto(const std::string& path) {
    const std::vector<InputPath> files = {{path, path}};
    const SurfaceValue wall = auto_surface(files, {}, {}, RunContext({.threads = 2}));
    for (const std::string& change : changes_of(wall.history))  // remesh may follow
      if (change.starts_with("repaired") || change.starts_with("wrapped")) return change.substr(0, change.find(':'));
    return "nothing";
  }
  static std::string foreseen(const Preparation& preparation) {
    return preparation.needed == Strength::repair && preparation.is_changed ? "repaired" : preparation.needed == Strength::wrap ? "wrapped" : "nothing";
  }
};

TEST_F(Preparing, SoundSurfacesNeedNothing) {
  const Preparation p = inspect(write(test::sphere(8), "sphere.stl")).preparation;
  EXPECT_EQ(p.needed, Strength::none);
  EXPECT_TRUE(p.command.empty());
  EXPECT_EQ(p.seconds, 0.0);
  EXPECT_FALSE(p.is_remesh_advised);
}

TEST_F(Preparing, HolesAndCrossingsAreRepaired) {
  const std::string open = write(without(test::cube(4), {9, 40}), "open it.stl");
  const Preparation hole = inspect(open).preparation;
  EXPECT_EQ(hole.needed, Strength::repair);
  EXPECT_EQ(hole.forecast.n_holes, 2);
  EXPECT_EQ(hole.forecast.n_fillings, 2);
  EXPECT_THAT(hole.reason, HasSubstr("open along 6 edges around 2 holes"));
  EXPECT_EQ(hole.command, "sterna repair '" + open + "' -o 'open it_repaired.obj'");
  EXPECT_TRUE(hole.location.has_value());
  EXPECT_GT(hole.seconds, 0.0);
  EXPECT_THAT(hole.basis, HasSubstr("190 facets"));
  EXPECT_EQ(done_by_auto(open), "repaired");

  TriMesh two = test::cube(4), other = test::cube(4);
  for (Point& p : other.points) p += Vec3{0.5, 0.55, 0.45};
  append(two, other);
  const Preparation crossing = inspect(write(two, "two.stl")).preparation;
  EXPECT_EQ(crossing.needed, Strength::repair);
  EXPECT_GT(crossing.forecast.n_crossings, 0);
  EXPECT_GT(crossing.seconds, 0.0);
}

TEST_F(Preparing, WhatIsMostlyMissingIsWrapped) {
  // The smaller part of a sphere: a bowl, not a hole.
  const TriMesh whole = test::sphere(8);
  std::set<std::uint32_t> above;
  for (const TriangleId t : whole.triangles.ids()) {
    const auto c = corners(whole, t);
    if ((c[0] + c[1] + c[2]).z + 0.3 * (c[0] + c[1] + c[2]).x > -2.4) above.insert(t.value());
  }
  const std::string path = write(without(whole, above), "bowl.stl");
  const Preparation p = inspect(path).preparation;
  EXPECT_EQ(p.needed, Strength::wrap);
  EXPECT_GT(p.forecast.n_open, 0);
  EXPECT_GT(p.forecast.widest_open, 0.3);
  EXPECT_THAT(p.command, HasSubstr("sterna wrap "));
  EXPECT_THAT(p.reason, HasSubstr("repair leaves 1 opening"));
}

TEST_F(Preparing, NeedlesAskForRemesh) {
  TriMesh mesh = test::cube(4);
  for (Point& p : mesh.points) p.x *= 40.0;
  const std::string path = write(mesh, "rod.stl");
  const Preparation p = inspect(path).preparation;
  EXPECT_EQ(p.needed, Strength::remesh);
  EXPECT_GT(p.needle_share, 0.5);
  EXPECT_THAT(p.reason, HasSubstr("below 5 deg"));
  EXPECT_THAT(p.command, HasSubstr("sterna remesh "));
  const test::ProcessResult json = sterna({path, "--json"});
  const PlainJson reported = PlainJson::parse(json.output)["preparation"];
  EXPECT_EQ(reported["needed"], "remesh");
  EXPECT_EQ(reported["remesh"], true);
  EXPECT_DOUBLE_EQ(reported["needle_share"].get<double>(), p.needle_share);
  EXPECT_THAT(sterna({path}).output, HasSubstr("first remesh"));
  EXPECT_THAT(run("local p = inspect('" + path + "').preparation print(p.needed, p.remesh, p.seconds > 0, p.command:sub(1, 13))"),
              HasSubstr("remesh\ttrue\ttrue\tsterna remesh"));
}

TEST_F(Preparing, ModelsAreMeshedFirst) {
  run("box{ {0, 0, 0}, {1, 1, 1}, name = 'a' }:write(" + out("box.step") + ")");
  const test::ProcessResult result = sterna({"box.step", "--json"});
  ASSERT_EQ(result.status, 0) << result.errors;
  const PlainJson json = PlainJson::parse(result.output);
  EXPECT_TRUE(json["closed"]);
  EXPECT_EQ(json["preparation"]["needed"], "none");
  EXPECT_EQ(json["preparation"]["model"], true);
  EXPECT_THAT(run("print(inspect(" + out("box.step") + ").preparation.needed)"), HasSubstr("none"));
}

TEST_F(Preparing, TheSameForAnyThreads) {
  const std::string path = write(without(test::sphere(12), {9, 40, 41, 700}), "open.stl");
  std::set<std::string> texts;
  for (const char* threads : {"1", "2", "7"}) texts.insert(sterna({path, "--json", "--threads", threads}).output);
  EXPECT_EQ(texts.size(), 1u);
}

TEST_F(Preparing, ForeseesWhatAutoDoes) {
  STERNA_NEEDS_SHARED_DATA();
  const std::filesystem::path nasty = test::shared_data() / "surfaces" / "nasty";
  // One file of each kind: holes, seams, crossings, half models, baffles, intersecting bodies; and sound ones.
  for (const char* name :
       {"cgal_data_elephant-with-holes.off", "asb_talon_talon.stl", "uuv_propeller_1.stl", "pyhyp_dpw.fmt", "pyhyp_m6_small.fmt", "nasty_admesh_nearby-bad.stl",
        "nasty_arrangements_two_spheres.stl", "pdas_wgs_ex4.wgs", "netgen_parts_part1.stl", "nasty_trimesh_busted.STL"}) {
    SCOPED_TRACE(name);
    EXPECT_EQ(foreseen(inspect((nasty / name).string()).preparation), done_by_auto((nasty / name).string()));
  }
  // Shells whose openings are as large as the shells; another test checks that repair refuses them.
  for (const char* name : {"nasty_meshlab_non_manif_hole.ply", "cgal_data_b9_mesh.off", "cgal_data_degtri_sliding.off"})
    EXPECT_EQ(inspect((nasty / name).string()).preparation.needed, Strength::wrap) << name;
}

// ---- Scripts --------------------------------------------------------------------------------------------------------------------------------

TEST_F(InspectFiles, GiveScriptsATable) {
  const std::string path = write(test::cube(12), "cube.stl");
  const std::string printed =
      run("local wall = read_surface '" + path + "'\nlocal pre = inspect{ wall, layers = 30, first_height = 1e-4, max_thickness = 0.4 }\n" +
          "print(pre.ok, pre.errors, #pre.findings, pre.coverage > 0.99, pre.collapsed, pre.is_closed, pre.parts)");
  EXPECT_THAT(printed, HasSubstr("volume_mesh will accept it"));
  EXPECT_THAT(printed, HasSubstr("true\t0\t1\ttrue\t0.0\ttrue\t1"));
  EXPECT_THAT(run("local pre = inspect(read_surface '" + path + "') print(pre.coverage, pre.findings[1].kind)"), HasSubstr("nil\tnot_looked_at"));
  const std::string far = write(test::sphere(6, 2000.0), "sphere.stl");
  EXPECT_THAT(run("local f = inspect('" + far +
                  "').findings[1]\nprint(f.kind, f.severity, f.count, f.value > 3900, f.limit, f.unit, #f.places, f.at[1], f.advice:sub(1, 9))"),
              HasSubstr("unit\twarn\t1\ttrue\t1000.0\tm\t1"));
  EXPECT_THAT(run("print(inspect{ '" + far + "', unit = mm }.length < 4.1)"), HasSubstr("true"));
}

TEST_F(InspectFiles, TakeFlowsAndLimits) {
  const std::string wall = "local wall = read_surface '" + write(test::cube(12), "cube.stl") + "'\n";
  EXPECT_THAT(
      run(wall + "print(inspect{ wall, layers = 30, first_height = 1e-4, max_thickness = 0.4, flow = flow{ reynolds = 1e6, length = 1 } }.findings[1].kind)"),
      HasSubstr("\ny_plus\n"));
  EXPECT_THAT(error(wall + "inspect{ wall, flow = 7 }"), HasSubstr("flow: expected flow{"));
  EXPECT_THAT(error(wall + "inspect{ wall, first_hight = 1e-4 }"), HasSubstr("first_height"));
  EXPECT_THAT(error(wall + "inspect{ wall, unit = mm }"), HasSubstr("unit"));
  EXPECT_THAT(error("inspect{}"), HasSubstr("needs a surface or the name of a file"));
  EXPECT_THAT(error("inspect{ 7 }"), HasSubstr("entry 1: expected one surface or names of files"));
  EXPECT_THAT(error("inspect 'nothing.stl'"), HasSubstr("nothing.stl"));
  run(wall + "volume_mesh{ wall, layers = 2, first_height = 1e-2, farfield = sphere{ radius = 5 } }:write(" + out("box.su2") + ")");
  EXPECT_THAT(error("inspect(" + out("box.su2") + ")"), HasSubstr("it is a volume mesh of"));
  EXPECT_THAT(run("print(inspect(read_surface{ " + out("box.su2") + ", take_boundary = true }).ok)"), HasSubstr("true"));
}

TEST_F(InspectFiles, DrawTheTrouble) {
  const std::string path = write(test::cube(6), "cube.stl");
  run("inspect{ '" + path + "', layers = 20, first_height = 1e-4, output = " + out("trouble.vtu") + " }");
  const std::string text = text_of("trouble.vtu");
  for (const char* array : {"height_share", "visibility_angle_deg", "gap_m", "top_ratio", "Name=\"finding\"", "smallest_angle_deg", "<PointData>"})
    EXPECT_THAT(text, HasSubstr(array));
  const SurfaceSoup soup = io::read_surface_file(folder_ / "trouble.vtu", RunContext({.threads = 1}));
  EXPECT_EQ(soup.triangles.size(), test::cube(6).n_triangles());
  EXPECT_EQ(soup.patch_names.at(0), "wall");  // one file with one part
  EXPECT_THAT(error("inspect{ '" + path + "', output = 'trouble.stl' }"), HasSubstr(".vtu"));
}

// ---- The command line -----------------------------------------------------------------------------------------------------------------------

TEST_F(InspectFiles, AnswerTheShell) {
  const std::string cube = write(test::cube(12), "cube.stl");
  const test::ProcessResult good = sterna({cube, "--layers", "20", "--first-height", "1e-4"});
  EXPECT_EQ(good.status, 0) << good.errors;
  EXPECT_THAT(good.output, HasSubstr("volume_mesh will accept it"));
  const std::string far = write(test::sphere(6, 2000.0), "sphere.stl");
  EXPECT_EQ(sterna({far}).status, 0);
  EXPECT_EQ(sterna({far, "--strict"}).status, 1);
  EXPECT_EQ(sterna({far, "--strict", "--unit", "mm"}).status, 0);
  EXPECT_EQ(sterna({(folder_ / "nothing.stl").string()}).status, 1);
  EXPECT_EQ(sterna({cube, "--first-hight", "1"}).status, 2);
  TriMesh two = test::cube(4), other = test::cube(4);
  for (Point& p : other.points) p += Vec3{0.5, 0.55, 0.45};
  append(two, other);
  const test::ProcessResult bad = sterna({write(two, "two.stl"), "--json", "-o", (folder_ / "two.vtu").string()});
  EXPECT_EQ(bad.status, 1);
  const PlainJson json = PlainJson::parse(bad.output);
  EXPECT_EQ(json["schema"], "sterna-inspect-1");
  EXPECT_FALSE(json["ok"]);
  EXPECT_EQ(json["findings"][0]["kind"], "crossing");
  EXPECT_FALSE(json["findings"][0]["places"].empty());
  EXPECT_TRUE(fs::exists(folder_ / "two.vtu"));
  EXPECT_THAT(sterna({cube, "--layers", "20", "--first-height", "1e-4", "--flow", "reynolds=1e6 length=1"}).output, HasSubstr("y_plus"));
}

// ---- Real surfaces --------------------------------------------------------------------------------------------------------------------------

TEST_F(InspectFiles, EveryRealSurfaceHasAnAnswer) {
  STERNA_NEEDS_SHARED_DATA();
  std::map<std::string, std::string> verdicts;
  std::ifstream table(test::corpus() / "nasty_surfaces.tsv");
  for (std::string line; std::getline(table, line);) {
    std::istringstream fields(line);
    std::string file, verdict;
    if (!line.empty() && line[0] != '#' && std::getline(fields, file, '\t') && std::getline(fields, verdict, '\t')) verdicts[file] = verdict;
  }
  const std::map<std::string, FindingKind> kinds = {{"open_surface", FindingKind::open},          {"non_manifold_surface", FindingKind::non_manifold},
                                                    {"self_intersection", FindingKind::crossing}, {"not_orientable", FindingKind::not_orientable},
                                                    {"empty_surface", FindingKind::malformed},    {"file_malformed", FindingKind::malformed}};
  for (const char* folder : {"nasty", "clean"}) {
    for (const auto& entry : fs::directory_iterator(test::shared_data() / "surfaces" / folder)) {
      const std::string name = entry.path().filename().string();
      if (name.starts_with("f1_rear_wing")) continue;  // parts of one body
      SCOPED_TRACE(name);
      const volmesh::InspectReport report = inspect(entry.path().string(), {.take_boundary = true});
      const std::string verdict = verdicts.contains(name) ? verdicts[name] : "valid";
      std::cout << "| " << name << " | " << verdict << " | ";
      for (const volmesh::Finding& finding : report.findings)
        std::cout << to_string(finding.severity) << " " << to_string(finding.kind) << " " << finding.count << ", ";
      std::cout << "|\n";
      EXPECT_EQ(report.is_ok(), verdict == "valid");
      if (verdict == "valid") continue;
      ASSERT_TRUE(kinds.contains(verdict)) << verdict;
      EXPECT_TRUE(report.find(kinds.at(verdict))) << report.findings.front().text;
    }
  }
}

}  // namespace
}  // namespace sterna::scripting
