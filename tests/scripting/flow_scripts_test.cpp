// Heights from flow conditions, total heights, families and SU2 configurations as users write them.
#include <gmock/gmock.h>

#include <cmath>
#include <set>
#include <sstream>

#include "geom/base/number_text.h"
#include "io/file/surface_file.h"
#include "io/volume/sterna_file.h"
#include "scripting/cli/pentagrow_config.h"
#include "scripting/verbs/su2_config.h"
#include "tests/scripting/script_fixture.h"
#include "tests/support/data.h"
#include "tests/support/error_of.h"
#include "tests/support/hybrid_shapes.h"
#include "tests/support/process.h"
#include "tests/support/test_shapes.h"
#include "volmesh/flow/boundary_layer.h"
#include "volmesh/volume_mesh.h"

namespace sterna::scripting {
namespace {

using testing::AllOf;
using testing::HasSubstr;
using testing::Not;

class FlowScripts : public ScriptFixture {
 protected:
  FlowScripts() { io::write_surface_file(test::sphere(6), folder_ / "ball.off", RunContext()); }
};

TEST_F(FlowScripts, YPlusPrintsItselfAndIsANumber) {
  const std::string text =
      run("local y = y_plus{ 1, mach = 0.78, altitude = 11000, length = 4.2 } print(y) print(y.reynolds > 2e7, 2*y == y + y, y < 1e-4, -y < 0, y/y, y.height "
          "== 1*y)");
  EXPECT_THAT(text, AllOf(HasSubstr("y+ 1 at the first node: first height"), HasSubstr("11000 m of the standard atmosphere"),
                          HasSubstr("true\ttrue\ttrue\ttrue\t1.0\ttrue")));
  EXPECT_NEAR(number("y_plus{ 1, reynolds = 5e6, length = 275.80*inch }/inch"), 0.001478, 0.02 * 0.001478);  // DPW-4, medium
  EXPECT_NEAR(number("y_plus{ 1, flow{ reynolds = 5e6, length = 1 }, at = 'cell_centre' } / y_plus{ 1, reynolds = 5e6, length = 1 }"), 2.0, 1e-12);
  EXPECT_NEAR(number("boundary_layer{ reynolds = 1e7, length = 2, factor = 1.3 } / boundary_layer{ reynolds = 1e7, length = 2 }"), 1.3, 1e-12);
}

TEST_F(FlowScripts, WrongFlowConditionsAreReportedAtTheirLine) {
  EXPECT_THAT(error("y_plus{ 1, mach = 0.5, altitude = 9e4, length = 1 }"), AllOf(HasSubstr("case.lua:1: y_plus"), HasSubstr("-5000 .. 84852 m")));
  EXPECT_THAT(error("y_plus{ mach = 0.5, lenght = 1 }"), AllOf(HasSubstr("needs the target y+"), HasSubstr("did you mean \"length\"?")));
  EXPECT_THAT(error("y_plus{ 1, speed = 1, altitude = 0, length = 1*mm }"), HasSubstr("Reynolds number"));
  EXPECT_THAT(error("y_plus{ 1, law = 'karman', reynolds = 1e6, length = 1 }"), HasSubstr("ittc57"));
  EXPECT_THAT(error("local x = 2 * flow{ reynolds = 1e6, length = 1 }"), HasSubstr("flow conditions are not a number"));
  EXPECT_THAT(error("volume_mesh{ read_surface 'ball.off', first_height = flow{ reynolds = 1e6, length = 1 } }"),
              HasSubstr("flow conditions is not allowed here"));
}

TEST_F(FlowScripts, MistypedRequiredOptionIsOneMistake) {
  const std::string one = error("volume_mesh{ read_surface 'ball.off', first_heigth = 0.01 }");
  EXPECT_THAT(one, HasSubstr("did you mean \"first_height\"?"));
  EXPECT_THAT(one, Not(HasSubstr("needs")));
  EXPECT_THAT(one, Not(HasSubstr("problems")));
  EXPECT_THAT(error("volume_mesh{ read_surface 'ball.off', layerz = 3 }"), AllOf(HasSubstr("needs first_height"), HasSubstr("did you mean \"layers\"?")));
}

TEST_F(FlowScripts, FamilyOfOneIsMeshOfItsOptions) {
  EXPECT_THAT(run("local f = family{ levels = 1 } print(#f, f[1].name, f[1].refinement)"), HasSubstr("1\tmedium\t1.0"));
  EXPECT_THAT(run("local f = family{ levels = 1, medium = 2 } print(f[1].name)"), HasSubstr("coarse"));  // requested
  EXPECT_THAT(run("local f = family{} print(f[1].name, f[2].name, f[3].name)"), HasSubstr("coarse\tmedium\tfine"));
}

TEST_F(FlowScripts, TotalHeightDeterminesLayersOrGrowth) {
  const std::string mesh = "local m = volume_mesh{ read_surface 'ball.off', farfield = sphere{ radius = 8 }, first_height = 0.01, ";
  run(mesh + "max_growth = 1.2, total_height = 0.12 } print(m.mean_height)");
  EXPECT_THAT(log_, HasSubstr("7 layers reach the total height of 0.12 m with a growth of 1.17"));
  const std::string printed = run(mesh + "layers = 6, total_height = 0.1 } print(m.mean_height)");
  EXPECT_THAT(log_, HasSubstr("6 layers grow by 1.2"));
  EXPECT_NEAR(std::stod(printed), 0.1, 0.002);
  EXPECT_THAT(error(mesh + "layers = 6, max_growth = 1.2, total_height = 0.1 }"), HasSubstr("cannot all be given"));
  EXPECT_THAT(error(mesh + "total_height = 0.1 }"), HasSubstr("needs layers or max_growth"));
  EXPECT_THAT(error(mesh + "layers = 20, total_height = 0.1 }"), HasSubstr("give at most 10 layers"));
  run(mesh +
      "layers = 6, patches = { wall = { first_height = y_plus{ 100, reynolds = 1e6, length = 1 }, total_height = boundary_layer{ reynolds = 1e6, length = 2 "
      "} "
      "} } } print(m)");
  EXPECT_THAT(log_, HasSubstr("y+ 100"));
}

TEST_F(FlowScripts, FirstHeightsByFunctionOfLocation) {
  const std::string height = "local function h(x, y, z) return 0.01*1.5^x end ";
  const std::string more = "layers = 4, max_growth = 1.2, farfield = sphere{ radius = 8 }, first_height = ";
  run(height + "volume_mesh{ read_surface 'ball.off', " + more + "h }:write(" + out("by_place.sterna") + ", " + out("by_place.su2") + ")");
  EXPECT_THAT(log_, HasSubstr("first heights by a function: 0.006667 m to 0.015 m"));
  EXPECT_THAT(text_of("by_place.su2.json"), HasSubstr("a function of location"));
  const HybridMesh mesh = *io::read_sterna(folder_ / "by_place.sterna", RunContext()).mesh;
  ASSERT_GT(mesh.layers.n_lines(), 100u);
  for (std::uint32_t line = 0; line < mesh.layers.n_lines(); ++line) {
    const Point base_point = mesh.points[mesh.layers.node(line, 0)], first = mesh.points[mesh.layers.node(line, 1)];
    const double requested = 0.01 * std::pow(1.5, base_point.x);
    // Height above the facets, which form up to 8 degrees with the vertex normal of this ball: 1 % more along that normal.
    EXPECT_GE(mesh.request.first_height_of(line), requested * (1.0 - 1e-12));
    EXPECT_LE(mesh.request.first_height_of(line), requested * 1.01);
    EXPECT_NEAR(distance(base_point, first), requested, 0.03 * requested)
        << format_point(base_point);  // G11: 2 % along the vertex normal, and the growth line leans a little
  }
  // The steps called one by one, also continued from a file, give the same heights. A constant function acts as its number. The number of a rule and that of
  // the command line have priority.
  run(height + "local w, ff = read_surface 'ball.off', sphere{ radius = 8 } make_envelope{ w, " + more + "h }:write(" + out("e.sterna") +
      ") local e = read_stages(" + out("e.sterna") + ").envelope local t = tetrahedra{ e } t:write(" + out("t.sterna") + ") local s = read_stages(" +
      out("t.sterna") + ") prisms{ s.envelope, s.tetrahedra }:write(" + out("steps.su2") + ")");
  EXPECT_EQ(text_of("steps.su2"), text_of("by_place.su2"));
  run("local w = read_surface 'ball.off' volume_mesh{ w, " + more + "0.01 }:write(" + out("number.su2") + ") volume_mesh{ w, " + more +
      "function() return 0.01 end }:write(" + out("constant.su2") + ")");
  EXPECT_EQ(text_of("constant.su2"), text_of("number.su2"));
  run("volume_mesh{ read_surface 'ball.off', patches = { wall = { first_height = 0.01 } }, " + more + "function(x) return 0.02 + 0.001*x end }:write(" +
      out("rule.su2") + ")");
  EXPECT_EQ(text_of("rule.su2"), text_of("number.su2"));
  run("volume_mesh{ read_surface 'ball.off', " + more + "function(x) return 0.02 + 0.001*x end }:write(" + out("line.su2") + ")",
      {{"envelope.first_height", "0.01"}});
  EXPECT_EQ(text_of("line.su2"), text_of("number.su2"));
  const std::string refined = height + "volume_mesh{ read_surface 'ball.off', refinement = 2, " + more + "h } ";
  run(refined);
  EXPECT_THAT(log_, HasSubstr("refinement 2"));
}

TEST_F(FlowScripts, FamilyMembersHaveAWake) {
  const std::string mesh = "volume_mesh{ read_surface 'ball.off', layers = 4, first_height = 0.01, farfield = sphere{ radius = 8 }, ";
  const auto log_of = [&](const std::string& more, const std::vector<std::pair<std::string, std::string>>& overrides = {}) {
    run(mesh + more + "}", overrides);
    return log_;
  };
  const auto has_wake = HasSubstr("wake source of a mesh family member"), has_hint = HasSubstr("no source refines the wake");
  for (const char* more : {"refinement = 1", "refinement = 'medium'", "refinement = 0.7", "family_wake = 'on'"})
    EXPECT_THAT(log_of(more), AllOf(has_wake, Not(has_hint))) << more;
  EXPECT_THAT(log_of("", {{"family.refinement", "1"}}), has_wake);
  for (const char* more : {"", "refinement = 0.7, family_wake = 'off'"}) EXPECT_THAT(log_of(more), AllOf(Not(has_wake), has_hint)) << more;
  EXPECT_THAT(log_of("refinement = 0.7, sources = { sphere{ {0, 0, 0}, radius = 2, size = 0.5 } }"), AllOf(Not(has_wake), Not(has_hint)));
  // The same mesh in one run and through a stage file, which stores the value of family_wake but no sources.
  run(mesh + "refinement = 1 }:write(" + out("whole.su2") + ")");
  run("make_envelope{ read_surface 'ball.off', layers = 4, first_height = 0.01, farfield = sphere{ radius = 8 }, refinement = 1 }:write(" + out("e.sterna") +
      ")");
  run("local e = read_stages(" + out("e.sterna") + ").envelope prisms{ e, tetrahedra{ e } }:write(" + out("steps.su2") + ")");
  EXPECT_EQ(text_of("steps.su2"), text_of("whole.su2"));
}

TEST_F(FlowScripts, WrongFirstHeightFunctionsAreReportedWithLocation) {
  const std::string mesh = "\nvolume_mesh{ read_surface 'ball.off', farfield = sphere{ radius = 8 }, layers = 4, first_height = ";
  EXPECT_THAT(error(mesh + "function(x, y, z) return x end }"), AllOf(HasSubstr("case.lua:2"), HasSubstr("not heights"), HasSubstr("first height -")));
  EXPECT_THAT(error(mesh + "function(x, y, z) return 'thin' end }"), AllOf(HasSubstr("case.lua:2"), HasSubstr("number")));
  EXPECT_THAT(error(mesh + "function(x, y, z) error 'no idea' end }"), HasSubstr("no idea"));
  EXPECT_THAT(error(mesh + "0.01, max_growth = function() return 1.2 end }"), HasSubstr("max_growth: a function is not allowed here"));
}

TEST_F(FlowScripts, FamilyMembers) {
  EXPECT_EQ(run("for _, m in ipairs(family{}) do print(m.name, string.format('%.4f', m.refinement)) end"), "coarse\t0.6667\nmedium\t1.0000\nfine\t1.5000\n");
  EXPECT_EQ(run("local f = family{ levels = 4, factor = 2, medium = 4 } print(#f, f[1].name, f[1].refinement)"), "4\tcoarse_3\t0.125\n");
  const std::string printed =
      run("local function count(f) return volume_mesh{ read_surface 'ball.off', layers = 8, first_height = 0.01, max_growth = 1.2, refinement = f, farfield = "
          "sphere{ radius = 8 } }.prisms end print(count 'medium', count(0.5))");
  EXPECT_THAT(log_, HasSubstr("4 layers instead of 8, growth 1.44 instead of 1.2, first height 0.02 m instead of 0.01 m"));
  std::istringstream words(printed);
  int medium = 0, coarse = 0;
  words >> medium >> coarse;
  EXPECT_EQ(medium, 2 * coarse);
  EXPECT_THAT(error("volume_mesh{ read_surface 'ball.off', layers = 8, first_height = 0.01, refinement = 'finer' }"), HasSubstr("fine"));
  run("local s = surface_mesh{ box{ {0,0,0}, {1,1,1} }, max_edge = 0.4, refinement = 'coarse', patches = { ['box*'] = { kind = 'slip' } } } print(s) "
      "pcall(volume_mesh, { s, layers = 2, first_height = 0.01 })");
  EXPECT_THAT(log_, HasSubstr("the surface was made with refinement 0.6667, the volume with 1"));
}

TEST_F(FlowScripts, LayersRequestedWithTheSurface) {
  const std::string text =
      run("local s = surface_mesh{ box{ {0,0,0}, {1,1,1} }, max_edge = 0.25, patches = { ['*'] = { max_edge = 0.3, layers = 3, first_height = 0.01 } } } "
          "print(volume_mesh{ s, farfield = sphere{ radius = 9 } })");
  EXPECT_THAT(text, HasSubstr("prisms"));
  EXPECT_THAT(error("surface_mesh{ box{ {0,0,0}, {1,1,1} }, patches = { box = { kind = 'slipp' } } }"), HasSubstr("slip"));
}

// ---- SU2 ------------------------------------------------------------------------------------------------------------------------------------

std::map<std::string, std::string> keys_of(const std::string& text) {
  std::map<std::string, std::string> keys;
  std::istringstream lines(text);
  for (std::string line; std::getline(lines, line);) {
    const std::size_t equals = line.find("= ");
    if (line.starts_with('%') || equals == std::string::npos) continue;
    EXPECT_TRUE(keys.emplace(line.substr(0, equals), line.substr(equals + 2)).second) << line;
  }
  return keys;
}

/// Keys in config_template.cfg of SU2 8.
const std::set<std::string> k_su2_keys = {"SOLVER",
                                          "KIND_TURB_MODEL",
                                          "MATH_PROBLEM",
                                          "RESTART_SOL",
                                          "SYSTEM_MEASUREMENTS",
                                          "MACH_NUMBER",
                                          "AOA",
                                          "SIDESLIP_ANGLE",
                                          "INIT_OPTION",
                                          "FREESTREAM_OPTION",
                                          "FREESTREAM_PRESSURE",
                                          "FREESTREAM_TEMPERATURE",
                                          "REYNOLDS_NUMBER",
                                          "REYNOLDS_LENGTH",
                                          "FLUID_MODEL",
                                          "VISCOSITY_MODEL",
                                          "REF_AREA",
                                          "REF_LENGTH",
                                          "REF_ORIGIN_MOMENT_X",
                                          "REF_ORIGIN_MOMENT_Y",
                                          "REF_ORIGIN_MOMENT_Z",
                                          "REF_DIMENSIONALIZATION",
                                          "MARKER_WALL_FUNCTIONS",
                                          "MARKER_HEATFLUX",
                                          "MARKER_ISOTHERMAL",
                                          "MARKER_EULER",
                                          "MARKER_SYM",
                                          "MARKER_FAR",
                                          "INLET_TYPE",
                                          "MARKER_INLET",
                                          "MARKER_OUTLET",
                                          "MARKER_SUPERSONIC_INLET",
                                          "MARKER_SUPERSONIC_OUTLET",
                                          "ACTDISK_TYPE",
                                          "ACTDISK_JUMP",
                                          "MARKER_ACTDISK",
                                          "MARKER_PLOTTING",
                                          "MARKER_MONITORING",
                                          "MARKER_ANALYZE",
                                          "MARKER_ANALYZE_AVERAGE",
                                          "NUM_METHOD_GRAD",
                                          "CFL_NUMBER",
                                          "CFL_ADAPT",
                                          "CFL_ADAPT_PARAM",
                                          "CONV_NUM_METHOD_FLOW",
                                          "MUSCL_FLOW",
                                          "SLOPE_LIMITER_FLOW",
                                          "TIME_DISCRE_FLOW",
                                          "CONV_NUM_METHOD_TURB",
                                          "MUSCL_TURB",
                                          "TIME_DISCRE_TURB",
                                          "LINEAR_SOLVER",
                                          "LINEAR_SOLVER_PREC",
                                          "LINEAR_SOLVER_ERROR",
                                          "LINEAR_SOLVER_ITER",
                                          "MGLEVEL",
                                          "ITER",
                                          "CONV_FIELD",
                                          "CONV_RESIDUAL_MINVAL",
                                          "CONV_CAUCHY_ELEMS",
                                          "CONV_CAUCHY_EPS",
                                          "CONV_STARTITER",
                                          "MESH_FILENAME",
                                          "MESH_FORMAT",
                                          "TABULAR_FORMAT",
                                          "CONV_FILENAME",
                                          "RESTART_FILENAME",
                                          "SOLUTION_FILENAME",
                                          "VOLUME_FILENAME",
                                          "SURFACE_FILENAME",
                                          "OUTPUT_FILES",
                                          "SCREEN_OUTPUT",
                                          "HISTORY_OUTPUT"};

TEST_F(FlowScripts, Su2ConfigurationOfBodyInFarfield) {
  run("local wing = wing{ name = 'main', symmetric = true, position = {1, 0, 0}, sections = { { y = 0, chord = 2, airfoil = 'naca0012' }, { y = 5, chord = "
      "1, "
      "airfoil = 'naca0012' } } }\n"
      "local m = volume_mesh{ read_surface 'ball.off', layers = 4, first_height = 0.01, farfield = sphere{ radius = 8 } }\n"
      "m:su2_config{ " +
      out("case.cfg") + ", mach = 0.5, altitude = 0, length = 2, alpha = 2*deg, reference = wing }");
  const auto keys = keys_of(text_of("case.cfg"));
  for (const auto& [key, value] : keys) EXPECT_TRUE(k_su2_keys.contains(key)) << key;
  const auto at = [&](const char* key) { return keys.contains(key) ? keys.at(key) : std::string("absent"); };
  EXPECT_EQ(at("SOLVER"), "RANS");
  EXPECT_EQ(at("MARKER_HEATFLUX"), "( wall, 0.0 )");
  EXPECT_EQ(at("MARKER_FAR"), "( farfield )");
  EXPECT_EQ(at("MARKER_MONITORING"), "( wall )");
  EXPECT_EQ(at("AOA"), "2");
  EXPECT_EQ(at("REF_AREA"), "15");
  for (const char* key : {"REF_ORIGIN_MOMENT_Y", "REF_ORIGIN_MOMENT_Z"}) EXPECT_EQ(at(key), "0") << key << ": what rounding leaves of zero is told as zero";
  EXPECT_NEAR(std::stod(at("REF_LENGTH")), 2.0 / 3.0 * 2.0 * (1 + 0.5 + 0.25) / 1.5, 1e-9);
  EXPECT_EQ(at("MESH_FILENAME"), "case.su2");
  EXPECT_EQ(at("RESTART_SOL"), "NO");
  EXPECT_EQ(at("SOLUTION_FILENAME"), at("RESTART_FILENAME"));
  EXPECT_EQ(at("REYNOLDS_LENGTH"), "2");
  EXPECT_EQ(at("FREESTREAM_TEMPERATURE"), "288.15");
  EXPECT_THAT(log_, HasSubstr("case.su2, which does not exist yet"));
}

TEST_F(FlowScripts, Su2ConfigurationRefusesUnknownData) {
  const std::string mesh = "local m = volume_mesh{ read_surface 'ball.off', layers = 2, first_height = 0.02, farfield = sphere{ radius = 8 } } m:su2_config{ " +
                           out("case.cfg") + ", ";
  EXPECT_THAT(error(mesh + "speed = 5, density = 1000, viscosity = 1e-3, length = 1 }"),
              AllOf(HasSubstr("Mach number is unknown"), HasSubstr("temperature is unknown"), HasSubstr("reference area is unknown")));
  EXPECT_THAT(error(mesh + "mach = 0.5, altitude = 0, length = 1, reference_area = 1, boundaries = { prop = { thrust = 5 } } }"),
              HasSubstr("is called \"prop\""));
  EXPECT_THAT(error(mesh + "mach = 0.5, altitude = 0, length = 1, reference_area = 1, mesh = 'a.vtu' }"), HasSubstr("SU2 reads .su2 and .cgns"));
  EXPECT_FALSE(std::filesystem::exists(folder_ / "case.cfg"));
}

TEST(Su2Config, HalfModelsCountHalfTheArea) {
  const HybridMesh mesh = test::box_of_patches({{"wing", PatchKind::wall}, {"plane", PatchKind::symmetry}, {"far field", PatchKind::farfield}});
  const volmesh::FlowState flow = volmesh::flow_state({.length = 1.0, .mach = 0.5, .altitude = 0.0});
  std::string log;
  const RunContext context({.log = [&](LogLevel, std::string_view line) { log += line; }});
  const std::string text = su2_config(mesh, {.mesh = "a.cgns"}, {}, flow, {.area = 30.0}, {}, context);
  const auto keys = keys_of(text);
  EXPECT_EQ(keys.at("REF_AREA"), "15");
  EXPECT_EQ(keys.at("MARKER_SYM"), "( plane )");
  EXPECT_EQ(keys.at("MARKER_FAR"), "( far_field )");
  EXPECT_EQ(keys.at("MARKER_EULER"), "( wing )");  // no layers: no viscosity
  EXPECT_EQ(keys.at("MESH_FORMAT"), "CGNS");
  EXPECT_FALSE(keys.contains("MARKER_HEATFLUX"));
  EXPECT_THAT(log, HasSubstr("half of 30"));
  test::expect_error(ErrorCode::bad_argument, "a half model has no sideslip (beta)",
                     [&] { (void)su2_config(mesh, {.mesh = "a.su2"}, {.beta = 0.1}, flow, {.area = 30.0}, {}, context); });
}

TEST(Su2Config, WallsOfLargeYPlusGetWallFunctions) {
  HybridMesh mesh = test::box_of_patches({{"wing", PatchKind::wall}, {"far field", PatchKind::farfield}});
  const volmesh::FlowState flow = volmesh::flow_state({.length = 1.0, .mach = 0.5, .altitude = 0.0});
  const double of_one = volmesh::first_height({.y_plus = 1.0}, flow).height;
  const auto markers_of = [&](double y_plus, const char* choice, const char* solver) {
    mesh.request.first_height = y_plus * of_one;
    const auto keys = keys_of(su2_config(mesh, {.mesh = "a.su2", .solver = solver, .wall_functions = choice}, {}, flow, {.area = 30.0}, {}, RunContext()));
    return keys.contains("MARKER_WALL_FUNCTIONS") ? keys.at("MARKER_WALL_FUNCTIONS") : std::string("none");
  };
  EXPECT_EQ(markers_of(50.0, "automatic", "RANS"), "( wing, STANDARD_WALL_FUNCTION )");
  EXPECT_EQ(markers_of(1.0, "automatic", "RANS"), "none");
  EXPECT_EQ(markers_of(50.0, "no", "RANS"), "none");
  EXPECT_EQ(markers_of(50.0, "automatic", "NAVIER_STOKES"), "none");
  EXPECT_EQ(markers_of(0.0, "automatic", "RANS"), "none");  // of a file: nothing is known of what was asked
  EXPECT_EQ(markers_of(0.0, "yes", "RANS"), "( wing, STANDARD_WALL_FUNCTION )");
}

/// CFL numbers and the linear solver by the least angle that was measured, with the figure in the file; the run ends when forces have settled.
TEST(Su2Config, NumericsFollowFromTheMesh) {
  const HybridMesh mesh = test::box_of_patches({{"wing", PatchKind::wall}, {"far field", PatchKind::farfield}});
  const volmesh::FlowState flow = volmesh::flow_state({.length = 1.0, .mach = 0.5, .altitude = 0.0});
  const auto made = [&](double degrees, double cfl, double alpha) {
    return su2_config(mesh, {.mesh = "a.su2", .solver = "RANS", .cfl = cfl}, {.alpha = alpha}, flow, {.area = 30.0}, {}, RunContext(),
                      {.worst = degrees * k_degree, .location = Point{1, 2, 3}});
  };
  const auto adapted = [&](double degrees, double cfl) { return keys_of(made(degrees, cfl, 0.0)).at("CFL_ADAPT_PARAM"); };
  EXPECT_EQ(adapted(30, k_automatic), "( 0.1, 1.2, 10, 1000 )");
  EXPECT_EQ(adapted(12, k_automatic), "( 0.1, 1.2, 5, 100 )");
  EXPECT_EQ(adapted(3, k_automatic), "( 0.1, 1.2, 1, 20 )");
  EXPECT_EQ(adapted(3, 50), "( 0.1, 1.2, 1, 50 )");  // what is asked for stands
  EXPECT_EQ(keys_of(made(3, k_automatic, 0.0)).at("LINEAR_SOLVER_ITER"), "20");
  EXPECT_THAT(made(3, k_automatic, 0.0), HasSubstr("is 3 degrees at (1, 2, 3), below 5"));
  EXPECT_EQ(keys_of(made(30, k_automatic, 0.0)).at("CONV_FIELD"), "DRAG");  // lift may be zero
  const auto lifting = keys_of(made(30, k_automatic, 0.1));
  EXPECT_EQ(lifting.at("CONV_FIELD"), "( DRAG, LIFT )");
  EXPECT_EQ(lifting.at("CONV_CAUCHY_EPS"), "1e-05");  // 0.2 % over 200 iterations
}

TEST(Su2Config, TunnelsGetTheConditionsOfTheirFlow) {
  const HybridMesh mesh =
      test::box_of_patches({{"inlet", PatchKind::inflow}, {"outlet", PatchKind::outflow}, {"floor", PatchKind::wall}, {"side", PatchKind::slip}});
  const volmesh::FlowState flow = volmesh::flow_state({.length = 1.0, .speed = 60.0, .temperature = 293.0, .pressure = 1e5});
  const auto keys = keys_of(su2_config(mesh, {.mesh = "a.su2", .solver = "RANS"}, {.monitor = "floor"}, flow, {.area = 1.0}, {}, RunContext()));
  EXPECT_EQ(keys.at("MARKER_OUTLET"), "( outlet, 100000 )");
  const std::string inlet = keys.at("MARKER_INLET");
  EXPECT_THAT(inlet, AllOf(HasSubstr("( inlet, 294.79"), HasSubstr(", 1, 0, 0 )")));  // into the box; T0 = T + V^2 / (2 cp)
  EXPECT_EQ(keys.at("INIT_OPTION"), "TD_CONDITIONS");
  EXPECT_EQ(keys.at("MARKER_HEATFLUX"), "( floor, 0.0 )");
  EXPECT_EQ(keys.at("MARKER_ANALYZE"), "( inlet, outlet )");
  EXPECT_THAT(keys.at("HISTORY_OUTPUT"), AllOf(HasSubstr("AERO_COEFF"), HasSubstr("FLOW_COEFF")));
}

/// A duct: all walls are the tunnel's, no forces count, and no reference area is needed.
TEST(Su2Config, InternalFlowsNeedNoForcesAndNoArea) {
  const HybridMesh mesh = test::box_of_patches(
      {{"inlet", PatchKind::inflow}, {"outlet", PatchKind::outflow}, {"floor", PatchKind::wall}, {"side", PatchKind::symmetry}, {"roof", PatchKind::symmetry}});
  const volmesh::FlowState flow = volmesh::flow_state({.length = 1.0, .speed = 60.0, .temperature = 293.0, .pressure = 1e5});
  const auto keys = keys_of(su2_config(mesh, {.mesh = "a.su2", .solver = "RANS"}, {}, flow, {}, {}, RunContext()));
  EXPECT_EQ(keys.at("MARKER_MONITORING"), "( NONE )");
  EXPECT_EQ(keys.at("MARKER_ANALYZE"), "( inlet, outlet )");
  EXPECT_EQ(keys.at("MARKER_ANALYZE_AVERAGE"), "MASSFLUX");
  EXPECT_THAT(keys.at("SCREEN_OUTPUT"), HasSubstr("SURFACE_PRESSURE_DROP"));
  EXPECT_THAT(keys.at("HISTORY_OUTPUT"), HasSubstr("FLOW_COEFF"));
  EXPECT_EQ(keys.at("REF_AREA"), "1");
  for (const auto& [key, value] : keys) EXPECT_TRUE(k_su2_keys.contains(key)) << key;
  // A body in a farfield has forces, and coefficients an area.
  const HybridMesh outer = test::box_of_patches({{"wing", PatchKind::wall}, {"far", PatchKind::farfield}});
  test::expect_error(ErrorCode::bad_argument, "reference area is unknown", [&] { (void)su2_config(outer, {.mesh = "a.su2"}, {}, flow, {}, {}, RunContext()); });
}

TEST(Su2Config, DiscsRequireTheirData) {
  const HybridMesh mesh =
      test::box_of_patches({{"prop", PatchKind::interface}, {"prop.back", PatchKind::interface}, {"body", PatchKind::wall}, {"far", PatchKind::farfield}});
  const volmesh::FlowState flow = volmesh::flow_state({.length = 1.0, .mach = 0.2, .altitude = 0.0});
  test::expect_error(ErrorCode::bad_argument, "the pressure jump of the actuator disc \"prop\" is unknown",
                     [&] { (void)su2_config(mesh, {.mesh = "a.su2"}, {}, flow, {.area = 1.0}, {}, RunContext()); });
  const auto keys = keys_of(su2_config(mesh, {.mesh = "a.su2"}, {}, flow, {.area = 1.0}, {{"prop", {.thrust = 50.0}}}, RunContext()));
  EXPECT_EQ(keys.at("MARKER_ACTDISK"), "( prop, prop.back, 50, 0, 0, 50, 0, 0 )");
}

// ---- pentagrow ---------------------------------------------------------------------------------------------------------------------------------

/// As CEASIOMpy writes it.
constexpr const char* k_ceasiompy_config =
    "InputFormat = stl\nNLayers = 6\nFeatureAngle = 40\nInitialHeight = 0.01\nMaxGrowthRatio = 1.2\nMaxLayerThickness = 10\nFarfieldRadius = "
    "20\nOutputFormat "
    "= su2\n"
    "HolePosition = 0.0 0.0 0.0\nFarfieldCenter = 0.0 0.0 0.0\nHeightIterations = 8\nNormalIterations = 8\nMaxCritIterations = 128\nLaplaceIterations = "
    "8\nSymmetry = false\n";

TEST(PentagrowConfig, OfCeasiompy) {
  const PentagrowCase given = read_pentagrow_config(k_ceasiompy_config, "rans.cfg");
  const volmesh::EnvelopeOptions& layer = given.options.envelope;
  EXPECT_EQ(layer.layers, 6);
  EXPECT_EQ(layer.first_height, 0.01);
  EXPECT_EQ(layer.max_growth, 1.2);
  EXPECT_NEAR(layer.feature_angle, 0.698, 1e-3);
  EXPECT_EQ(layer.max_retract_sweeps, 128);
  EXPECT_EQ(layer.height_sweeps, 8);
  EXPECT_EQ(given.options.farfield.farfield_radius, 20.0);
  EXPECT_EQ(given.options.farfield.farfield_center_x, 0.0);
  EXPECT_EQ(given.options.prisms.wall_perpendicularity, 0.0);
  EXPECT_EQ(given.outputs, std::vector<std::filesystem::path>{"hybrid.su2"});
  EXPECT_FALSE(given.is_half);
  EXPECT_TRUE(given.notes.empty()) << given.notes.front();
}

TEST(PentagrowConfig, EveryKey) {
  const PentagrowCase given = read_pentagrow_config(
      "# all of them\nInputFormat = cgns\nOutputFormat = bmsh, zml, cgns, tau\nNLayers = 35 # comment\nInitialHeight = 1e-6\nMaxLayerThickness = "
      "0.5\nMaxRelativeHeight = 4\nMaxGrowthRatio = 1.3\nFeatureAngle = 31\n"
      "SharpEdgeAngle = 130\nSplineNormals = Yes\nWallNormalTransition = 0.1\nHeightIterations = 4\nNormalIterations = 40\nLaplaceIterations = "
      "3\nMaxCritIterations = 50\nUntangleGrid = n\nMaxOptimizationTime = 0\n"
      "VerboseOptimization = true\nFarfieldRadius = 50\nFarfieldSubdivision = 2\nHolePosition = 1 2 3 4 5 6\nTetgenPath = /usr/bin/tetgen\nTetgenOptions = "
      "-pq1.3VYa0.1S500\nMaxSteinerPoints = 100\nMaxGlobalEdgeLength = 3\n"
      "TetGrowthFactor = 1.4\nTetEdgeSmoothing = 64\nTetEdgeDistrib = 2\nRefineBoxCount = 2\nRefineBoxXLimits = 0 1 2 3\nRefineBoxYLimits = 0 1 0 "
      "1\nRefineBoxZLimits = 0 1 0 1\nRefineBoxEdgeLength = 0.1 0.2\n"
      "NearfieldEdgeLength = -1\nNearfieldSize = 2\nNearfieldCenter = 0 0 0\nNearfieldSemiAxes = 3 2 1\nPass = both\nSymmetry = y\nYPlaneCut = 0.5\n",
      "all.cfg");
  EXPECT_EQ(given.outputs.size(), 3u);
  EXPECT_EQ(given.options.prisms.wall_perpendicularity, 0.1);
  EXPECT_EQ(given.options.envelope.max_relative_height, 4.0);
  EXPECT_EQ(given.options.envelope.optimiser, "none");
  EXPECT_EQ(given.options.farfield.farfield_center_x, 1.0);
  EXPECT_NEAR(given.options.farfield.farfield_edge, 50.0 * 1.0515 / 4.0, 1e-2);
  EXPECT_EQ(given.options.tetrahedra.radius_edge, 1.3);
  EXPECT_EQ(given.options.tetrahedra.boundary_splits, "never");
  EXPECT_EQ(given.options.tetrahedra.max_new_points, 100.0);
  EXPECT_EQ(given.options.size.size_max, 3.0);
  EXPECT_EQ(given.options.size.size_growth, 1.4);
  ASSERT_EQ(given.options.sources.size(), 2u);
  EXPECT_EQ(given.options.sources[1].from.x, 2.0);
  EXPECT_TRUE(given.is_half);
  EXPECT_EQ(given.cut, 0.5);
  const auto near = nearfield_sources(given, test::cube(1));
  ASSERT_EQ(near.size(), 1u);
  EXPECT_EQ(near[0].to.x, 3.0);
  std::string notes;
  for (const std::string& note : given.notes) notes += note + "\n";
  for (const char* part :
       {"all.cfg:3: OutputFormat", "all.cfg:10: SharpEdgeAngle", "UntangleGrid", "TetgenPath", "TetEdgeSmoothing", "MaxSteinerPoints", "NearfieldEdgeLength"})
    EXPECT_THAT(notes, HasSubstr(part));
}

TEST(PentagrowConfig, DefaultsAreThoseOfTheCode) {
  const PentagrowCase given = read_pentagrow_config("", "");
  EXPECT_EQ(given.options.envelope.layers, 21);
  EXPECT_EQ(given.options.envelope.first_height, 1e-5);
  EXPECT_EQ(given.options.envelope.max_growth, 1.5);
  EXPECT_NEAR(given.options.envelope.feature_angle, 0.7679, 1e-4);
  EXPECT_EQ(given.options.envelope.max_thickness, 1.0);
  EXPECT_EQ(given.options.envelope.max_relative_height, 5.0);
  EXPECT_EQ(given.options.farfield.farfield_radius, 100.0);
  EXPECT_EQ(given.outputs, std::vector<std::filesystem::path>{"hybrid.bmsh"});
}

TEST(PentagrowConfig, MistakesAreReportedTogetherWithLines) {
  const auto message = [](const std::string& text) {
    try {
      read_pentagrow_config(text, "a.cfg");
    } catch (const Error& error) {
      return std::string(error.what());
    }
    return std::string("no error");
  };
  EXPECT_THAT(message("NLayers = 20\n\nInitialHieght = 1e-5\n"), HasSubstr("a.cfg:3: unknown key \"InitialHieght\", did you mean \"InitialHeight\"?"));
  EXPECT_THAT(message("nlayers = 20\n"), HasSubstr("did you mean \"NLayers\"?"));
  EXPECT_THAT(message("NLayers = many\nSymmetry = maybe\nFarfieldCenter = 1 2\nnonsense\n"),
              AllOf(HasSubstr("4 problems"), HasSubstr("a.cfg:1: NLayers: \"many\" is not a number"), HasSubstr("a.cfg:2: Symmetry = maybe: expected y, yes"),
                    HasSubstr("a.cfg:3: FarfieldCenter: found 2 numbers, expected 3"), HasSubstr("a.cfg:4: \"nonsense\" is not Key = value")));
  EXPECT_THAT(message("Pass = first\n"), HasSubstr("--stages"));
  EXPECT_THAT(message("OutputFormat = zml\n"), HasSubstr("use cgns, su2, bmsh or tau"));
  EXPECT_THAT(message("RelativeHeight = 4\n"), HasSubstr("did you mean \"MaxRelativeHeight\"?"));
  EXPECT_THAT(message("NLayers = 2.5\n"), HasSubstr("expected a whole number"));
}

TEST_F(FlowScripts, ProgramCalledPentagrow) {
  std::ofstream(folder_ / "rans.cfg") << k_ceasiompy_config;
  io::write_surface_file(test::sphere(6), folder_ / "wall.stl", RunContext());
  const test::ProcessResult result = test::run_process(test::build_folder() / "pentagrow", {"wall.stl", "rans.cfg"}, folder_);
  EXPECT_EQ(result.status, 0) << result.errors;
  for (const char* name : {"hybrid.su2", "outermost.vtu", "boundaries.smesh", "sumcos.txt", "diagnose.txt"})
    EXPECT_TRUE(std::filesystem::exists(folder_ / name)) << name;
  const SurfaceSoup boundary = io::read_surface_file(folder_ / "boundaries.smesh", RunContext());
  EXPECT_EQ(boundary.triangles.size(), 20u * 36u + 1280u);
  EXPECT_THAT(text_of("diagnose.txt"), HasSubstr("0 elements are tangled"));
  const test::ProcessResult wrong = test::run_process(test::sterna_program(), {"pentagrow", "wall.stl", "absent.cfg"}, folder_);
  EXPECT_NE(wrong.status, 0);
  EXPECT_THAT(wrong.errors, HasSubstr("absent.cfg"));
}

TEST_F(FlowScripts, HeightsFromFlowOnTheCommandLine) {
  const std::vector<std::string> mesh = {"mesh", "ball.off", "-o", "m.su2", "--farfield", "sphere radius=8"};
  const auto with = [&](std::initializer_list<std::string> more) {
    std::vector<std::string> all = mesh;
    all.insert(all.end(), more);
    return test::run_process(test::sterna_program(), all, folder_);
  };
  const test::ProcessResult made = with({"--layers", "6", "--first-height", "y_plus 100 reynolds=1e6 length=2", "--total-height",
                                         "boundary_layer factor=1.5 reynolds=1e6 length=2", "--patch", "wall:total_height=0.05"});
  EXPECT_EQ(made.status, 0) << made.errors;
  EXPECT_THAT(made.output + made.errors, AllOf(HasSubstr("y+ 100 at the first node"), HasSubstr("6 layers grow by")));
  EXPECT_THAT(with({"--layers", "6", "--first-height", "y_plus 1 reynolds=1e6 lenght=2"}).errors, HasSubstr("length"));
  EXPECT_THAT(with({"--layers", "6", "--first-height", "0.01", "--refinement", "finest"}).errors, HasSubstr("extra_fine"));
}

}  // namespace
}  // namespace sterna::scripting
