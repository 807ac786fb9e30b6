#include "geom/cad/fluid.h"

#include <cmath>
#include <map>
#include <numbers>
#include <set>

#include <gtest/gtest.h>

#include "cylinder.h"
#include "face_names.h"
#include "geom/model/components.h"
#include "geom/model/deform.h"
#include "geom/model/model_builder.h"
#include "geom/model/model_measures.h"
#include "geom/model/shapes.h"
#include "tests/support/error_of.h"

namespace sterna {
namespace {

using std::numbers::pi;
using test::face_names;

Model tunnel(double length = 4.0, double width = 2.0, double height = 2.0) { return make_test_section({.length = length, .width = width, .height = height}); }

double volume_of(const Model& model) {
  double volume = 0.0;
  for (const SolidId s : model.solids.ids()) volume += solid_measures(model, s).volume;
  return volume;
}

/// Checks that the model is closed and consistently oriented: every edge is used twice, once in each direction.
void expect_closed(const Model& model) {
  EXPECT_TRUE(free_edges(model).empty());
  std::map<EdgeId, int> sense;
  for (const ModelFace& face : model.faces)
    for (const Border& border : face.borders)
      for (const EdgeUse& use : border)
        if (!model.edges[use.edge].is_degenerate()) sense[use.edge] += use.is_reversed != face.is_reversed ? 1 : -1;
  for (const auto& [edge, sum] : sense) EXPECT_EQ(sum, 0) << "edge " << edge.value();
}

TEST(FluidDomain, ABodyInsideIsLeftAsItIs) {
  const std::vector<Model> bodies = {test::cylinder(0.2, 1.0, {0, 0, -0.5}, "pod")};
  const FluidDomain fluid = cad::fluid_domain(tunnel(), bodies, {}, RunContext());
  expect_closed(fluid.model);
  EXPECT_NEAR(fluid.report.volume, 16.0 - 0.04 * pi, 1e-5);
  EXPECT_NEAR(volume_of(fluid.model), -fluid.report.volume, 1e-9);
  EXPECT_EQ(fluid.report.inside, std::vector<std::string>{"pod"});
  EXPECT_TRUE(fluid.report.tries.empty());
  EXPECT_EQ(fluid.model.faces[FaceId(6)].surface, bodies[0].faces[FaceId(0)].surface);
}

TEST(FluidDomain, StingIsCutAtTheOutflowWall) {
  for (const double pitch : {0.0, 0.2}) {
    const Model sting = transformed(make_cylinder("sting", {0, 0, 0}, {4, 0, 0}, 0.1), rotation({}, {0, 1, 0}, pitch));
    const std::vector<Model> bodies = {sting};
    const FluidDomain fluid = cad::fluid_domain(tunnel(), bodies, {}, RunContext());
    expect_closed(fluid.model);
    // A cylinder cut at a slant has the volume of a straight cylinder of its axis length.
    EXPECT_NEAR(fluid.report.volume, 16.0 - 0.01 * pi * 2.0 / std::cos(pitch), 1e-4) << pitch;
    EXPECT_NEAR(volume_of(fluid.model), -fluid.report.volume, 1e-9);
    EXPECT_EQ(fluid.report.cut, std::vector<std::string>{"sting"});
    EXPECT_EQ(fluid.model.solids.size(), 1u);
    for (const ModelFace& face : fluid.model.faces) {
      if (face.role == FaceRole::outflow) {
        EXPECT_EQ(face.borders.size(), 2u);
      }
      if (face.role == FaceRole::inflow) {
        EXPECT_EQ(face.borders.size(), 1u);
      }
      const bool is_sting = fluid.model.components[face.component].name == "sting";
      EXPECT_EQ(patch_kind(face), face.role == FaceRole::inflow ? PatchKind::inflow : face.role == FaceRole::outflow ? PatchKind::outflow : PatchKind::wall);
      if (is_sting) {
        EXPECT_EQ(face.name, "sting");
      }
    }
  }
}

TEST(FluidDomain, ModelAndStingThatTouchAreUnitedFirst) {
  const std::vector<Model> bodies = {make_cylinder("model", {-1, 0, 0}, {0.5, 0, 0}, 0.3), make_cylinder("sting", {0.3, 0, 0}, {4, 0, 0}, 0.1)};
  const FluidDomain fluid = cad::fluid_domain(tunnel(), bodies, {}, RunContext());
  expect_closed(fluid.model);
  EXPECT_NEAR(fluid.report.volume, 16.0 - 0.09 * pi * 1.5 - 0.01 * pi * 1.5, 1e-4);
  const std::set<std::string> names = face_names(fluid.model);
  for (const char* name : {"model", "sting", "inflow", "outflow"}) EXPECT_TRUE(names.contains(name)) << name;
}

TEST(FluidDomain, StrutStandsOnFloorOrPassesThroughIt) {
  for (const double base : {-1.0, -1.5}) {
    const std::vector<Model> bodies = {make_cylinder("strut", {0, 0, base}, {0, 0, 0}, 0.1)};
    const FluidDomain fluid = cad::fluid_domain(tunnel(), bodies, {}, RunContext());
    expect_closed(fluid.model);
    EXPECT_NEAR(fluid.report.volume, 16.0 - 0.01 * pi, 1e-4) << base;
    std::size_t n_holes = 0;
    for (const ModelFace& face : fluid.model.faces) n_holes += face.borders.size() - 1;
    EXPECT_EQ(n_holes, 1u);  // the base of the body is no face of the fluid; the floor has a hole
  }
}

TEST(FluidDomain, WingOnSideWallLosesOtherHalf) {
  Wing wing{.name = "wing", .is_symmetric = true, .trailing_edge = 0.005};
  const auto section = [](double y, double chord) {
    WingSection s{.name = "s", .leading_edge = {-0.5 * chord, y, 0.0}, .chord = chord};
    for (int i = 0; i <= 60; ++i) {
      const double a = 2.0 * pi * i / 60.0, x = 0.5 * (1.0 + std::cos(a));
      s.points.push_back(
          {x, (i <= 30 ? 1.0 : -1.0) * 0.6 * (0.2969 * std::sqrt(x) - 0.126 * x - 0.3516 * x * x + 0.2843 * x * x * x - 0.1036 * x * x * x * x)});
    }
    return s;
  };
  wing.sections = {section(0.9, 0.4), section(0.0, 0.6)};
  const Model span = make_wing(wing);
  const double whole = volume_of(span);
  // The wall is the body's plane of symmetry.
  const std::vector<Model> bodies = {transformed(span, translation({0, -1, 0}))};
  const FluidDomain fluid = cad::fluid_domain(tunnel(), bodies, {}, RunContext());
  expect_closed(fluid.model);
  EXPECT_NEAR(fluid.report.volume, 16.0 - 0.5 * whole, 1e-4);
  for (const ModelCorner& corner : fluid.model.corners) EXPECT_GT(corner.point.y, -1.0 - 1e-6);
}

TEST(FluidDomain, CustomContainerMayHaveNormalsEitherWay) {
  const std::vector<Model> bodies = {make_cylinder("sting", {0, 0, 0}, {4, 0, 0}, 0.1)};
  const Model tube = test::cylinder(1.0, 4.0, {0, 0, -2}, "tube");
  const std::vector<Model> across = {make_cylinder("sting", {0, 0, 0}, {0, 0, 4}, 0.1)};
  Model inward = tube;
  turn_inside_out(inward);
  for (const Model& container : {tube, inward}) {
    const FluidDomain fluid = cad::fluid_domain(container, across, {}, RunContext());
    expect_closed(fluid.model);
    EXPECT_NEAR(volume_of(fluid.model), -(4.0 * pi - 0.02 * pi), 1e-4);
    EXPECT_TRUE(face_names(fluid.model).contains("tube top"));
  }
}

TEST(FluidDomain, BodiesThatDoNotBelongThereAreNamed) {
  const auto run = [](const Model& body) {
    return [body] {
      const std::vector<Model> bodies = {body};
      cad::fluid_domain(tunnel(), bodies, {}, RunContext());
    };
  };
  const Error outside = test::error_of(run(test::cylinder(0.2, 1.0, {0, 5, 0}, "lost")));
  EXPECT_EQ(outside.code(), ErrorCode::bad_argument);
  EXPECT_NE(std::string(outside.what()).find("\"lost\" lies outside"), std::string::npos) << outside.what();
  const Error across = test::error_of(run(make_box("slab", {-0.1, -3, -3}, {0.1, 3, 3})));
  EXPECT_EQ(across.code(), ErrorCode::bad_argument);
  EXPECT_NE(std::string(across.what()).find("\"slab\" cuts the fluid in \"tunnel\" into 2 parts"), std::string::npos) << across.what();
  EXPECT_EQ(across.n_locations(), 2);
  const Error filled = test::error_of(run(make_box("rock", {-5, -5, -5}, {5, 5, 5})));
  EXPECT_EQ(filled.code(), ErrorCode::bad_argument);
  EXPECT_NE(std::string(filled.what()).find("\"rock\" fills the container"), std::string::npos) << filled.what();
  const Error plug = test::error_of(run(make_box("plug", {-3, -1, -1}, {3, 1, 1})));
  EXPECT_NE(std::string(plug.what()).find("fills the container"), std::string::npos) << plug.what();
}

TEST(FluidDomain, TheSamePartsGiveTheSameModel) {
  const auto run = [] {
    const std::vector<Model> bodies = {make_cylinder("sting", {0, 0.1, 0}, {4, 0.3, 0.2}, 0.1), test::cylinder(0.2, 1.0, {-1, 0, 0}, "pod")};
    const FluidDomain fluid = cad::fluid_domain(tunnel(), bodies, {}, RunContext());
    std::vector<std::string> names;
    for (const ModelFace& face : fluid.model.faces) names.push_back(face.name + std::to_string(face.borders.size()));
    for (const ModelCorner& corner : fluid.model.corners) names.push_back(format_point(corner.point));
    return names;
  };
  EXPECT_EQ(run(), run());
}

}  // namespace
}  // namespace sterna
