// Models without exact form, mainly deformed models: exported as splines to a reported tolerance, closed and with their names.
#include <gmock/gmock.h>

#include <cmath>

#include "geom/cad/read_cad.h"
#include "geom/cad/shape.h"
#include "geom/cad/write_cad.h"
#include "geom/model/components.h"
#include "geom/model/deform.h"
#include "geom/model/model_measures.h"
#include "io/file/cad_file.h"
#include "tests/geom/cad/cylinder.h"
#include "tests/support/data.h"

namespace sterna {
namespace {

/// A map that bends the tip of a 5 m wing box up by 0.4 m and twists the box.
SpaceMapPtr bending() {
  return std::make_shared<FunctionMap>(
      [](const Point& p) {
        const double s = p.y / 5.0, twist = 0.05 * s * s;
        return Point{p.x + twist * p.z, p.y - 0.03 * s * s * s, p.z + 0.4 * s * s - twist * p.x};
      },
      1e-3);
}

WingSection section(Point leading, double chord) {
  WingSection s{.name = "s", .leading_edge = leading, .chord = chord};
  for (int i = 0; i <= 24; ++i) {
    const double a = 2.0 * M_PI * i / 24.0, x = 0.5 * (1.0 + std::cos(a)),
                 t = 0.06 * (1.4845 * std::sqrt(x) - 0.63 * x - 1.758 * x * x + 1.4215 * x * x * x - 0.518 * x * x * x * x);
    s.points.push_back({x, i <= 12 ? t : -t});
  }
  s.points.front().v = s.points.back().v = 0.0;
  return s;
}

std::vector<std::string> names_of(const Model& model) {
  std::vector<std::string> names;
  for (const ModelFace& face : model.faces) names.push_back(face.name);
  return names;
}

struct Export {
  CadFile again;
  std::string log;
};
Export exported(const Model& model, cad::CadFormat format, const WriteCadOptions& options = {}) {
  Export result;
  const RunContext context({.log = [&](LogLevel, std::string_view text) { result.log += std::string(text) + "\n"; }});
  const std::string bytes = cad::cad_bytes(model, format, "bent", options, context);
  result.again = cad::read_cad_bytes(bytes, format, "bent", {}, RunContext());
  return result;
}

void expect_same_body(const Model& model, const Export& file, double tolerance) {
  EXPECT_TRUE(file.again.report.is_closed()) << to_text(file.again.report);
  EXPECT_TRUE(file.again.report.faults.empty()) << to_text(file.again.report);
  EXPECT_EQ(file.again.report.n_closed, model.solids.size());
  const BodyMeasures before = model_measures(model, RunContext()).total, after = model_measures(file.again.model, RunContext()).total;
  EXPECT_NEAR(after.volume, before.volume, tolerance * before.area);
  // Borders may move by the tolerances of surface and curve along their whole length, which is about ten times the root of the area.
  EXPECT_NEAR(after.area, before.area, 2.0 * tolerance * 10.0 * std::sqrt(before.area));
}

TEST(Refit, BentWingIsExportedClosedWithNames) {
  Aircraft aircraft;
  aircraft.wings.push_back({.name = "Wing", .sections = {section({1.0, 5.0, 0.2}, 1.0), section({0, 0, 0}, 2.0)}});
  const Model wing = make_components(aircraft, RunContext());
  ASSERT_TRUE(free_edges(wing).empty());
  const Model bent = deformed(wing, bending(), RunContext());
  for (const double tolerance : {1e-4, 1e-5}) {
    SCOPED_TRACE(tolerance);
    WriteCadOptions options;
    options.tolerance = tolerance;
    const Export file = exported(bent, cad::CadFormat::step, options);
    EXPECT_THAT(file.log, testing::HasSubstr("have no exact form; they were replaced by splines within"));
    EXPECT_EQ(names_of(file.again.model), names_of(bent));
    EXPECT_EQ(file.again.model.edges.size(), bent.edges.size());  // shared edges stay shared
    expect_same_body(bent, file, tolerance);
  }
}

TEST(Refit, BentCylinderWithSeamInEveryFormat) {
  const Model can = test::cylinder(0.3, 2.0, {0.5, 1.0, 0.0});
  const Model bent = deformed(can, bending(), RunContext());
  for (const cad::CadFormat format : {cad::CadFormat::step, cad::CadFormat::iges, cad::CadFormat::brep}) {
    SCOPED_TRACE(std::string(to_string(format)));
    expect_same_body(bent, exported(bent, format), 2e-6);  // 1e-6 of the height
  }
}

TEST(Refit, ExactModelsAreLeftAlone) {
  const Export file = exported(test::cylinder(0.3, 2.0), cad::CadFormat::step);
  EXPECT_THAT(file.log, testing::Not(testing::HasSubstr("exact form")));
}

TEST(Refit, ADeformedCadFileIsExportedAgain) {
  STERNA_NEEDS_SHARED_DATA();
  const CadFile file = io::read_cad(test::shared_data() / "cad" / "tigl_simplewing_simplewing.brep", {}, RunContext());
  const Model bent = deformed(file.model, bending(), RunContext());
  expect_same_body(bent, exported(bent, cad::CadFormat::step), 1e-5);
}

}  // namespace
}  // namespace sterna
