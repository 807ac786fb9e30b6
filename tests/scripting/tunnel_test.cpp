// Wind tunnels and half models in scripts: kinds, sizes and layers of patches from the verbs to the surface; fluid of tunnel and model; refused input.
#include <gmock/gmock.h>

#include <cmath>
#include <fstream>
#include <numbers>

#include "geom/base/error.h"
#include "tests/scripting/script_fixture.h"
#include "tests/support/data.h"
#include "tests/support/test_constants.h"

namespace sterna::scripting {
namespace {

using testing::AllOf;
using testing::HasSubstr;

class TunnelScripts : public ScriptFixture {};

using test::k_pi;

/// A body on a sting that leaves a test section of 4 x 2 x 2 m through its outflow plane.
const std::string k_parts =
    "local body, rod = cylinder{ {-1, 0, 0}, {0.3, 0, 0}, radius = 0.2, name = 'body' }, cylinder{ {0.2, 0, 0}, {4, 0, 0}, radius = 0.1, name = 'sting' } "
    "local tunnel = test_section{ length = 4, width = 2, height = 2, inflow = 'inlet', outflow = 'outlet', max_edge = 0.5, through = { 'sting', 'slab' }, "
    "walls = { layers = 8, first_height "
    "= 1e-4 }, ceiling = 'slip' } ";

TEST_F(TunnelScripts, SectionsAreRectangularRoundOrTheUsers) {
  EXPECT_EQ(run("print(table.concat(test_section{ length = 4, width = 2, height = 1 }.patches, ' '))"),
            "tunnel_floor tunnel_right tunnel_ceiling tunnel_left inflow outflow\n");
  EXPECT_NEAR(number("-test_section{ length = 4, diameter = 2 }:measures().volume"), 4.0 * k_pi, 1e-7);
  EXPECT_EQ(run("print(test_section{ length = 4, width = 2, height = 1, position = {10, 0, 3} }.min[1])"), "8.0\n");
  EXPECT_EQ(run("local b = box{ {0,0,0}, {4,2,2}, name = 'shell' } local t = test_section{ b, walls = 'slip' } print(surface_mesh{ t }.patches[1])"),
            "shell\n");
  EXPECT_NEAR(number("test_section{ box{ {0,0,0}, {4,2,2} } }:measures().volume"), -16.0, 1e-9);  // reversed, since the fluid is inside
  EXPECT_THAT(error("test_section{ length = 4, width = 2 }"), HasSubstr("give width and height, or the diameter"));
  EXPECT_THAT(error("test_section{ length = 4, width = 2, height = 2, diameter = 1 }"), HasSubstr("has neither width nor height"));
  EXPECT_THAT(error("test_section{ length = 4, width = 2, height = 2, floor = 'slippery', walls = { layer = 3 } }"),
              AllOf(HasSubstr("not \"slippery\""), HasSubstr("layer")));
  EXPECT_THAT(error("test_section{ length = 4, diameter = 2, floor = 'slip' }"), HasSubstr("a round section has one wall"));
  EXPECT_THAT(error("test_section{ box{ {0,0,0}, {1,1,1} }, inflow = 'nosuch' }"), HasSubstr("inflow: no face has a matching name"));
  EXPECT_THAT(error("test_section{ length = 4, width = 2, height = 2, patches = { wing = { max_edge = 1 } } }"),
              HasSubstr("no face of the tunnel has a name like \"wing\""));
}

TEST_F(TunnelScripts, ASideWithLayersIsAWall) {
  const std::string side =
      "local function kinds(o) o.length, o.width, o.height = 4, 2, 2 surface_mesh{ test_section(o), max_edge = 0.5 }:write(" + out("t.su2") + ") end ";
  const auto kind_of_floor = [&](const std::string& options) {
    run(side + "kinds{ " + options + " }");
    const std::string text = text_of("t.su2.json");
    const std::string mark = "\"name\": \"tunnel_floor\",\n      \"kind\": \"";
    const std::size_t at = text.find(mark);
    return at == std::string::npos ? text : text.substr(at + mark.size(), text.find('"', at + mark.size()) - at - mark.size());
  };
  EXPECT_EQ(kind_of_floor("walls = 'slip'"), "slip");
  EXPECT_EQ(kind_of_floor("walls = 'slip', floor = { layers = 4, first_height = 1e-3 }"), "wall");
  EXPECT_EQ(kind_of_floor("walls = { layers = 4 }, floor = 'slip'"), "slip");
  EXPECT_THAT(text_of("t.su2.json"),
              AllOf(HasSubstr("\"names\": \"tunnel_left\",\n      \"layers\""), testing::Not(HasSubstr("\"names\": \"tunnel_floor\",\n      \"layers\""))));
  EXPECT_THAT((kind_of_floor("walls = { total_height = 0.1 }"), text_of("t.su2.json")), HasSubstr("\"total_height\": 0.1"));  // this option was once dropped
  EXPECT_THAT(error("test_section{ length = 4, width = 2, height = 2, floor = { kind = 'slip', layers = 4 } }"),
              HasSubstr("floor: only walls have layers, and this patch is of kind slip"));
  EXPECT_THAT(
      error(
          "volume_mesh{ surface_mesh{ test_section{ length = 4, width = 2, height = 2, patches = { inflow = { layers = 4 } } }, max_edge = 0.5 }, layers = 4, "
          "first_height = 1e-3 }"),
      HasSubstr("patches[\"inflow\"] requests layers = 4, but its patches carry no layers: \"inflow\" (of kind inflow)"));
}

TEST_F(TunnelScripts, WakeBehindModelEndsAtOutlet) {
  const std::string parts =
      "local t = test_section{ length = 6, width = 2, height = 2, max_edge = 0.5 } local function show(w) print(string.format('%.3f %.3f %.3f %.3f', w[1][1], "
      "w[2][2], w.length, w.height)) end ";
  EXPECT_EQ(run(parts + "show(wake{ surface_mesh{ box{ {-1, -0.2, -0.1}, {0, 0.2, 0.1} }, t, max_edge = 0.2 }, length = 2 })"), "-0.500 0.200 2.500 0.200\n");
  EXPECT_EQ(run(parts + "show(wake{ surface_mesh{ box{ {1, -0.2, -0.1}, {2, 0.2, 0.1} }, t, max_edge = 0.2 }, length = 4 })"), "1.500 0.200 1.500 0.200\n");
  // A body that stands on the floor.
  EXPECT_EQ(run(parts + "show(wake{ surface_mesh{ box{ {-1, -0.2, -1}, {0, 0.2, -0.5}, name = 'house' }, t, max_edge = 0.2 }, length = 1 })"),
            "-0.500 0.200 1.500 0.500\n");
  EXPECT_THAT(error(parts + "wake{ surface_mesh{ t }, length = 2 }"), HasSubstr("encloses its fluid, and there is no wall inside it"));
}

TEST_F(TunnelScripts, StingModelIsCutOutAtAnyAttitude) {
  const std::string text = run(k_parts +
                               "for _, a in ipairs{ -4, 12 } do local m = assembly{ body, rod }:rotate{ pitch = a*deg, yaw = 5*deg } "
                               "local wall = surface_mesh{ m, tunnel, max_edge = 0.1, growth = 1.3 } "
                               "print(#m.solids, wall.is_closed, wall.crossings, wall.triangles < 12000, table.concat(wall.patches, ' ')) wall:write(" +
                               out("wall.su2") + ") end");
  const std::string line = "1\ttrue\t0\ttrue\ttunnel_floor inlet tunnel_right outlet tunnel_left tunnel_ceiling sting body\n";
  EXPECT_EQ(text, line + line);
  const std::string manifest = text_of("wall.su2.json");
  for (const auto& [name, kind] :
       {std::pair{"tunnel_ceiling", "slip"}, {"tunnel_floor", "wall"}, {"inlet", "inflow"}, {"outlet", "outflow"}, {"sting", "wall"}})
    EXPECT_THAT(manifest, HasSubstr("\"name\": \"" + std::string(name) + "\",\n      \"kind\": \"" + kind + "\"")) << manifest;
  // The kinds are read back from the file and written again, and so are the layers requested for the walls.
  EXPECT_THAT(manifest, AllOf(HasSubstr("\"layers\""), HasSubstr("\"names\": \"tunnel_left\""), HasSubstr("\"first_height\": 0.0001")));
}

TEST_F(TunnelScripts, TunnelsFromFilesAreMeshed) {
  run("local rod = sting{ name = 'sting', from = { 0.3, 0, 0 }, to = { 4, 0, 0 }, diameter = 0.2, cone_start = 0.5, end_diameter = 0.25 }:model() "
      "local tunnel = test_section{ length = 4, width = 2, height = 2, walls = { layers = 6, first_height = 1e-4, max_edge = 0.4 } } "
      "local wall = surface_mesh{ rod, tunnel, max_edge = 0.15, growth = 1.3 } wall:write(" +
      out("room.su2") + ", " + out("room.stl") + ")");
  // The manifest beside the file supplies kinds, layers and the side of the fluid.
  EXPECT_EQ(run("local m = volume_mesh{ read_surface(" + out("room.su2") + "), layers = 8, first_height = 1e-5 } m:check()").substr(0, 5), "VALID");
  EXPECT_EQ(run("local m = volume_mesh{ read_surface{ " + out("room.stl") +
                ", fluid = 'inside' }, layers = 8, first_height = 1e-5, "
                "patches = { ['*'] = { kind = 'slip' }, ['sting*'] = { kind = 'wall' } } } m:check()")
                .substr(0, 5),
            "VALID");
}

TEST_F(TunnelScripts, PeriodicSidesOfACascade) {
  // A body between the sides; the stages are stored, continued and read back.
  const std::string surface =
      "local body = cylinder{ {-0.4, 0, 0}, {0.4, 0, 0}, radius = 0.3, name = 'body' } "
      "local row = test_section{ length = 4, width = 2, height = 2, walls = 'slip', max_edge = 0.4 } local wall = surface_mesh{ body, row, max_edge = 0.2, "
      "growth = 1.3 } ";
  EXPECT_EQ(run(surface + "local m = volume_mesh{ wall, layers = 6, first_height = 1e-3, periodic = { { 'tunnel_left', 'tunnel_right' } }, stages = " +
                out("steps.sterna") + " } m:write(" + out("row.sterna") + ") m:check()")
                .substr(0, 5),
            "VALID");
  EXPECT_THAT(log_, HasSubstr("periodic sides tunnel_left and tunnel_right: "));
  const std::string manifest = text_of("row.sterna.json");
  EXPECT_THAT(manifest, AllOf(HasSubstr("\"periodic_sides\""), HasSubstr("\"worst_distance\""), HasSubstr("\"periodic\"")));
  EXPECT_THAT(run("read_mesh(" + out("row.sterna") + "):check{ details = true }"), HasSubstr("periodic: tunnel_left and tunnel_right"));
  EXPECT_THAT(run("local s = read_stages(" + out("steps.sterna") + ") prisms{ s.envelope, s.tetrahedra }:check{ details = true }"),
              HasSubstr("periodic: tunnel_left and tunnel_right"));
  run("read_mesh(" + out("row.sterna") + "):su2_config{ " + out("row.cfg") +
      ", mesh = 'row.su2', flow{ mach = 0.3, altitude = 0, length = 0.8 }, reference_area = 1 }");
  EXPECT_THAT(text_of("row.cfg"), HasSubstr("MARKER_PERIODIC= ( tunnel_left, tunnel_right, 0, 0, 0, 0, 0, 0, 0, 2, 0 )"));
  // A single pair needs no list; entries that are not pairs and sides that do not match are refused.
  const std::string mesh = surface + "volume_mesh{ wall, layers = 6, first_height = 1e-3, periodic = ";
  EXPECT_THAT(error(mesh + "{ 'tunnel_left', 'tunnel_rigth' } }"), HasSubstr("did you mean \"tunnel_right\"?"));
  EXPECT_THAT(error(mesh + "{ 'tunnel_left' } }"), HasSubstr("periodic, entry 1: expected the names of two patches"));
  EXPECT_THAT(error(mesh + "'tunnel_left' }"), HasSubstr("periodic: expected the names of two patches"));
  EXPECT_THAT(error(mesh + "{ { 'tunnel_left', 'tunnel_floor' } } }"), HasSubstr("do not point in opposite directions"));
}

TEST_F(TunnelScripts, AWingThroughPeriodicSides) {
  const std::string surface =
      "local blade = wing{ name = 'blade', symmetric = true, trailing_edge = 0.012, sections = { { y = 0, chord = 0.8, airfoil = 'naca0012' }, { y = 1 } } } "
      "local row = test_section{ length = 4, width = 1, height = 2, upstream = 1, walls = 'slip', max_edge = 0.4, through = 'blade' } "
      "local wall = surface_mesh{ blade, row, max_edge = 0.15, min_edge = 0.015, curvature_angle = 24*deg, growth = 1.5, periodic = ";
  // The pair is given once: volume_mesh takes it from the wall, and so does a continued run.
  EXPECT_EQ(run(surface + "{ { 'tunnel_left', 'tunnel_right' } } } local m = volume_mesh{ wall, layers = 6, first_height = 1e-3, stages = " +
                out("blade.sterna") + " } m:check() m:write(" + out("blade.su2") + ")")
                .substr(0, 5),
            "VALID");
  EXPECT_THAT(log_, HasSubstr("periodic sides tunnel_left and tunnel_right: "));
  EXPECT_THAT(text_of("blade.su2.json"), AllOf(HasSubstr("\"periodic_sides\""), HasSubstr("tunnel_left,tunnel_right")));
  EXPECT_THAT(run("local s = read_stages(" + out("blade.sterna") + ") prisms{ s.envelope, s.tetrahedra }:check{ details = true }"),
              HasSubstr("periodic: tunnel_left and tunnel_right"));
  EXPECT_THAT(error(surface + "{ 'tunnel_left', 'tunnel_rigth' } }"),
              AllOf(HasSubstr("the model has no face \"tunnel_rigth\""), HasSubstr("did you mean \"tunnel_right\"?")));
  EXPECT_THAT(error(surface + "'tunnel_left,tunnel_right' }"), HasSubstr("periodic: expected the names of two patches"));
}

TEST_F(TunnelScripts, KindsAreSetByName) {
  EXPECT_EQ(run("local m = box{ {0,0,0}, {1,1,1} }:kinds{ ['b*'] = 'slip' } surface_mesh{ m, max_edge = 0.5 }:write(" + out("box.su2") + ") print('ok')"),
            "ok\n");
  EXPECT_THAT(text_of("box.su2.json"), HasSubstr("\"kind\": \"slip\""));
  EXPECT_THAT(error("box{ {0,0,0}, {1,1,1} }:kinds{ wing = 'slip', box = 'walls' }"),
              AllOf(HasSubstr("no face has a name like \"wing\""), HasSubstr("not \"walls\"")));
}

TEST_F(TunnelScripts, BodiesThatDoNotBelongThereAreErrors) {
  EXPECT_THAT(error(k_parts + "surface_mesh{ body:move{ 0, 5, 0 }, tunnel }"), HasSubstr("\"body\" lies outside"));
  EXPECT_THAT(error(k_parts + "surface_mesh{ body, tunnel, test_section{ length = 1, width = 1, height = 1 } }"), HasSubstr("there are 2 tunnels"));
  EXPECT_THAT(error(k_parts + "surface_mesh{ box{ {-0.1,-3,-3}, {0.1,3,3}, name = 'slab' }, tunnel }"), HasSubstr("\"slab\" cuts the fluid"));
}

TEST_F(TunnelScripts, WhatReachesOutOfTheTunnelIsDeclared) {
  // A body on a sting, with a fin that extends above the ceiling at z = 1: the fin is not a sting.
  const std::string parts =
      "local body = cylinder{ {-1, 0, 0}, {0.3, 0, 0}, radius = 0.2, name = 'body' } local fin = box{ {-0.8, -0.05, 0}, {-0.4, 0.05, 0.9}, name = 'fin' } "
      "local rod = sting{ name = 'rod', from = { 0.2, 0, 0 }, to = { 4, 0, 0 }, diameter = 0.1, cone_start = 0.5, end_diameter = 0.15 }:model() "
      "local m = assembly{ body, fin, rod } local function wall(dz, o) o = o or {} o.length, o.width, o.height, o.max_edge = 4, 2, 2, 0.5 "
      "return surface_mesh{ m:move{ 0, 0, dz }, test_section(o), max_edge = 0.2, growth = 1.4 } end ";
  EXPECT_EQ(run(parts + "print(wall(0).is_closed)"), "true\n");  // stings pass through the wall without a warning
  const std::string problem = error(parts + "wall(0.5)");
  EXPECT_THAT(problem, AllOf(HasSubstr("\"fin\" reaches 0.4 m out of the wall \"tunnel_ceiling\""), HasSubstr("would be cut off"), HasSubstr("1.4)"),
                             HasSubstr("through = { \"fin\" }")));
  EXPECT_THAT(problem, testing::Not(HasSubstr("rod")));
  EXPECT_EQ(run(parts + "print(wall(0.5, { through = 'f?n' }).is_closed, wall(0.5, { through = { 'fin', 'strut' } }).is_closed)"), "true\ttrue\n");
  // A body that stands on a wall is not cut off; rounding has no influence.
  EXPECT_EQ(
      run("local b = box{ {-0.3, -0.3, -1 - 1e-6}, {0.3, 0.3, 0}, name = 'house' } local t = test_section{ length = 4, width = 2, height = 2, max_edge = 0.5 } "
          "print(surface_mesh{ b, t, max_edge = 0.2 }.is_closed)"),
      "true\n");
  // At a curved wall the exact surface decides, not its triangles.
  const std::string round =
      "local t = test_section{ length = 4, diameter = 2 } local function pin(top) return surface_mesh{ cylinder{ {0, 0, -0.2}, {0, 0, top}, radius = 0.02, "
      "name "
      "= 'pin' }, t, max_edge = 0.3, min_edge = 0.02 } end ";
  EXPECT_THAT(error(round + "pin(1.01)"), HasSubstr("\"pin\" reaches 0.010"));
  EXPECT_THAT(error("test_section{ length = 4, width = 2, height = 2, through = 3 }"), HasSubstr("through: expected names or patterns of components or faces"));
}

TEST_F(TunnelScripts, AssembliesAreUnitedWhereTheyTouch) {
  EXPECT_EQ(run(k_parts + "print(#assembly{ body, rod }.solids, #assembly{ body, rod, unite = false }.solids, #assembly{ body, rod, tunnel }.solids, "
                          "#assembly{ body, rod:move{ 0, 0, 1 } }.solids)"),
            "1\t2\t2\t2\n");
}

TEST_F(TunnelScripts, HalfModelBoundaryIsReportedInOneLine) {
  run("print(surface_mesh{ half{ box{ {-1, -1, -1}, {1, 1, 1} } }, max_edge = 0.5 })");
  EXPECT_THAT(log_, HasSubstr("open      along 8 m in the plane y = 0 m, 4 edges"));
  EXPECT_THAT(log_, testing::Not(HasSubstr("of face")));
}

TEST_F(TunnelScripts, HalfModelHasItsBoundaryInPlane) {
  const std::string text =
      run("local m = aircraft{ fuselage{ name = 'body', frames = { { x = 0.3, diameter = 0.5 }, { x = 2, diameter = 1 }, { x = 5, diameter = 0.6 } } }, "
          "wing{ name = 'wing', symmetric = true, position = { 1.5, 0, -0.2 }, trailing_edge = 0.01, sections = { { y = 0, chord = 1.2, airfoil = 'naca2412' "
          "}, { y = 3, chord = 0.7 } } } } "
          "local right = half(m) local o = { max_edge = 0.2, curvature_angle = 25*deg, min_edge = 0.02 } "
          "o[1] = right local wall = surface_mesh(o) o[1] = m local whole = surface_mesh(o) "
          "print(right.is_closed, wall.crossings, math.abs(wall.triangles / whole.triangles - 0.5) < 0.03) wall:write(" +
          out("half.obj") +
          ") "
          "print(math.abs(2*right:measures().area / m:measures().area - 1) < 1e-5)");
  EXPECT_EQ(text, "false\t0\ttrue\ntrue\n");
  std::ifstream file(folder_ / "half.obj");
  std::size_t n_border = 0;
  for (std::string line; std::getline(file, line);) {
    double x = 0.0, y = 0.0, z = 0.0;
    if (std::sscanf(line.c_str(), "v %lf %lf %lf", &x, &y, &z) != 3) continue;
    EXPECT_TRUE(y == 0.0 || y > 1e-6) << line;
    EXPECT_FALSE(std::signbit(y)) << line;
    n_border += y == 0.0 ? 1 : 0;
  }
  EXPECT_GT(n_border, 30u);
  EXPECT_THAT(error("half(box{ {0,1,0}, {1,2,1} })"), HasSubstr("does not reach the plane y = 0"));
}

}  // namespace
}  // namespace sterna::scripting
