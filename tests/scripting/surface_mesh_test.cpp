// From models to triangles as a user requests it: surface_mesh{}, `sterna surface`, `sterna mesh` of a model.
#include <gmock/gmock.h>

#include <cmath>
#include <fstream>

#include "geom/base/error.h"
#include "io/file/volume_file.h"
#include "scripting/terminal/exit_status.h"
#include "tests/scripting/script_fixture.h"
#include "tests/support/data.h"
#include "tests/support/process.h"

namespace sterna::scripting {
namespace {

using testing::AllOf;
using testing::HasSubstr;
using testing::Not;

class SurfaceMeshVerb : public ScriptFixture {
 protected:
  test::ProcessResult sterna(const std::vector<std::string>& arguments) { return test::run_process(test::sterna_program(), arguments, folder_); }
};

TEST_F(SurfaceMeshVerb, ClosedModelMakesWallForVolumeMesh) {
  EXPECT_EQ(run("local w = surface_mesh{ box{ {0,0,0}, {1,1,1}, name='block' }, max_edge=0.5 } "
                "print(w.is_closed, w.crossings, w.absorbed, w.min_angle > 25*deg, table.concat(w.patches, ' '), w.length) "
                "local m = volume_mesh{ w, layers=3, first_height=1e-3, farfield=sphere{ radius=10 } } m:check() m:write(" +
                out("block.su2") + ") print(m.prisms == 3*w.triangles)")
                .find("true\t0\t0\ttrue\tblock\t1"),
            0u);
  EXPECT_THAT(log_, AllOf(HasSubstr("closed, 1 patch"), HasSubstr("worst angle on \"block\" at (")));
  const std::string manifest = text_of("block.su2.json");
  EXPECT_THAT(manifest, AllOf(HasSubstr("\"surface_mesh\""), HasSubstr("\"max_edge\": 0.5"), Not(HasSubstr("surface_patches"))));
}

TEST_F(SurfaceMeshVerb, PatchSizesWithLongestPatternFirst) {
  const std::string model =
      "local m = assembly{ box{ {0,0,0}, {1,1,1}, name='wing' }, box{ {3,0,0}, {4,1,1}, name='wing_tip' } } local function n(o) o[1] = m o.max_edge = 0.5 "
      "return surface_mesh(o).triangles end ";
  EXPECT_EQ(run(model + "local all, tip, both = n{}, n{ patches={ wing_tip={ max_edge=0.25 } } }, n{ patches={ ['wing*']={ max_edge=0.25 } } } "
                        "print(tip > 1.5*all, both > 1.2*tip, n{ patches={ ['wing*']={ max_edge=0.25 }, wing_tip={ max_edge=0.5 } } } < both)"),
            "true\ttrue\ttrue\n");
  // Models given as several entries are placed side by side, also components; --set has priority.
  EXPECT_EQ(
      run("print(table.concat(surface_mesh{ box{ {0,0,0}, {1,1,1} }, box{ {2,0,0}, {3,1,1} }, boom{ from={0,0,3}, to={2,0,3}, diameter=0.5 } }.patches, ' '))"),
      "box box2 boom\n");
  EXPECT_EQ(run("print(surface_mesh{ box{ {0,0,0}, {1,1,1} }, max_edge=0.1 }.triangles < 200)", {{"surface_mesh.max_edge", "0.5"}}), "true\n");
}

TEST_F(SurfaceMeshVerb, OpenSurfacesAndCrossingsAreTold) {
  EXPECT_EQ(run("print(surface_mesh{ surface{ function(u, v) return u, v, 0.1*u*v end, u={0,1}, v={0,1}, name='sheet' }, max_edge=0.3 }.is_closed)"),
            "false\n");
  EXPECT_THAT(log_, AllOf(HasSubstr("open: "), HasSubstr("along 2 m in the plane z = 0 m, 2 edges"), HasSubstr("of face \"sheet\" about (1, 0.5, 0.05)")));
  const std::string boxes = "surface_mesh{ box{ {0,0,0}, {1,1,1} }, box{ {0.5,0.3,0.3}, {2,0.7,0.7}, name='bar' }, max_edge=0.4";
  EXPECT_THAT(error(boxes + " }"), AllOf(HasSubstr("pairs of triangles cross"), HasSubstr("\"bar\""), HasSubstr("union{")));
  EXPECT_EQ(run("print(" + boxes + ", crossings='warn' }.crossings > 0)"), "true\n");
  EXPECT_THAT(log_, HasSubstr("warning: "));
  EXPECT_THAT(log_, HasSubstr("pairs of triangles cross"));
}

TEST_F(SurfaceMeshVerb, MistakesAreNamedTogether) {
  const std::string block = "box{ {0,0,0}, {1,1,1}, name='block' }";
  EXPECT_THAT(error("surface_mesh{ " + block + ", max_egde = 1 }"),
              HasSubstr("case.lua:1: surface_mesh: unknown key \"max_egde\", did you mean \"max_edge\"?"));
  EXPECT_THAT(error("surface_mesh{ " + block + ", max_edge=-1, curvature_angle=12, patches={ block={ max_egde=1, leading_edge={ chordwse=0.004 } }, tip=3 } }"),
              AllOf(HasSubstr("4 problems in this table"), HasSubstr("max_edge: -1 is not allowed"), HasSubstr("write degrees as 40*deg"),
                    HasSubstr("patches[\"block\"]: 2 problems"), HasSubstr("unknown key \"max_egde\", did you mean \"max_edge\"?"),
                    HasSubstr("unknown key \"leading_edge.chordwse\""),
                    HasSubstr("patches[\"tip\"]: expected a table with options of these patches, such as { max_edge = 0.1 }, not a number")));
  EXPECT_THAT(error("surface_mesh{ " + block + ", patches={ ['wing*']={ max_edge=1 } } }"),
              AllOf(HasSubstr("no face has a name like \"wing*\""), HasSubstr("block")));
  EXPECT_THAT(error("surface_mesh{}"), HasSubstr("needs a model"));
  EXPECT_THAT(error("surface_mesh{ 'a.step' }"), HasSubstr("entry 1: expected a model (from read_cad, aircraft ...) or a component, not a string"));
  EXPECT_THAT(error("surface_mesh{ surface_mesh{ " + block + " } }"), HasSubstr("which has triangles already: pass it to volume_mesh"));
  EXPECT_THAT(error("volume_mesh{ " + block + ", first_height=1e-3 }"), HasSubstr("expected a surface (from surface_mesh or read_surface), not a model"));
}

TEST_F(SurfaceMeshVerb, SourcesAndFunctionsMakeShorterEdges) {
  const std::string model = "local m = box{ {0,0,0}, {4,4,4}, name='block' } local function n(o) o[1] = m o.max_edge = 1 return surface_mesh(o) end ";
  EXPECT_EQ(run(model + "local plain = n{}.triangles "
                        "print(n{ sources={ sphere{ {0,0,0}, radius=0.5, size=0.05 } } }.triangles > 5*plain, n{ sources={ point{ {0,0,9}, size=0.05 } } "
                        "}.triangles == plain, "
                        "n{ size=function(x, y, z) return 0.1 + z end }.triangles > 5*plain)"),
            "true\ttrue\ttrue\n");
  EXPECT_THAT(error(model + "n{ sources={ 3 }, size=0.2 }"),
              AllOf(HasSubstr("2 problems"), HasSubstr("sources, entry 1: expected a source"), HasSubstr("size: expected a function of x, y, z")));
  EXPECT_THAT(error(model + "n{ sources={ sphere{ {0,0,0}, raduis=0.5, size=0.05 } } }"),
              AllOf(HasSubstr("unknown key \"raduis\", did you mean \"radius\"?"), HasSubstr("sphere takes a point, size, radius")));
  EXPECT_THAT(error(model + "n{ size=function(x, y, z) return -z end }"), HasSubstr("the size function returns"));
  EXPECT_THAT(error(model + "n{ size=function(x, y, z) return nil + 1 end }"), HasSubstr("case.lua:1"));
  EXPECT_THAT(run("help(surface_mesh)"), AllOf(HasSubstr("gap_cells"), HasSubstr("sources = {")));
  // Manifests store the sources, and so do stage files.
  run("local w = surface_mesh{ box{ {0,0,0}, {1,1,1}, name='block' }, max_edge=0.5, sources={ point{ {0,0,0}, size=0.2 } } } "
      "volume_mesh{ w, layers=3, first_height=1e-3, farfield=sphere{ radius=10 } }:write(" +
      out("s.su2") + ")");
  EXPECT_THAT(text_of("s.su2.json"), AllOf(HasSubstr("\"surface_sources\""), HasSubstr("\"kind\": \"point\"")));
}

TEST_F(SurfaceMeshVerb, TheCommandLineTakesPatchesAndSources) {
  run("assembly{ box{ {0,0,0}, {1,1,1}, name='wing' }, box{ {3,0,0}, {4,1,1}, name='body' } }:write(" + out("two.step") + ")");
  const auto triangles = [&](const std::vector<std::string>& more) {
    std::vector<std::string> arguments = {"surface", "two.step", "-o", "w.su2", "--max-edge", "0.5"};
    arguments.insert(arguments.end(), more.begin(), more.end());
    const test::ProcessResult result = sterna(arguments);
    EXPECT_EQ(result.status, k_exit_success) << result.errors;
    const std::string text = text_of("w.su2");
    int n = 0;  // a surface stores its triangles as markers
    constexpr std::string_view key = "MARKER_ELEMS=";
    for (std::size_t at = text.find(key); at != std::string::npos; at = text.find(key, at + 1)) n += std::stoi(text.substr(at + key.size()));
    return n;
  };
  const int plain = triangles({}), wing = triangles({"--patch", "wing*:max_edge=0.1", "--patch", "*:curvature_angle=20,min_edge=1mm"}),
            source = triangles({"--source", "line 3 0 0 4 0 0 size=0.05 radius=50mm"});
  EXPECT_GT(wing, 5 * plain);
  EXPECT_GT(source, 3 * plain);
  for (const auto& [arguments, text] : std::vector<std::pair<std::vector<std::string>, std::string>>{
           {{"--patch", "wing*:max_egde=0.1"}, "did you mean \"max_edge\"?"},
           {{"--patch", "wing"}, "is not NAMES:OPTION=VALUE"},
           {{"--patch", "tail:max_edge=0.1"}, "no face has a name like \"tail\""},
           {{"--source", "ball 0 0 0 size=1"}, "\"ball\" is not a kind of source"},
           {{"--source", "point 0 0 size=1"}, "expected 3 coordinates, found 2"},
           {{"--source", "sphere 0 0 0 size=1 raduis=2"}, "did you mean \"radius\"?"},
           {{"--source", "line 0 0 0 1 0 0 size=1 thickness=2"}, "line takes two points, size, radius"},
           {{"--source", "point 0 0 0 size=12deg"}, "is an angle, expected a length"},
           {{"--max-edge", "12deg"}, "is an angle, expected a length"}}) {
    std::vector<std::string> all = {"surface", "two.step", "-o", "w.su2"};
    all.insert(all.end(), arguments.begin(), arguments.end());
    const test::ProcessResult result = sterna(all);
    EXPECT_NE(result.status, k_exit_success) << text;
    EXPECT_THAT(result.errors, HasSubstr(text));
  }
}

TEST_F(SurfaceMeshVerb, AFileOfStepsKeepsTheOptions) {
  run("local w = surface_mesh{ box{ {0,0,0}, {1,1,1}, name='block' }, max_edge=0.5, patches={ ['b*']={ max_edge=0.4, curvature_angle=20*deg } } } "
      "local e = make_envelope{ w, layers=3, first_height=1e-3, farfield=sphere{ radius=10 } } e:write(" +
      out("steps.sterna") + ") local t = tetrahedra{ e } prisms{ e, t }:write(" + out("a.su2") + ")");
  run("local s = read_stages(" + out("steps.sterna") + ") prisms{ s.envelope, tetrahedra{ s.envelope } }:write(" + out("b.su2") + ")");
  EXPECT_EQ(text_of("a.su2"), text_of("b.su2"));
  const auto after_name = [](std::string text) { return text.substr(text.find("\"seed\"")); };
  EXPECT_EQ(after_name(text_of("a.su2.json")), after_name(text_of("b.su2.json")));
  EXPECT_THAT(text_of("b.su2.json"), AllOf(HasSubstr("\"surface_patches\""), HasSubstr("\"names\": \"b*\"")));
}

TEST_F(SurfaceMeshVerb, TheCommandLineMeshesModels) {
  run("local b = box{ {0,0,0}, {1,1,1}, name='block' } b:write(" + out("block.step") +
      ") "
      "aircraft{ fuselage{ name='body', along='akima', frames={ {x=0, diameter=0.6}, {x=2, diameter=1}, {x=4, diameter=0.5} } }, "
      "wing{ name='wing', symmetric=true, trailing_edge=0, position={1.5,0,0}, sections={ {y=0, chord=1, airfoil='naca0012'}, {y=2, chord=0.6} } }, "
      "unite=false }:write(" +
      out("plane.smx") + ")");
  EXPECT_THAT(sterna({"--help"}).output, HasSubstr("surface"));
  EXPECT_THAT(sterna({"surface", "--help"}).output,
              AllOf(HasSubstr("--max-edge"), HasSubstr("--curvature-angle"), HasSubstr("--refinement"), HasSubstr("--cap")));
  const test::ProcessResult made = sterna({"surface", "block.step", "-o", "wall.su2", "--max-edge", "0.5", "--curvature-angle", "12"});
  EXPECT_EQ(made.status, k_exit_success) << made.errors;
  EXPECT_THAT(made.errors, AllOf(HasSubstr("wrote wall.su2: TriMesh: "), HasSubstr("closed, 1 patch"), HasSubstr("m long; angles ")));
  EXPECT_THAT(sterna({"-v", "surface", "block.step", "-o", "wall.su2", "--max-edge", "0.5"}).errors, HasSubstr("worst angle on \"block\""));
  EXPECT_THAT(sterna({"info", "wall.su2"}).output, HasSubstr("\"block\", wall"));
  // Components of sumo files are united: one closed surface without crossings.
  const test::ProcessResult plane = sterna({"surface", "plane.smx", "-o", "plane.stl", "--set", "surface_mesh.curvature_angle=20deg"});
  EXPECT_EQ(plane.status, k_exit_success) << plane.errors;
  EXPECT_THAT(plane.errors, AllOf(HasSubstr("closed, "), Not(HasSubstr("triangles cross"))));
  const test::ProcessResult mesh =
      sterna({"mesh", "block.step", "--layers", "3", "--first-height", "1e-3", "--set", "surface_mesh.max_edge=0.5", "-o", "m.su2"});
  EXPECT_EQ(mesh.status, k_exit_success) << mesh.errors;
  EXPECT_THAT(text_of("m.su2.json"), AllOf(HasSubstr("block.step"), HasSubstr("\"max_edge\": 0.5"), HasSubstr("\"VALID\"")));
}

TEST_F(SurfaceMeshVerb, TheCommandLineRefusesWhatItCannotMean) {
  run("box{ {0,0,0}, {1,1,1}, name='block' }:write(" + out("block.step") + ")");
  const std::vector<std::tuple<std::vector<std::string>, int, std::string>> cases = {
      {{"surface", "block.step", "-o", "w.su2", "--curvature-angle", "200"}, k_exit_usage, "200 deg"},
      {{"surface", "block.step", "-o", "w.su2", "--max-egde", "0.2"}, k_exit_usage, "there is no option of surface --max-egde, did you mean --max-edge?"},
      {{"surface", "block.step", "-o", "w.su2", "--set", "surface_mesh.max_egde=1"}, k_exit_usage, "did you mean \"surface_mesh.max_edge\"?"},
      {{"surface", "block.step", "-o", "w.docx"}, k_exit_failed, "w.docx"},
      {{"surface", "wall.stl", "-o", "w.su2"}, k_exit_usage, "the file is not a model"},
      {{"surface", "block.step", "-o", "w.su2", "--max-edge", "0.2", "--max-edge", "0.3"},
       k_exit_usage,
       "surface_mesh.max_edge is given twice, as 0.2 and as 0.3"},
      {{"surface", "block.step", "-o", "w.su2", "--max-edge", "0.2", "--set", "surface_mesh.max_edge=0.3"}, k_exit_usage, "given twice"},
      {{"surface", "block.step", "-o", "w.su2", "--max-edge", "0.2", "--min-edge", "0.3"}, k_exit_usage, "min_edge = 0.3 m is above max_edge = 0.2 m"},
      {{"surface", "nothing.step", "-o", "/proc/w.su2"}, k_exit_failed, "writing /proc/w.su2"},
      {{"union", "block.step", "block.step", "-o", "block.step"}, k_exit_usage, "is one of the inputs"},
      {{"mesh", "block.step", "--first-height", "1e-3", "--split-angle", "40deg", "-o", "m.su2"}, k_exit_usage, "split_angle"},
  };
  for (const auto& [arguments, status, text] : cases) {
    const test::ProcessResult result = sterna(arguments);
    EXPECT_EQ(result.status, status) << text << "\n" << result.errors;
    EXPECT_THAT(result.errors, HasSubstr(text));
  }
}

TEST_F(SurfaceMeshVerb, FeatureAngleFollowsSurfaceMeshAlsoThroughFile) {
  const std::string wall = "local w = surface_mesh{ cylinder{ {0,0,0}, {2,0,0}, radius=1, name='can' }, max_edge=0.6, curvature_angle=30*deg } ";
  const std::string make = "local e = make_envelope{ w, layers=3, first_height=1e-3, farfield=sphere{ radius=20 } } print(e.feature_angle / deg) ";
  // Arcs of at most 30 degrees: the feature angle is one degree above the angle between neighbouring triangles.
  const double angle = std::stod(run(wall + "w:write(" + out("wall.su2") + ") " + make));
  EXPECT_GT(angle, 20.0);
  EXPECT_LT(angle, 40.0);
  EXPECT_THAT(log_, AllOf(HasSubstr("smooth regions turn by up to"), HasSubstr("where the model is smooth"), HasSubstr("least angles ")));
  EXPECT_THAT(text_of("wall.su2.json"), AllOf(HasSubstr("\"schema\": \"sterna-surface-1\""), HasSubstr("\"max_smooth_angle\""), HasSubstr("\"max_edge\": 0.6"),
                                              HasSubstr("\"mean_radius_ratio\"")));
  const std::string read = "local w = read_surface(" + out("wall.su2") + ") ";
  EXPECT_NEAR(std::stod(run(read + make)), angle, 1e-9);
  EXPECT_EQ(run(read + "print(w.smooth_angle > 10*deg)"), "true\n");
  // The user's own value has priority; a manifest for another state of the file is ignored.
  EXPECT_EQ(std::lround(std::stod(run(
                read +
                "local e = make_envelope{ w, layers=3, first_height=1e-3, feature_angle=50*deg, farfield=sphere{ radius=20 } } print(e.feature_angle / deg)"))),
            50);
  std::ofstream(folder_ / "wall.su2", std::ios::app) << "% edited\n";
  EXPECT_EQ(run(read + "print(pcall(function() return w.smooth_angle end))").substr(0, 5), "false");
  EXPECT_THAT(log_, HasSubstr("are ignored"));
}

/// The tail of this fuselage ends in a ring of 3 mm, whose edges are absorbed. After the union, the face begins with the seam and ends with that ring.
TEST_F(SurfaceMeshVerb, RingsThatAreAbsorbedCloseTheirFaces) {
  STERNA_NEEDS_SHARED_DATA();
  const std::string file = (test::shared_data() / "cpacs/boxWing.xml").string();
  EXPECT_EQ(run("local w = surface_mesh{ aircraft{ read_cpacs '" + file +
                "' }, max_edge = 2, min_edge = 0.17, growth = 1.46, curvature_angle = 38*deg } "
                "print(w.is_closed, w.absorbed > 2)"),
            "true\ttrue\n");
}

TEST_F(SurfaceMeshVerb, BoundarySplitsPutNewVerticesOnModel) {
  run("local w = surface_mesh{ cylinder{ {0,0,0}, {2,0,0}, radius=1, name='can' }, max_edge=0.6, curvature_angle=30*deg } "
      "volume_mesh{ w, layers=4, first_height=1e-3, farfield=sphere{ radius=15 }, sources={ sphere{ {3,0,0}, radius=1, size=0.1 } }, tetrahedra={ "
      "boundary_splits='always', radius_edge=1.6 } }:write(" +
      out("can.su2") + ")");
  EXPECT_THAT(text_of("can.su2.json"), HasSubstr("boundary_triangles_added_by_splits"));
  const HybridMesh mesh = io::read_volume_file(folder_ / "can.su2", RunContext{});
  int n_wall = 0;
  for (const auto& triangle : mesh.boundary_triangles) {
    if (mesh.patches[triangle.patch].name != "can") continue;
    for (const auto node : triangle.nodes) {
      const Point& p = mesh.points[node];
      EXPECT_LT(std::min({std::abs(std::hypot(p.y, p.z) - 1.0), std::abs(p.x), std::abs(p.x - 2.0)}), 1e-9) << format_point(p);
      ++n_wall;
    }
  }
  EXPECT_GT(n_wall, 1000);
}

}  // namespace
}  // namespace sterna::scripting
