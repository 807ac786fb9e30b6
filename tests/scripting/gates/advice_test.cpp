// Advice is tested: for each kind of FAIL a mesh that has it is made again as the printed remedy says, and the value must be better.
#include <gmock/gmock.h>

#include <array>
#include <fstream>
#include <vector>

#include "geom/mesh/check.h"
#include "io/file/volume_file.h"
#include "tests/scripting/script_fixture.h"

namespace sterna::scripting {
namespace {

using testing::HasSubstr;

class Advice : public ScriptFixture {
 protected:
  /// Runs a script that leaves its mesh in `mesh`; all gates of it, for both kinds of solvers.
  CheckReport checked(const std::string& script) {
    run(script + " mesh:check() mesh:write(" + out("mesh.sterna") + ")", {}, 2);
    return check(io::read_volume_file(folder_ / "mesh.sterna", RunContext({.threads = 2})), {.intersections = false}, RunContext({.threads = 2}));
  }

  /// The remedy of the measure has these words, and as it says the worst value is better in `after` than in `before`.
  static void expect_better(Measure measure, const std::string& words, const CheckReport& before, const CheckReport& after) {
    const MeasureInfo& info = info_of(measure);
    SCOPED_TRACE(std::string(info.name));
    const GateResult &first = before.gate(measure), &then = after.gate(measure);
    EXPECT_THAT(std::string(remedy_of(measure)), HasSubstr(words));
    if (info.is_low_bad) EXPECT_GT(then.worst, first.worst) << to_text(first) << to_text(then);
    else EXPECT_LT(then.worst, first.worst) << to_text(first) << to_text(then);
  }
  /// The same where the measure is beyond its hard limit before and keeps it then.
  static void expect_repaired(Measure measure, const std::string& words, const CheckReport& before, const CheckReport& after) {
    EXPECT_TRUE(before.gate(measure).is_hard_missed) << to_text(before.gate(measure));
    EXPECT_FALSE(after.gate(measure).is_hard_missed) << to_text(after.gate(measure));
    expect_better(measure, words, before, after);
  }
};

/// Two cubes of edge 1, one 0.03 above the other, of twelve triangles each.
void write_cubes_with_gap(const std::filesystem::path& path) {
  constexpr int k_quads[6][4] = {{0, 2, 3, 1}, {4, 5, 7, 6}, {0, 1, 5, 4}, {1, 3, 7, 5}, {3, 2, 6, 7}, {2, 0, 4, 6}};
  std::ofstream file(path);
  file << "solid cubes\n";
  const auto facet = [&](double low, double high, std::initializer_list<int> corners) {
    file << "facet normal 0 0 0\nouter loop\n";
    for (const int k : corners) file << "vertex " << (k & 1) << " " << (k >> 1 & 1) << " " << ((k & 4) != 0 ? high : low) << "\n";
    file << "endloop\nendfacet\n";
  };
  for (const auto& [low, high] : {std::pair(0.0, 1.0), std::pair(1.03, 2.0)})
    for (const auto& q : k_quads) {
      facet(low, high, {q[0], q[1], q[2]});
      facet(low, high, {q[0], q[2], q[3]});
    }
  file << "endsolid cubes\n";
}

TEST_F(Advice, RemeshingGapWallsImprovesTheirCells) {
  write_cubes_with_gap(folder_ / "cubes.stl");
  const std::string read = "local wall = read_surface{ 'cubes.stl' } ",
                    mesh = " local mesh = volume_mesh{ wall, layers = 8, first_height = 1e-3, farfield = sphere{ radius = 10 } }";
  const CheckReport before = checked(read + mesh), after = checked(read + "wall = remesh{ wall, max_edge = 0.3, gap_cells = 2 }" + mesh);
  expect_repaired(Measure::tet_growth, "in gaps with gap_cells", before, after);
  for (const Measure measure : {Measure::face_weight, Measure::volume_ratio}) expect_better(measure, "remesh the wall there", before, after);
}

/// A wing whose trailing edge has that width.
std::string wing_with_edge(const std::string& width) {
  return "local wall = surface_mesh{ aircraft{ wing{ name = 'wing', symmetric = true, trailing_edge = " + width +
         ", sections = { { y = 0, chord = 1, airfoil = 'naca0012' }, { y = 2, chord = 0.5, sweep = 20*deg } } } }, max_edge = 0.3 } ";
}
std::string mesh_of_wing(const std::string& options) {
  return "local mesh = volume_mesh{ wall, first_height = 1e-3, farfield = sphere{ radius = 20 }, " + options + " }";
}

TEST_F(Advice, SharpEdges) {
  const CheckReport sharp = checked(wing_with_edge("0") + mesh_of_wing("layers = 12"));
  const CheckReport blunt = checked(wing_with_edge("0.01") + mesh_of_wing("layers = 12"));
  for (const Measure measure : {Measure::min_dihedral, Measure::face_weight, Measure::volume_ratio, Measure::face_tets})
    expect_repaired(measure, "at a sharp edge, give the edge a width", sharp, blunt);
  for (const Measure measure : {Measure::sub_volume_ratio, Measure::edge_ratio}) expect_better(measure, "at a sharp edge, give the edge a width", sharp, blunt);
  expect_repaired(Measure::layer_step, "give the sharp edge there a width", sharp, blunt);
  for (const Measure measure : {Measure::orthogonality, Measure::non_orthogonality}) expect_better(measure, "give the sharp edge a width", sharp, blunt);
  expect_better(Measure::skewness, "a width of the edge", sharp, blunt);
  const CheckReport fans = checked(wing_with_edge("0") + mesh_of_wing("layers = 12, ridges = { open_ridges = 'always' }"));
  expect_better(Measure::skewness, "open_ridges = \"always\"", sharp, fans);
  const CheckReport few = checked(wing_with_edge("0") + mesh_of_wing("layers = 8"));
  expect_repaired(Measure::layer_step, "or fewer layers", sharp, few);
  for (const Measure measure : {Measure::interface_height, Measure::interface_volume}) expect_better(measure, "more layers", few, sharp);
}

TEST_F(Advice, FirstHeightsInCornersWhereLayersAreSqueezed) {
  const auto script = [](const std::string& options) {
    return R"(local body = fuselage{ name = "body", frames = {
  { x = 0.3, diameter = 0.5, z = -0.08 }, { x = 1.2, diameter = 1.1 }, { x = 2.4, diameter = 1.3 }, { x = 4.6, diameter = 1.25 },
  { x = 6.6, diameter = 0.8, z = 0.12 },  { x = 8.2, diameter = 0.35, z = 0.25 } } }
local main_wing = wing{ name = "wing", symmetric = true, position = { 2.6, 0, -0.15 }, trailing_edge = 0.015, sections = {
  { y = 0, chord = 1.7, airfoil = "naca2412", twist = 2*deg }, { y = 5, chord = 0.9, sweep = 3*deg, dihedral = 5*deg } } }
local wall = surface_mesh{ aircraft{ body, main_wing }, max_edge = 0.5, curvature_angle = 30*deg, min_edge = 20*mm }
local mesh = volume_mesh{ wall, first_height = 2e-4, farfield = sphere{ radius = 40 })" +
           options + " }";
  };
  const CheckReport before = checked(script(""));
  expect_repaired(Measure::first_height, "truncate = \"auto\"", before, checked(script(", truncate = 'auto'")));
  expect_repaired(Measure::first_height, "or fewer layers", before, checked(script(", layers = 15")));
}

const std::string k_short_can = "local can = cylinder{ {0,0,0}, {2,0,0}, radius=1, name='can' } local wall = surface_mesh{ can, max_edge=0.5 } ";

TEST_F(Advice, LayerLowerThanTheBoundaryLayer) {
  const std::string flow = "local cruise = flow{ mach = 0.2, altitude = 0, length = 2 } ";
  const CheckReport before =
      checked(flow + k_short_can + "local mesh = volume_mesh{ wall, layers = 5, first_height = y_plus{ 100, cruise }, farfield = sphere{ radius = 10 } }");
  const CheckReport after = checked(flow + k_short_can +
                                    "local mesh = volume_mesh{ wall, total_height = boundary_layer{ cruise }, max_growth = 1.3, first_height = y_plus{ 100, "
                                    "cruise }, farfield = sphere{ radius = 10 } }");
  expect_repaired(Measure::boundary_layer, "total_height = boundary_layer{ ... }", before, after);
}

TEST_F(Advice, FewLayersWithLargeGrowthReachTotalHeight) {
  const auto script = [](int layers) {
    return k_short_can + "local mesh = volume_mesh{ wall, layers = " + std::to_string(layers) +
           ", first_height = 1e-3, total_height = 0.3, farfield = sphere{ radius = 10 } }";
  };
  expect_repaired(Measure::stack_growth, "more layers", checked(script(6)), checked(script(20)));
}

TEST_F(Advice, FacetsTurnedAgainstTheirModel) {
  const auto reported = [&](const std::string& sizes) {
    return run("local can = cylinder{ {0,0,0}, {2,0,0}, radius=1, name='can' } local wall = surface_mesh{ can, max_edge = 2, " + sizes +
               " } local mesh = volume_mesh{ wall, layers = 3, first_height = 1e-2, farfield = sphere{ radius = 10 } } mesh:check{ wall = wall }");
  };
  EXPECT_THAT(std::string(remedy_of(Measure::cad_normal)), HasSubstr("a smaller chord_error or curvature_angle"));
  EXPECT_THAT(reported("curvature_angle = 70*deg, chord_error = 0.5"), HasSubstr("G18  wall facets against the CAD      warn"));
  EXPECT_THAT(reported("curvature_angle = 15*deg, chord_error = 0.01"), HasSubstr("G18  wall facets against the CAD      pass"));
}

TEST_F(Advice, WallsOffTheirModel) {
  const std::string mesh = " local mesh = volume_mesh{ used, layers = 3, first_height = 1e-2, farfield = sphere{ radius = 10 } } mesh:check{ wall = wall }";
  EXPECT_THAT(run(k_short_can + "wall:write 'can.obj' local used = remesh{ read_surface{ 'can.obj' }, max_edge = 0.4 }" + mesh),
              HasSubstr("G17  wall nodes off the CAD, / length FAIL"));
  EXPECT_THAT(std::string(remedy_of(Measure::cad_distance)), HasSubstr("mesh the model itself"));
  EXPECT_THAT(run(k_short_can + "local used = wall" + mesh), HasSubstr("G17  wall nodes off the CAD, / length pass"));
}

}  // namespace
}  // namespace sterna::scripting
