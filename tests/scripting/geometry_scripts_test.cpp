// Geometry from scripts: every verb that makes a model or a component, the methods of models, and refused input. Volumes and areas are compared with formulas.
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

class GeometryScripts : public ScriptFixture {};

using test::k_pi;
/// Relative tolerance for volumes and areas of exact shapes: accuracy of the quadrature, with room for rounding.
constexpr double k_exact = 1e-8;

TEST_F(GeometryScripts, SolidsHaveTheirVolume) {
  EXPECT_NEAR(number("box{ {0, 0, 0}, {1, 2, 3} }:measures().volume"), 6.0, 6.0 * k_exact);
  EXPECT_NEAR(number("cylinder{ {0, 0, 0}, {0, 3, 4}, radius = 0.5 }:measures().volume"), 0.25 * k_pi * 5.0, 4.0 * k_exact);
  EXPECT_NEAR(number("-test_section{ length = 6, width = 2, height = 1.5 }:measures().volume"), 18.0, 18.0 * k_exact);  // the fluid is inside
  EXPECT_EQ(run("print(box{ {0, 0, 0}, {1, 2, 3}, name = 'block' })"), "Model: 1 component, 6 faces, 1 closed solid, 1 x 2 x 3 m\n");
}

TEST_F(GeometryScripts, ModelsAreMovedTurnedScaledAndMirrored) {
  // x aft, y starboard, z up: pitch lifts the nose, yaw takes it to starboard, roll lowers the starboard wing.
  const std::string nose = "local b = box{ {-1.01, -0.01, -0.01}, {-0.99, 0.01, 0.01} } ";
  EXPECT_GT(number("(function() " + nose + "return b:rotate{ pitch = 10*deg }.min[3] end)()"), 0.15);
  EXPECT_GT(number("(function() " + nose + "return b:rotate{ yaw = 10*deg }.min[2] end)()"), 0.15);
  EXPECT_LT(number("box{ {-0.01, 0.99, -0.01}, {0.01, 1.01, 0.01} }:rotate{ roll = 10*deg }.max[3]"), -0.15);
  EXPECT_NEAR(number("box{ {0, 0, 0}, {2, 1, 1} }:rotate{ axis = {0, 0, 1}, angle = 90*deg }.max[2]"), 2.0, 1e-12);
  EXPECT_NEAR(number("box{ {0, 0, 0}, {1, 1, 1} }:move{ 1, 2, 3 }.max[3]"), 4.0, 1e-12);
  EXPECT_NEAR(number("box{ {0, 0, 0}, {1, 2, 3} }:scale(0.1):measures().volume"), 0.006, 0.006 * k_exact);
  EXPECT_EQ(run("local m = box{ {0, 1, 0}, {1, 2, 1}, name = 'left pod' }:mirror{} print(m.components[1], math.abs(m.min[2] + 2) < 1e-12, m:measures().volume "
                "> 0.999)"),
            "right pod\ttrue\ttrue\n");
}

TEST_F(GeometryScripts, BodiesAreNowhereThickerThanTheirFrames) {
  // Two short steps beside a long one: parabolas through three points would overshoot to twice the width.
  EXPECT_NEAR(number("(function() local m = fuselage{ frames = { {x=0,diameter=0}, {x=2,diameter=4}, {x=20,diameter=4}, {x=30,diameter=0.5} } }:model() return "
                     "m.max[2] - m.min[2] end)()"),
              4.0, 1e-3);
  EXPECT_NEAR(number("(function() local m = body_of_revolution{ profile = { {0,0}, {1,0.1}, {10,0.1}, {11,0} } }:model() return m.max[3] - m.min[3] end)()"),
              0.2, 1e-4);
}

TEST_F(GeometryScripts, WhatSmxCannotHoldIsRefused) {
  const std::string wing =
      "local w = wing{ name = 'w', symmetric = true, sections = { {y=0,chord=1,airfoil='naca0012'}, {y=3} }%s } %s aircraft{ w, unite = false }:write(" +
      out("w.smx") + ")";
  const auto with = [&](const std::string& option, const std::string& then) {
    std::string text = wing;
    text.replace(text.find("%s"), 2, option);
    text.replace(text.find("%s"), 2, then);
    return text;
  };
  EXPECT_THAT(error(with("", "")), AllOf(HasSubstr("open at its trailing edge"), HasSubstr("trailing_edge = 0")));
  EXPECT_THAT(error(with(", trailing_edge = 0", "w:deflect{ 'flap', from = {0.2, 0.7}, to = {0.6, 0.7}, angle = 30*deg }")),
              HasSubstr("control surface 'flap' is deflected"));
  EXPECT_THAT(
      error("aircraft{ fuselage{ name='b', frames = { {x=0,diameter=1}, {x=2,diameter=2}, {x=4,diameter=1} } }, unite = false }:write(" + out("b.smx") + ")"),
      HasSubstr("does not overshoot between its frames"));
}

TEST_F(GeometryScripts, FoldedWingsAndTurnsInDegreesAreErrors) {
  EXPECT_THAT(error("wing{ sections = { {y=0,chord=1,airfoil='naca0012'}, {y=3,chord=1.5}, {y=2} }, tip = 'flat' }:model()"),
              AllOf(HasSubstr("the wing folds back onto itself"), HasSubstr("order along the span")));
  EXPECT_THAT(error("box{ {0,0,0}, {1,1,1} }:rotate{ pitch = 30 }"), HasSubstr("pitch"));
}

TEST_F(GeometryScripts, NamesAreChangedAndSelected) {
  EXPECT_EQ(run("local m = assembly{ box{ {0,0,0}, {1,1,1} }, box{ {2,0,0}, {3,1,1} }, cylinder{ {5,0,0}, {6,0,0}, radius = 1 } } "
                "print(table.concat(m.components, ' ')) print(m['box*'], m:select('cyl?nder').faces) "
                "print(table.concat(m:rename{ box2 = 'crate' }.patches, ' '))"),
            "box box2 cylinder\nModel: 2 components, 12 faces, 2 closed solids, 3 x 1 x 1 m\t4\nbox crate cylinder\n");
  EXPECT_THAT(error("box{ {0,0,0}, {1,1,1} }:rename{ boxx = 'a' }"), HasSubstr("no component and no face is named \"boxx\", did you mean \"box\"?"));
  EXPECT_THAT(error("print(box{ {0,0,0}, {1,1,1} }['wing*'])"), AllOf(HasSubstr("no component is named \"wing*\""), HasSubstr("components: box")));
}

TEST_F(GeometryScripts, FunctionsDeformModels) {
  // A shear preserves volumes; stretching z by 1 + y / 10 gives the volume of the formula.
  EXPECT_NEAR(number("box{ {0,0,0}, {1,1,1} }:deform{ function(x, y, z) return 0.3*z, 0, 0 end }:measures().volume"), 1.0, 1e-6);
  EXPECT_NEAR(number("box{ {0,0,0}, {1,2,1} }:deform{ function(x, y, z) return 0, 0, 0.1*y*z end, tolerance = 1e-9 }:measures().volume"), 2.2, 1e-7);
  EXPECT_NEAR(number("box{ {0,0,0}, {1,2,1} }:deform{ { {0,0,0,0,0,0.5}, {1,0,0,0,0,0.5}, {0,1,0,0,0,0.5}, {0,0,1,0,0,0.5}, {1,1,1,0,0,0.5} } }.min[3]"), 0.5,
              1e-9);
  std::ofstream(folder_ / "bend.dat") << "# x y z dx dy dz\n0 0 0 0 0 1\n1 0 0 0 0 1\n0 1 0 0 0 1\n0 0 1 0 0 1\n";
  EXPECT_NEAR(number("box{ {0,0,0}, {1,2,1} }:deform{ 'bend.dat', kernel = 'wendland_c2' }.min[3]"), 1.0, 1e-9);
  EXPECT_THAT(error("box{ {0,0,0}, {1,1,1} }:deform{ function(x, y, z) return 0, 0 end }"), HasSubstr("must return 3 numbers here, but value 3 is nil"));
  EXPECT_THAT(error("box{ {0,0,0}, {1,1,1} }:deform{ function(x, y, z) return nosuch.x, 0, 0 end }"), AllOf(HasSubstr("case.lua:1"), HasSubstr("nosuch")));
  EXPECT_THAT(error("box{ {0,0,0}, {1,1,1} }:deform{ function(x, y, z) return 0, 0, y > 0.3 and 1 or 0 end }"), HasSubstr("a kink or step there"));
  EXPECT_THAT(error("box{ {0,0,0}, {1,1,1} }:deform{ function(x, y, z) return -2*x, 0, 0 end }"), HasSubstr("the deformation folds space"));
  EXPECT_THAT(error("box{ {0,0,0}, {1,1,1} }:deform{ function(x, y, z) return 0, 0, 0 end, kernel = 'thin_plate' }"), HasSubstr("unknown key \"kernel\""));
}

TEST_F(GeometryScripts, FunctionMayCallVerbsAndPassesTheirErrors) {
  EXPECT_THAT(error("box{ {0,0,0}, {1,1,1} }:deform{ function(x, y, z) local b = box{ {0,0,0}, {1,1,1} } return 0, 0, box{ {0,0,0} } end }"),
              HasSubstr("expected two points"));
  EXPECT_NEAR(number("box{ {0,0,0}, {1,1,1} }:deform{ function(x, y, z) return 0, 0, box{ {0,0,0}, {1,1,1} }.length end }.min[3]"), 1.0, 1e-9);
}

TEST_F(GeometryScripts, DeformedModelsAreEqualForAnyThreads) {
  const std::string text =
      "local m = box{ {0,0,0}, {1,2,1} }:deform{ function(x, y, z) return 0.02*math.sin(3*y), 0, 0.1*y^3 end } print(string.format('%.17g', "
      "m:measures().volume)) m:write(" +
      out("bent.step") + ")";
  std::string bytes;
  for (const int threads : {1, 2, 7}) {
    const std::string printed = run(text, {}, threads);
    std::ifstream file(folder_ / "bent.step", std::ios::binary);
    const std::string now = printed + std::string(std::istreambuf_iterator<char>(file), {});
    if (bytes.empty()) bytes = now;
    EXPECT_EQ(now, bytes) << threads;
  }
}

TEST_F(GeometryScripts, SurfacesOfFunctionsAreCheckedSplines) {
  const std::string ball =
      "surface{ function(u, v) return math.cos(u)*math.cos(v), math.sin(u)*math.cos(v), math.sin(v) end, u = {0, 2*math.pi}, v = {-math.pi/2, math.pi/2}, "
      "periodic_u = true, tolerance = 1e-6, name = 'ball' }";
  EXPECT_NEAR(number(ball + ":measures().volume"), 4.0 / 3.0 * k_pi, 2e-5);
  EXPECT_NEAR(number("surface{ function(u, v) return u, v, 0 end, u = {0, 2}, v = {0, 3} }:measures().area"), 6.0, 1e-9);
  EXPECT_EQ(run("print(surface{ function(u, v) return u, v, u*v end }.is_closed)"), "false\n");
  EXPECT_THAT(error("surface{ function(u, v) return u, v end }"), HasSubstr("must return 3 numbers"));
  EXPECT_THAT(error("surface{ 3 }"), HasSubstr("expected a function of (u, v) that returns x, y, z, not a number"));
  EXPECT_THAT(error("surface{ function(u, v) return u, v, u > 0.3 and 1 or 0 end }"), HasSubstr("tolerance"));
}

TEST_F(GeometryScripts, Airfoils) {
  EXPECT_NEAR(number("airfoil('naca2412').thickness"), 0.12, 5e-4);
  EXPECT_NEAR(number("airfoil{ 'naca0012', trailing_edge = 0.01 }.trailing_edge"), 0.01, 1e-12);
  EXPECT_EQ(run("print(#airfoil{ 'naca0012', points = 30 }.points)"), "61\n");
  EXPECT_LT(number("#airfoil{ 'naca0012', within = 1e-4 }.points"), 100.0);
  EXPECT_NEAR(number("airfoil{ {1, 0}, {0.7, 0.05}, {0.3, 0.08}, {0.1, 0.05}, {0, 0}, {0.1, -0.05}, {0.3, -0.08}, {0.7, -0.05}, {1, 0} }.thickness"), 0.16,
              0.01);
  EXPECT_THAT(error("airfoil 'naca99'"), HasSubstr("naca99"));
  EXPECT_THAT(error("airfoil 'absent.dat'"), HasSubstr("absent.dat"));
  EXPECT_THAT(error("airfoil{ 'naca0012', points = 30, within = 1e-4 }"), HasSubstr("give only one of the two"));
}

TEST_F(GeometryScripts, BodiesHaveTheSizesOfTheirFrames) {
  // A straight tube with flat ends.
  EXPECT_NEAR(number("fuselage{ frames = { {x=0, diameter=2}, {x=5, diameter=2} }, nose='flat', tail='flat' }:model():measures().volume"), 5.0 * k_pi, 5e-4);
  EXPECT_NEAR(number("fuselage{ frames = { {x=0, diameter=2}, {x=5, diameter=2} } }:model():measures().volume"), 5.0 * k_pi + 4.0 / 3.0 * k_pi,
              2e-3);  // with hemispheres at both ends
  EXPECT_NEAR(
      number("fuselage{ along='linear', nose='flat', tail='flat', frames = { {x=0, width=2, height=1}, {x=4, width=2, height=1} } }:model():measures().volume"),
      2.0 * k_pi, 1e-3);
  EXPECT_NEAR(number("fuselage{ along='linear', nose='flat', tail='flat', frames = { {x=0, points={{0,-1},{0.8,-0.6},{1,0},{0.8,0.6},{0,1}}}, {x=4, "
                     "diameter=2} } }:model().max[1]"),
              4.0, 1e-9);
  EXPECT_NEAR(number("body_of_revolution{ profile = {{0,0},{2,1},{4,1}}, straight = true }:model():measures().volume"), 2.0 * k_pi / 3.0 + 2.0 * k_pi, 1e-3);
  EXPECT_NEAR(number("sting{ from={0,0,0}, to={2,0,0}, diameter=0.2 }:model():measures().volume"), 0.02 * k_pi, 1e-5);
  EXPECT_THAT(run("local b = boom{ name='b', symmetric=true, from={0,1,0}, to={3,1,0.5}, diameter=0.2 } print(b) print(table.concat(b:model().components, ' "
                  "')) print(fairing{ length=2, width=1, height=1 }.kind)"),
              AllOf(HasSubstr("Boom \"b\": "), HasSubstr(" frames, 3.041 m long, and its mirror image\nb bLeft\nfairing\n")));
}

TEST_F(GeometryScripts, WingsFromFewNumbers) {
  const std::string plain = "wing{ name='w', symmetric=true, sections={ {y=0, chord=2, airfoil='naca0012'}, {y=4, chord=1, sweep=30*deg, dihedral=5*deg} } }";
  EXPECT_NEAR(number(plain + ".area"), 12.0, 1e-3);  // area of the planform seen from above
  EXPECT_NEAR(number(plain + ".unrolled_area"), 12.0 / std::cos(5.0 * k_pi / 180.0), 1e-3);
  EXPECT_NEAR(number(plain + ".projected_area"), 12.0, 1e-3);
  // The quarter chord line is swept by 30 degrees over the unrolled length of the panel.
  EXPECT_NEAR(number(plain + ":at(1, 0.25)[1]"), 0.5 + 4.0 / std::cos(5.0 * k_pi / 180.0) * std::tan(k_pi / 6.0), 1e-6);
  EXPECT_NEAR(number(plain + ":at(0.5, 0.25)[2]"), 2.0, 1e-6);
  EXPECT_NEAR(number("wing{ sections={ {chord=2, airfoil='naca0010'}, {z=3, chord=2} } }:model().max[3]"), 3.0, 0.11);       // an upright fin with a round tip
  EXPECT_LT(number("wing{ tip='flat', sections={ {chord=2, airfoil='naca0010'}, {z=3, chord=2} } }:model().max[2]"), 0.11);  // its thickness is across
  // Positive twist lifts the nose: the leading edge stays, the trailing edge goes down.
  EXPECT_LT(number("wing{ sections={ {y=0, chord=1, airfoil='naca0012', twist=5*deg}, {y=2, twist=5*deg} } }:at(0.5, 1)[3]"), -0.08);
  EXPECT_EQ(run("print(table.concat(wing{ symmetric=true, position={0,1,0}, sections={ {chord=1, airfoil='naca0012'}, {y=2} } }:model().components, ' '))"),
            "wing wingLeft\n");
  EXPECT_EQ(run("local w = wing{ symmetric=true, spanwise='cubic', sections={ {chord=1, airfoil='naca0012'}, {y=2}, {y=4, chord=0.6} }, winglet={ height=0.5, "
                "bend=0.3 } } print(w:model().is_closed, w:at(1, 0)[3] > 0.4)"),
            "true\ttrue\n");
}

TEST_F(GeometryScripts, WingletMayBeASeparatePatch) {
  const std::string sections = "sections={ {chord=1, airfoil='naca0012'}, {y=4, chord=0.6} }";
  for (const char* bend : {"0", "0.3"}) {
    const std::string winglet =
        ", winglet={ name='tip', height=0.5, bend=" + std::string(bend) + " } }:model() print(m.is_closed, table.concat(m.patches, ' '))";
    EXPECT_EQ(run("local m = wing{ " + sections + winglet), "true\ttip wing\n");
    EXPECT_EQ(run("local m = wing{ symmetric=true, " + sections + winglet), "true\ttip wing tipLeft\n");
  }
  // Round tips and blunt trailing edges of the part belong to the part; its area is the area missing from the wing.
  EXPECT_EQ(run("local function area(t) local m = surface_mesh{ wing{ trailing_edge=0.005, tip='round', sections={ {chord=1, airfoil='naca0012'}, {y=4, "
                "chord=0.6} }, "
                "winglet=t }:model(), max_edge=0.1 } local n = 0 for i, p in ipairs(m.patches) do n = i end return n end "
                "print(area{ height=0.5 }, area{ height=0.5, name='tip' })"),
            "1\t2\n");
  EXPECT_THAT(error("wing{ name='w', " + sections + ", winglet={ name='w', height=0.5 } }"), HasSubstr("winglet: name: \"w\" is the name of the wing"));
}

TEST_F(GeometryScripts, WingletBendRadiusIsLimitedByThickness) {
  const auto wing = [](const std::string& winglet) {
    return "wing{ symmetric=true, position={10, 0, 1}, sections={ {y=0, chord=1, airfoil='naca3417'}, {y=2, airfoil='naca0014'} }, winglet={ " + winglet +
           " } }";
  };
  // 7 % of the chord lies inside the bend, a right angle: a radius of 0.07 m, 0.11 m of arc.
  EXPECT_THAT(error(wing("height=0.25, cant=90*deg, bend=0.25")),
              AllOf(HasSubstr("winglet: bend: a turn by 90 deg over 0.25 of 0.25 m, at (10, 2, 1)"), HasSubstr("would fold: bend = 0.47 at least")));
  EXPECT_THAT(error(wing("height=0.1, cant=90*deg")), HasSubstr("would fold: height = 0.18"));
  EXPECT_EQ(run("local w = surface_mesh{ " + wing("height=0.25, cant=90*deg") + ":model(), max_edge=0.08, min_edge=0.01 } print(w.is_closed, w.crossings)"),
            "true\t0\n");
  // With a downward bend the lower side is on the inside.
  EXPECT_EQ(run("print(" + wing("height=0.25, cant=-90*deg, bend=0.47") + ".name)"), "wing\n");
  // If 0.25 is sufficient, the value is kept.
  EXPECT_EQ(number(wing("height=1, cant=90*deg") + ":at(1, 0)[3]"), number(wing("height=1, cant=90*deg, bend=0.25") + ":at(1, 0)[3]"));
}

TEST_F(GeometryScripts, BoxHoldsRoundTipsWithControlSurfaces) {
  for (const char* to : {"0.95", "1.0"}) {
    const std::string model = "local w = wing{ symmetric=true, sections={ {chord=1.6, airfoil='naca2412'}, {y=5} } } w:deflect{ 'flap', from={0.6, 0.7}, to={" +
                              std::string(to) + ", 0.7}, angle=20*deg } local m = aircraft{ w } ";
    EXPECT_NEAR(std::stod(run(model + "print(m.max[2])")), std::stod(run(model + "print(m:measures().components.wing.box[2][2])")), 2e-3) << to;
  }
}

TEST_F(GeometryScripts, HalfOfAsymmetricModelIsReported) {
  const std::string wing = "local w = wing{ symmetric=true, sections={ {y=0, chord=1, airfoil='naca0012'}, {y=4, chord=1} } } ";
  run(wing + "half(w:model())");
  EXPECT_THAT(log_, testing::Not(HasSubstr("warning")));
  run(wing + "w:deflect{ 'aileron', from={0.6, 0.7}, to={0.9, 0.7}, angle=5*deg, other_side='opposite' } half(w:model())");
  EXPECT_THAT(log_, HasSubstr("is not the mirror image of the kept side"));
}

TEST_F(GeometryScripts, ControlSurfacesAreDeflectedOrNamed) {
  const std::string wing = "local w = wing{ symmetric=true, sections={ {y=0, chord=1, airfoil='naca0012'}, {y=4, chord=1} } } ";
  const std::string clean = run(wing + "print(w:model():measures().volume)");
  EXPECT_EQ(run(wing + "w:control{ 'flap', from={0.2, 0.7}, to={0.5, 0.7} } local m = w:model() print(m.is_closed, table.concat(m.patches, ' "
                       "'):find('flapLeft') ~= nil) print(m.faces)")
                .substr(0, 9),
            "true\ttrue");
  EXPECT_EQ(run(wing + "w:deflect{ 'aileron', from={0.6, 0.7}, to={0.9, 0.7}, angle=25*deg, other_side='opposite' } local m = w:model() print(m.is_closed, "
                       "m.min[3] < -0.1, m.max[3] > 0.1) print(w)"),
            "true\ttrue\ttrue\nWing \"wing\": 2 sections, span 8 m, area 8 m^2, mean aerodynamic chord 1 m, both halves, aileron +25 deg\n");
  EXPECT_THAT(error(wing + "w:deflect{ 'a', from={0.6, 0.7}, angle=1*deg }"), HasSubstr("needs from and to, or hinge"));
  EXPECT_THAT(error(wing + "w:deflect{ 'a', from={0.6, 0.7}, to={0.9, 0.7} }"), HasSubstr("needs angle"));
  EXPECT_THAT(error(wing + "w:deflect{ 'a', from={0.6, 0.7}, to={1.6, 0.7}, angle=1*deg }"), HasSubstr("to: 1.6 is outside the wing"));
  EXPECT_THAT(error(wing + "w:control{ 'a', hinge={ {-0.5, 0.7}, {0.6, 1.7} } }"),
              testing::AllOf(HasSubstr("hinge: -0.5 is outside the wing"), HasSubstr("hinge: 1.7 is outside the chord")));
  EXPECT_THAT(error(wing + "w:control{ 'a', from={0.6, 0.7}, to={0.6, 0.8} }"), HasSubstr("same fraction of the span"));
  EXPECT_THAT(error(wing + "w:deflect{ 'a', from={0.6, 0.7}, to={0.9, 0.7}, angle=10 }"), HasSubstr("write degrees as 40*deg"));
  EXPECT_THAT(error(wing + "w:control{ 'a', from={0.6, 0.7}, to={0.9, 0.7} } w:control{ 'a', from={0.1, 0.7}, to={0.2, 0.7} }"),
              HasSubstr("has a control surface \"a\" already"));
  EXPECT_THAT(error("boom{ from={0,0,0}, to={1,0,0}, diameter=0.1 }:control{ 'a', from={0.6, 0.7}, to={0.9, 0.7} }"),
              HasSubstr("applies to wings, not to a boom"));
}

TEST_F(GeometryScripts, ComponentsAreFoundByListedNames) {
  EXPECT_EQ(run("local m = aircraft{ wing{ name='Wing', sections={ {chord=1, airfoil='naca2412'}, {y=4, chord=0.8} } }, body_of_revolution{ name='report', "
                "profile = { {0, 0}, {1, 0.3}, "
                "{2, 0} } }, unite=false } local same = true for _, name in ipairs(m.components) do if name ~= 'report' then same = same and "
                "m[name].components[1] == name "
                "and #m[name].components == 1 end end print(same, tostring(m['Wing']) == tostring(m['Win*']), m['report'] == m.report)"),
            "true\ttrue\ttrue\n");
  EXPECT_THAT(error("local m = aircraft{ wing{ name='Wing', sections={ {chord=1, airfoil='naca2412'}, {y=4, chord=0.8} } } } print(m['Wong'])"),
              HasSubstr("Wong"));
}

TEST_F(GeometryScripts, AnAircraftIsUnitedAndWritten) {
  const std::string parts =
      "local b = fuselage{ name='body', along='smooth', frames={ {x=0, diameter=0.6}, {x=2, diameter=1.2}, {x=6, diameter=1} } } "
      "local w = wing{ name='wing', symmetric=true, position={2, 0, 0.1}, sections={ {y=0, chord=1.5, airfoil='naca2412'}, {y=4, chord=0.8} } } "
      "local e = nacelle{ name='engine', symmetric=true, position={1.8, 2, -0.75}, length=1.2, diameter=0.6, intake='fan', exhaust='jet' } local p = pylon{ w, "
      "e } ";
  EXPECT_EQ(
      run(parts + "local a = aircraft{ b, w, e, p } print(a.is_closed, #a.solids) local c = a.components table.sort(c) print(table.concat(c, ' ')) a:write(" +
          out("a.step") + ") local r = read_cad " + out("a.step") +
          " print(math.abs(r:measures().volume / a:measures().volume - 1) < 1e-6, math.abs(r:measures().area / a:measures().area - 1) < 1e-6)"),
      "true\t1\nbody engine engineLeft pylon pylonLeft wing\ntrue\ttrue\n");
  EXPECT_EQ(run(parts + "local a = aircraft{ b, w, e, p, unite=false } local c = a.patches table.sort(c) print(#a.solids, table.concat(c, ' '))"),
            "6\tbody engine engineLeft fan fanLeft jet jetLeft pylon pylonLeft wing\n");
  EXPECT_THAT(error(parts + "aircraft{ b, w, w }"), HasSubstr("two components are named \"wing\""));
  EXPECT_THAT(error(parts + "aircraft{ b, 3 }"), HasSubstr("entry 2: expected a component (wing{...}, fuselage{...}) or a model, not a number"));
  EXPECT_EQ(run(parts + "local m = aircraft{ b, name='x' } m:write(" + out("b.smx") + ") print(read_smx(" + out("b.smx") + "))").substr(0, 20),
            "Model: 1 component, ");
  EXPECT_THAT(error(parts + "aircraft{ b, unite=false }:move{ 0, 0, 1 }:write(" + out("b.smx") + ")"), HasSubstr("it was changed by move"));
  EXPECT_THAT(error(parts + "b:model():write(" + out("b.stl") + ")"), HasSubstr("models are not written in this format"));
}

TEST_F(GeometryScripts, UnionsOfModelsAndOfSurfaces) {
  EXPECT_NEAR(number("union{ box{ {0,0,0}, {1,1,1} }, box{ {0.5,0.25,0.25}, {2,0.75,0.75}, name='arm' } }:measures().volume"), 1.25, 1e-9);
  std::filesystem::copy(test::corpus() / "scripts" / "box.stl", folder_ / "box.stl");
  EXPECT_THAT(error("union{ box{ {0,0,0}, {1,1,1} }, 'box.stl' }"), HasSubstr("union takes models (exact geometry) or triangulated surfaces, not both"));
  EXPECT_THAT(error("union{ box{ {0,0,0}, {1,1,1} }, strip_width = 4 }"), HasSubstr("unknown key \"strip_width\""));
  // The unit box and a copy moved by half its length: a box of 1.5 x 1 x 1 with the seams of both.
  std::ifstream box(folder_ / "box.stl");
  std::ofstream moved(folder_ / "moved.stl");
  for (std::string line; std::getline(box, line);) {
    double x = 0.0, y = 0.0, z = 0.0;
    if (std::sscanf(line.c_str(), " vertex %lf %lf %lf", &x, &y, &z) == 3)
      moved << "vertex " << x + 0.5 << " " << 0.5 * y + 0.25 << " " << 0.5 * z + 0.25 << "\n";
    else moved << line << "\n";
  }
  moved.close();
  EXPECT_EQ(run("local u = union{ read_surface 'box.stl', 'moved.stl' } print(u.is_closed, u.length)"), "true\t1.5\n");
}

TEST_F(GeometryScripts, ControlSurfacesOfFilesAreDeflected) {
  STERNA_NEEDS_SHARED_DATA();
  const std::filesystem::path bjet = test::shared_data() / "smx/bjet.smx", d150 = test::shared_data() / "cpacs/CPACS_30_D150.xml";
  // The elevator's trailing edge goes down, so the stabilizer reaches lower. The model of the file is unchanged, and a deflection can be reversed.
  EXPECT_EQ(run("local a = read_smx '" + bjet.string() + "' local b = read_smx{ '" + bjet.string() + "', deflections = { Elevator = 20*deg } } " +
                "local function low(m) return m['Stabilizer'].min[3] end local c, d = a:deflect{ Elevator = 20*deg }, b:deflect{ Elevator = 0 } "
                "print(low(b) < low(a) - 0.01, low(c) == low(b), math.abs(low(d) - low(a)) < 1e-3)"),
            "true\ttrue\ttrue\n");
  EXPECT_EQ(
      run("local m = read_cpacs{ '" + d150.string() + "', deflections = { ['*Flap'] = 20*deg, ['*aileron'] = { angle = -5*deg, other_side = 'opposite' } } } " +
          "local n = 0 for _ in pairs(m.patches) do n = n + 1 end print(n > 10)"),
      "true\n");
  EXPECT_THAT(error("read_smx{ '" + bjet.string() + "', deflections = { Elevatr = 5*deg } }"), HasSubstr("did you mean \"Elevator\"?"));
  EXPECT_THAT(error("read_smx{ '" + bjet.string() + "', deflections = { Elevator = 5 } }"), HasSubstr("write degrees as 40*deg"));
  EXPECT_THAT(error("read_smx{ '" + bjet.string() + "', deflections = { Elevator = { angel = 5*deg } } }"), HasSubstr("did you mean \"angle\"?"));
  EXPECT_THAT(error("box{ {0,0,0}, {1,1,1} }:deflect{ Flap = 5*deg }"), HasSubstr("directly after read_smx or read_cpacs"));
}

TEST_F(GeometryScripts, HelpOfEveryVerbNamesItsOptions) {
  const std::string text =
      run("for _, v in ipairs{ fuselage, wing, nacelle, pylon, boom, fairing, body_of_revolution, sting, aircraft, airfoil, surface, test_section, read_cad, "
          "union } do help(v) end help 'deflect' help 'deform' help()");
  for (const char* part : {"sweep_at = 0.25", "highlight_ratio = 0.82", "nose_length = automatic", "cone_start", "periodic_u", "contraction_ratio",
                           "sew_tolerance", "gap = ", "linear_part", "model:rotate", "wing:deflect"})
    EXPECT_THAT(text, HasSubstr(part));
}

TEST_F(GeometryScripts, AllProblemsOfATableAreToldTogether) {
  EXPECT_THAT(error("wing{ name='w', sections={ {y=0, chrod=2}, {y=1, chord=-1, airfoil='naca0012'} }, tip='pointed' }"),
              AllOf(HasSubstr("3 problems in this table"), HasSubstr("tip: \"pointed\""), HasSubstr("section 1: 3 problems"),
                    HasSubstr("unknown key \"chrod\", did you mean \"chord\"?"), HasSubstr("section 2: chord: -1 is not allowed")));
  EXPECT_THAT(error("fuselage{ frames={ {x=0, diameter=1}, {diameter=1} } }"), AllOf(HasSubstr("frame 2: needs x")));
  EXPECT_THAT(error("nacelle{ length=3 }"), HasSubstr("needs diameter"));
  EXPECT_THAT(error("wing{ sections={ {y=0, chord=2, airfoil='naca0012', twist=5}, {y=1} } }"),
              AllOf(HasSubstr("twist: 5 rad (286.479 deg) is not allowed"), HasSubstr("write degrees as 40*deg")));
}

/// Runs before a script: records the components and solids that the script makes, and stops the script when they are united or meshed.
constexpr const char* k_noting = R"(
local made = {}
local function noting(verb) return function(...) local thing = verb(...) made[#made + 1] = thing return thing end end
fuselage, wing, nacelle, pylon, boom, fairing = noting(fuselage), noting(wing), noting(nacelle), noting(pylon), noting(boom), noting(fairing)
body_of_revolution, sting, box, cylinder = noting(body_of_revolution), noting(sting), noting(box), noting(cylinder)
local function stop() error("all components are made", 0) end
local whole = aircraft
aircraft = function(t) return t.unite == false and whole(t) or stop() end
surface_mesh, volume_mesh, series = stop, stop, stop
local ok, problem = pcall(function()
)";
/// Runs after the script: writes each solid, reads it back and measures it.
constexpr const char* k_compare = R"(
end)
if not ok and problem ~= "all components are made" then error(problem, 0) end
for i, thing in ipairs(made) do
  local is_component, model = pcall(function() return thing:model() end)
  if not is_component then model = thing end
  local before = model:measures()
  model:write "component.step"
  local after = read_cad("component.step"):measures()
  if not (math.abs(after.volume - before.volume) <= 1e-6 * before.volume) then
    error(string.format("thing %d: %.9g m3 became %.9g m3", i, before.volume, after.volume), 0)
  end
end
print(#made)
)";

TEST_F(GeometryScripts, StepHoldsTheComponentsOfAllScripts) {
  const std::filesystem::path scripts = test::corpus().parent_path().parent_path() / "scripts";
  std::filesystem::copy(scripts / "data", folder_ / "data", std::filesystem::copy_options::recursive);
  const std::filesystem::path before = std::filesystem::current_path();
  std::filesystem::current_path(folder_);
  int n_components = 0;
  for (const auto& entry : std::filesystem::directory_iterator(scripts)) {
    if (entry.path().extension() != ".lua") continue;
    SCOPED_TRACE(entry.path().filename());
    std::ifstream file(entry.path());
    std::string text{std::istreambuf_iterator<char>(file), {}};
    if (entry.path().filename() == "02_every_option.lua") {  // geometry follows meshes in this script
      const std::size_t from = text.find("local section = airfoil"), to = text.find("local sheet = surface");
      ASSERT_TRUE(from < to && to != std::string::npos);
      text = text.substr(from, to - from);
    }
    std::string printed;
    ASSERT_NO_THROW(printed = run(k_noting + text + k_compare)) << error(k_noting + text + k_compare);
    const std::size_t last = printed.find_last_of('\n', printed.size() - 2);
    n_components += std::stoi(printed.substr(last == std::string::npos ? 0 : last + 1));
  }
  std::filesystem::current_path(before);
  EXPECT_GE(n_components, 40);
}

/// The parameter around a pole is arbitrary at the pole: halves of a bulge lost their outer border depending on their position.
TEST_F(GeometryScripts, StepHoldsBulgesAnywhere) {
  for (const char* const location : {"0, 0, 0", "2.6, 0, 0.45", "-3, 0.2, 1"})
    for (const char* const exponent : {"2", "2.5", "4"}) {
      const std::string bulge = std::string("fairing{ name = 'canopy', position = { ") + location +
                                " }, length = 3.6, width = 0.85, height = 1.05, exponent = " + exponent + " }:model()";
      EXPECT_EQ(run("local m = " + bulge + " m:write " + out("c.step") + " print(math.abs(read_cad(" + out("c.step") +
                    "):measures().volume / m:measures().volume - 1) < 1e-6)"),
                "true\n")
          << location << ", exponent " << exponent;
    }
}

/// The STEP file of a body of revolution with a wing through it and a strut on it (step_centre_body of the trial) lost the body.
TEST_F(GeometryScripts, StepHoldsACentreBodyWithStruts) {
  EXPECT_EQ(run("local body = body_of_revolution{ name = 'bor', profile = { {0,0}, {0.3,0.25}, {0.9,0.33}, {1.8,0.33}, {2.6,0.22}, {3.3,0} } } "
                "local strut = wing{ name = 'strut', position = {1,0,0.2}, sections = { {chord=0.5, airfoil='naca0015'}, {z=0.7} } } "
                "local pair = wing{ name = 'w', symmetric = true, position = {1,0,0}, sections = { {y=0, chord=0.5, airfoil='naca0015'}, {y=0.9} } } "
                "local m = aircraft{ body, pair, strut } m:write " +
                out("b.step") + " local r = read_cad " + out("b.step") + " print(#r.solids, math.abs(r:measures().volume / m:measures().volume - 1) < 1e-6)"),
            "1\ttrue\n");
}

TEST_F(GeometryScripts, StepOfTunnelIsWrittenWithWarning) {
  run("test_section{ length = 6, width = 2, height = 1.5 }:write(" + out("t.step") + ")");
  EXPECT_THAT(log_, HasSubstr("encloses the fluid, but STEP and IGES store every solid as a body; read the file with fluid = \"inside\""));
  EXPECT_NEAR(number("-read_cad{ " + out("t.step") + ", fluid = 'inside' }:measures().volume"), 18.0, 18.0 * k_exact);
}

}  // namespace
}  // namespace sterna::scripting
