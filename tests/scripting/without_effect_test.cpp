// A command-line option that the input cannot use is an error with the name of the option and the reason; nothing is ignored silently.
#include <gmock/gmock.h>

#include "scripting/terminal/exit_status.h"
#include "tests/scripting/script_fixture.h"
#include "tests/support/process.h"

namespace sterna::scripting {
namespace {

using testing::AllOf;
using testing::HasSubstr;
using testing::Not;

class WithoutEffect : public ScriptFixture {
 protected:
  WithoutEffect() {
    std::filesystem::copy(test::corpus() / "scripts" / "box.stl", folder_ / "box.stl");
    run("box{ {0, -0.1, 0}, {1, 0.2, 0.3} }:write(" + out("box.step") + ")");
    run("fuselage{ name = 'b', along = 'smooth', frames = { {x=0,diameter=0.6}, {x=2,diameter=1.2}, {x=6,diameter=1} } }:model():write(" + out("b.smx") + ")");
  }
  test::ProcessResult sterna(const std::vector<std::string>& arguments) const { return test::run_process(test::sterna_program(), arguments, folder_); }
};

TEST_F(WithoutEffect, RequestsAreRefusedByName) {
  const std::vector<std::string> mesh_stl = {"mesh", "box.stl", "-o", "m.su2", "--first-height", "1e-3"},
                                 mesh_step = {"mesh", "box.step", "-o", "m.su2", "--first-height", "1e-3"};
  const auto with = [](std::vector<std::string> words, const std::vector<std::string>& more) {
    words.insert(words.end(), more.begin(), more.end());
    return words;
  };
  const std::vector<std::pair<std::vector<std::string>, std::string>> cases = {
      {with(mesh_step, {"--split-angle", "40"}), "option split_angle: applies to triangulations"},
      {with(mesh_step, {"--set", "surface.split_angle=40"}), "applies to triangulations"},
      {with(mesh_step, {"--repair"}), "is a model"},
      {with(mesh_stl, {"--set", "surface_mesh.max_edge=0.2"}), "applies to the faces of models"},
      {with(mesh_stl, {"--set", "repair.gap=1e-3"}), "is given without --repair"},
      {with(mesh_stl, {"--set", "wrap.edge=1e-3"}), "is given without --wrap"},
      {with(mesh_stl, {"--set", "remesh.max_edge=1"}), "is given without --remesh"},
      {with(mesh_stl, {"--set", "half.at=1"}), "is given without --half"},
      {with(mesh_stl, {"--patch", "*:max_edge=0.1"}), "--remesh makes triangles with such sizes"},
      {with(mesh_stl, {"--cache-limit", "1e9"}), "--cache"},
      {with(mesh_stl, {"--patch", "nothing*:layers=3"}), "nothing*"},
      {{"surface", "box.stl", "--auto", "-o", "a.stl", "--max-edge", "0.1"}, "no effect, because box.stl is a triangulation: max_edge"},
      {{"surface", "box.stl", "--auto", "-o", "a.stl", "--source", "point 0 0 0 size=0.1"}, "no effect, because box.stl is a triangulation: --source"},
      {{"surface", "b.smx", "-o", "a.stl", "--unit", "mm"}, "option read_cad.unit has no effect"},
      {{"info", "b.smx", "--unit", "mm"}, "option read_cad.unit has no effect"},
      {{"check", "box.step", "--strict"}, "--strict has no effect"},
      {{"check", "box.step", "--gate", "orthogonality:none", "--no-intersections"}, "have no effect: box.step is a model"},
      {{"convert", "box.step", "a.step", "--numbering", "both"}, "--numbering has no effect"},
      {{"convert", "box.stl", "a.obj", "--numbering", "both"}, "--numbering has no effect"},
      {{"convert", "box.stl", "a.obj", "--unit", "mm"}, "applies to models"},
      {{"report", "box.stl", "-o", "a.html", "--gate", "orthogonality:hard=3"}, "--gate has no effect"},
      {{"report", "box.stl", "-o", "a.html", "--cut", "x=0"}, "no cells to cut"},
      {{"draw", "box.stl", "-o", "a.png", "--places"}, "this file is a surface"},
      {{"draw", "box.stl", "-o", "a.png", "--cut", "x=0.5"}, "no cells to cut"},
      {{"inspect", "box.stl", "--set", "half.at=0.1"}, "is given without --half"},
      {{"inspect", "box.stl", "--max-edge", "0.1"}, "max-edge"},
      {{"inspect", "box.stl", "--set", "surface_mesh.max_edge=0.1"}, "applies to the faces of models"},
      {{"union", "box.stl", "-o", "u.stl", "--tolerance", "1e-3"}, "tolerance"},
  };
  for (const auto& [arguments, text] : cases) {
    const test::ProcessResult result = sterna(arguments);
    std::string line;
    for (const std::string& word : arguments) line += word + " ";
    EXPECT_EQ(result.status, k_exit_usage) << line << result.errors;
    EXPECT_THAT(result.errors, HasSubstr(text)) << line;
  }
}

TEST_F(WithoutEffect, FarfieldOptionsOfOtherShapesAreErrors) {
  const auto mesh = [&](const std::vector<std::string>& more) {
    std::vector<std::string> words = {"mesh", "box.stl", "-o", "m.su2", "--first-height", "1e-3", "--layers", "2"};
    words.insert(words.end(), more.begin(), more.end());
    return sterna(words);
  };
  const test::ProcessResult box = mesh({"--farfield-shape", "box", "--farfield-radius", "50"}), sphere = mesh({"--farfield-from-x", "-3"});
  EXPECT_EQ(box.status, k_exit_usage);
  EXPECT_THAT(box.errors, HasSubstr("the shape \"box\" does not have farfield_radius = 50"));
  EXPECT_EQ(sphere.status, k_exit_usage);
  EXPECT_THAT(sphere.errors, HasSubstr("does not have farfield_from_x = -3"));
}

TEST_F(WithoutEffect, RequestsWithoutEffectOnThisModelAreWarnings) {
  const test::ProcessResult made = sterna({"mesh", "box.stl", "-o", "m.su2", "--first-height", "5e-3", "--layers", "2", "--farfield-radius", "4",
                                           "--ends-growth", "1.4", "--patch", "*:blend=0.05", "--source", "sphere 300 0 0 radius=50 size=20"});
  EXPECT_EQ(made.status, k_exit_success) << made.errors;
  EXPECT_THAT(made.errors, AllOf(HasSubstr("ends_growth = 1.4 has no effect"), HasSubstr("blend = 0.05 m of patches[\"*\"] has no effect"),
                                 HasSubstr("source 1 (sphere about (300, 0, 0), size 20 m) lies completely outside the fluid")));
}

TEST_F(WithoutEffect, BlendsBetweenDifferentLayersAreNotReported) {
  const test::ProcessResult made = sterna({"mesh", "box.stl", "-o", "m.su2", "--first-height", "5e-3", "--layers", "2", "--farfield-radius", "4",
                                           "--split-angle", "40", "--patch", "*:blend=0.05", "--patch", "*_1:first_height=2e-3"});
  EXPECT_EQ(made.status, k_exit_success) << made.errors;
  EXPECT_THAT(made.errors, Not(HasSubstr("has no effect")));
}

TEST_F(WithoutEffect, TheTimeLimitHoldsForReadingModels) {
  const std::string shown = sterna({"--show-options", "mesh", "box.step", "-o", "m.su2", "--first-height", "1e-3", "--time-limit", "61"}).output;
  std::size_t n = 0;
  for (std::size_t at = shown.find("time_limit"); at != std::string::npos; at = shown.find("time_limit", at + 1))
    n += shown.substr(at, shown.find('\n', at) - at).find("61") != std::string::npos ? 1 : 0;
  EXPECT_EQ(n, 2u) << shown;  // options of the engines and of reading
  const std::string help = sterna({"mesh", "--help"}).output;
  EXPECT_THAT(help, HasSubstr("read_cad.time_limit"));
  EXPECT_THAT(help, HasSubstr("for models: 1e-09 .. 1e+06 m"));
}

TEST_F(WithoutEffect, RetryOfSeriesMayBeSet) {
  std::ofstream(folder_ / "s.lua") << "series{ 's', over = { a = {1, 2} }, case = function(p) if p.a == 2 then error('no') end return { value = p.a } end }";
  EXPECT_THAT(sterna({"run", "s.lua", "--set", "series.retry=true"}).errors, Not(HasSubstr("unknown option")));
  EXPECT_THAT(sterna({"run", "s.lua", "--set", "series.retri=true"}).errors, HasSubstr("retri"));
}

TEST_F(WithoutEffect, UnstoredNamesAndKindsAreWarnings) {
  const std::string kinds = "surface_mesh{ box{ name = 'floor', {0, 0, 0}, {1, 1, 1} }:kinds{ ['*'] = 'slip' } }";
  run(kinds + ":write(" + out("k.stl") + ")");
  EXPECT_THAT(log_, AllOf(HasSubstr("binary STL has no patches: the kinds of"), HasSubstr("(slip) are lost"), HasSubstr("Formats with names: STL text, OBJ")));
  log_.clear();
  run(kinds + ":write(" + out("k.obj") + ")");
  EXPECT_THAT(log_, Not(HasSubstr("are lost")));
}

TEST_F(WithoutEffect, TheUnitOfAModelCounts) {
  const std::string as_it_is = sterna({"info", "box.step"}).output, in_metres = sterna({"info", "box.step", "--unit", "1"}).output,
                    in_mm = sterna({"info", "box.step", "--unit", "1mm"}).output;
  EXPECT_EQ(as_it_is, in_metres);  // our STEP files are in metres
  EXPECT_NE(as_it_is, in_mm);
  EXPECT_THAT(in_mm, HasSubstr("0.001 x 0.0003 x 0.0003 m"));
  EXPECT_THAT(sterna({"info", "box.step", "--unit", "1000", "--json"}).output, HasSubstr("1000.0"));
}

TEST_F(WithoutEffect, UnknownExtensionsListWhatIsAskedFor) {
  EXPECT_THAT(sterna({"check", "mesh.foo"}).errors, AllOf(HasSubstr("CGNS"), HasSubstr("SU2"), Not(HasSubstr("LaWGS"))));
  EXPECT_THAT(sterna({"mesh", "box.stl", "-o", "mesh.foo", "--first-height", "1e-3"}).errors, AllOf(HasSubstr("volume mesh"), Not(HasSubstr("Nastran"))));
}

TEST_F(WithoutEffect, CasesInFoldersWithBlanksAreRefused) {
  EXPECT_THAT(sterna({"foam-case", "none.sterna", "-o", "my case", "--reynolds", "1e6", "--length", "1"}).errors,
              AllOf(HasSubstr("my case has a blank"), HasSubstr("choose a folder")));
}

TEST_F(WithoutEffect, InspectTakesAHalf) {
  const test::ProcessResult whole = sterna({"inspect", "box.step"}), half = sterna({"inspect", "box.step", "--half"});
  EXPECT_THAT(whole.output, HasSubstr("closed"));
  EXPECT_THAT(half.output, HasSubstr("not closed"));
  EXPECT_EQ(half.status, k_exit_success) << half.output << half.errors;
  const test::ProcessResult of_triangles = sterna({"inspect", "box.stl", "--half", "--set", "half.axis=z", "--set", "half.at=0.5"});
  EXPECT_THAT(of_triangles.output, HasSubstr("not closed")) << of_triangles.errors;
}

/// A source acts on both wall and volume.
TEST_F(WithoutEffect, SourcesRefineModelWallsAndWarnElsewhere) {
  const auto facets = [&](const std::vector<std::string>& more) {
    std::vector<std::string> words = {"mesh", "box.step",          "-o", "m.sterna", "--first-height",           "5e-3", "--layers",
                                      "2",    "--farfield-radius", "4",  "--set",    "surface_mesh.max_edge=0.2"};
    words.insert(words.end(), more.begin(), more.end());
    const test::ProcessResult made = sterna(words);
    EXPECT_EQ(made.status, k_exit_success) << made.errors;
    const std::string json = sterna({"info", "m.sterna", "--json"}).output;
    return json;
  };
  const std::string plain = facets({}), refined = facets({"--source", "sphere 0 0 0 radius=0.2 size=0.05"});
  const auto wall_triangles = [](const std::string& json) {
    const std::size_t at = json.find("\"wall\""), number = json.find("\"triangles\": ", at);
    return std::stoi(json.substr(number + 13));
  };
  EXPECT_GT(wall_triangles(refined), wall_triangles(plain) + 50);
  const test::ProcessResult stl = sterna({"mesh", "box.stl", "-o", "s.sterna", "--first-height", "5e-3", "--layers", "2", "--farfield-radius", "4", "--source",
                                          "sphere 0 0 0 radius=0.2 size=0.1"});
  EXPECT_THAT(stl.errors, HasSubstr("--remesh refines the wall, too"));
}

}  // namespace
}  // namespace sterna::scripting
