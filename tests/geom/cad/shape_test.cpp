#include "geom/cad/shape.h"

#include <numbers>

#include "cylinder.h"
#include "geom/cad/read_cad.h"
#include "geom/cad/write_cad.h"
#include "geom/model/model_measures.h"

namespace sterna {
namespace {

constexpr double k_radius = 0.3, k_height = 2.0;

/// Tolerance of measures, which are integrated to 1e-8.
constexpr double k_measured = 1e-7;

TEST(CadShape, CylinderOfOwnSurfacesIsValidSolid) {
  const Model model = test::cylinder(k_radius, k_height);
  const auto shape = cad::shape_of(model, RunContext());
  const std::vector<ErrorLocation> faults = cad::faults_of(*shape);
  EXPECT_TRUE(faults.empty()) << faults.front().what;
  const ModelMeasures data = model_measures(model, RunContext());
  constexpr double pi = std::numbers::pi;
  EXPECT_NEAR(data.total.volume, pi * k_radius * k_radius * k_height, k_measured * data.total.volume);
  EXPECT_NEAR(data.total.area, 2.0 * pi * k_radius * (k_height + k_radius), k_measured * data.total.area);
  EXPECT_NEAR(data.faces[FaceId(1)].area, pi * k_radius * k_radius, k_measured);
  EXPECT_NEAR(distance(data.total.centre, {0, 0, 0.5 * k_height}), 0.0, k_measured);
  ASSERT_EQ(data.components.size(), 1u);
  EXPECT_TRUE(data.components.front().has_volume);
}

TEST(CadShape, EveryFormatKeepsTheSolidAndItsMeasures) {
  const Model model = test::cylinder(k_radius, k_height);
  const ModelMeasures before = model_measures(model, RunContext());
  for (const cad::CadFormat format : {cad::CadFormat::step, cad::CadFormat::iges, cad::CadFormat::brep}) {
    SCOPED_TRACE(std::string(to_string(format)));
    const std::string bytes = cad::cad_bytes(model, format, "can", {}, RunContext());
    EXPECT_EQ(cad::format_of_bytes(bytes), format);
    const CadFile file = cad::read_cad_bytes(bytes, format, "can.x", {}, RunContext());
    EXPECT_TRUE(file.report.is_closed()) << to_text(file.report);
    EXPECT_TRUE(file.report.faults.empty());
    const ModelMeasures after = model_measures(file.model, RunContext());
    EXPECT_NEAR(after.total.area, before.total.area, 1e-6 * before.total.area);
    EXPECT_NEAR(after.total.volume, before.total.volume, 1e-6 * before.total.volume);
  }
}

TEST(CadShape, StepKeepsNamesColoursAndLayers) {
  for (const char* schema : {"ap203", "ap214", "ap242"}) {
    SCOPED_TRACE(schema);
    const std::string bytes = cad::cad_bytes(test::cylinder(k_radius, k_height), cad::CadFormat::step, "can", {.step_schema = schema}, RunContext());
    const CadFile file = cad::read_cad_bytes(bytes, cad::CadFormat::step, "file.step", {}, RunContext());
    ASSERT_EQ(file.model.faces.size(), 3u);
    EXPECT_EQ(file.model.components[ComponentId(0)].name, "can");
    std::vector<std::string> names;
    for (const ModelFace& face : file.model.faces) names.push_back(face.name);
    EXPECT_EQ(names, (std::vector<std::string>{"can side", "can top", "can bottom"}));
    EXPECT_EQ(file.model.faces[FaceId(0)].layer, "skin");
    ASSERT_TRUE(file.model.faces[FaceId(0)].colour);
    EXPECT_NEAR((*file.model.faces[FaceId(0)].colour)[1], 0.5f, 1e-3f);  // colours are written with few digits
    EXPECT_EQ(file.report.unit, 1.0);
  }
}

TEST(CadShape, TheSameModelGivesTheSameBytes) {
  for (const cad::CadFormat format : {cad::CadFormat::step, cad::CadFormat::iges, cad::CadFormat::brep})
    EXPECT_EQ(cad::cad_bytes(test::cylinder(1, 2), format, "can", {}, RunContext()), cad::cad_bytes(test::cylinder(1, 2), format, "can", {}, RunContext()))
        << to_string(format);
}

TEST(CadShape, SurfaceWithoutExactFormIsNamedWithLocation) {
  class Bump final : public Surface {
    ParameterBox domain() const override { return {{0, 1}, {0, 1}}; }
    Point point(Uv at) const override { return {at.u, at.v, std::sin(at.u)}; }
    SurfaceDerivatives derivatives(Uv at) const override { return {point(at), {1, 0, std::cos(at.u)}, {0, 1, 0}, {0, 0, -std::sin(at.u)}, {}, {}}; }
    std::string kind() const override { return "bump"; }
  };
  Model model = test::cylinder(1, 2);
  model.faces[FaceId(1)].surface = std::make_shared<Bump>();
  try {
    cad::shape_of(model, RunContext());
    FAIL();
  } catch (const Error& error) {
    EXPECT_EQ(error.code(), ErrorCode::geometry_failed);
    EXPECT_NE(std::string(error.what()).find("\"can top\", bump"), std::string::npos) << error.what();
    EXPECT_EQ(error.info().locations.size(), 1u);
  }
}

}  // namespace
}  // namespace sterna
