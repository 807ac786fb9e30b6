// Faces on closed surfaces with holes: read from STEP files of other programs, written and read again, halved along their seams. The files are those of
// tests/data/cad, made with gmsh. Expected values are measures of the BREP files that gmsh wrote of the same shapes: there OpenCASCADE has no borders to guess.
#include <gmock/gmock.h>

#include <cmath>
#include <numbers>

#include "geom/cad/half_model.h"
#include "geom/cad/read_cad.h"
#include "geom/cad/write_cad.h"
#include "geom/model/model_measures.h"
#include "io/file/cad_file.h"
#include "tests/support/data.h"

namespace sterna {
namespace {

using testing::Contains;
using testing::HasSubstr;
using testing::IsEmpty;

CadFile read_closed(const std::string& name, const ReadCadOptions& options = {}) { return io::read_cad(test::corpus() / "cad" / name, options, RunContext()); }
BodyMeasures total_of(const Model& model) { return model_measures(model, RunContext()).total; }

struct ClosedFace {
  const char* name;
  double volume, area;
  std::size_t n_faces;
};
class ClosedFaces : public testing::TestWithParam<ClosedFace> {};

TEST_P(ClosedFaces, KeepTheirBody) {
  const ClosedFace& expected = GetParam();
  const CadFile file = read_closed(expected.name);
  EXPECT_TRUE(file.report.is_closed()) << to_text(file.report);
  EXPECT_EQ(file.report.n_closed, 1u);
  EXPECT_EQ(file.report.n_faces, expected.n_faces);
  EXPECT_THAT(file.report.faults, IsEmpty());
  const BodyMeasures total = total_of(file.model);
  EXPECT_NEAR(total.volume, expected.volume, 1e-6 * expected.volume);
  EXPECT_NEAR(total.area, expected.area, 1e-6 * expected.area);
}

TEST_P(ClosedFaces, AreWrittenAsTheyAre) {
  const CadFile file = read_closed(GetParam().name);
  const BodyMeasures before = total_of(file.model);
  for (const char* extension : {"step", "iges", "brep"}) {
    SCOPED_TRACE(extension);
    const auto path = test::scratch() / (std::string("closed.") + extension);
    io::write_cad(file.model, path, {}, RunContext());
    const CadFile again = io::read_cad(path, {}, RunContext());
    EXPECT_TRUE(again.report.is_closed()) << to_text(again.report);
    EXPECT_EQ(again.model.solids.size(), file.model.solids.size());
    const BodyMeasures after = total_of(again.model);
    EXPECT_NEAR(after.volume, before.volume, 1e-6 * before.volume);
    EXPECT_NEAR(after.area, before.area, 1e-6 * before.area);
  }
}

INSTANTIATE_TEST_SUITE_P(all, ClosedFaces,
                         testing::Values(ClosedFace{"revolution_vertex_loop.step.gz", 0.73450226, 5.8115757, 6},
                                         ClosedFace{"revolution_crossed.step.gz", 0.7697795, 7.108233, 16},
                                         ClosedFace{"spline_crossed.step.gz", 4.708693, 20.202534, 16},
                                         ClosedFace{"revolution_plate.brep.gz", 0.8404827, 7.2272906, 11}),
                         [](const auto& info) { return std::string(info.param.name).substr(0, std::string(info.param.name).find('.')); });

TEST(HalfModelAtASeam, ABodyOfRevolutionIsCutThere) {
  const CadFile file = read_closed("seam_in_plane.brep.gz");
  const HalfModel half = cad::half_model(file.model, {}, RunContext());
  EXPECT_NEAR(total_of(half.model).area, 0.5 * total_of(file.model).area, 1e-6);
}

TEST(HalfModelAtASeam, NacelleWithStrutAcrossSeamsIsCut) {
  const CadFile file = read_closed("nacelle_seam.brep.gz");
  const HalfModel half = cad::half_model(file.model, {}, RunContext());
  EXPECT_NEAR(total_of(half.model).area, 0.5 * total_of(file.model).area, 1e-4);
}

TEST(Sheets, SketchesBesideSolidAreOmittedAndNamed) {
  const CadFile file = read_closed("nacelle_sketches.brep.gz");
  EXPECT_TRUE(file.report.is_closed()) << to_text(file.report);
  EXPECT_EQ(file.report.n_faces, 16u);
  EXPECT_THAT(file.report.warnings, Contains(testing::AllOf(HasSubstr("is left out"), HasSubstr("m^2 near"))).Times(2));
  ReadCadOptions keep;
  keep.sheets = "keep";
  EXPECT_EQ(read_closed("nacelle_sketches.brep.gz", keep).report.n_faces, 18u);
  ReadCadOptions named;
  named.sheets = "other*, nacelle*";
  EXPECT_EQ(read_closed("nacelle_sketches.brep.gz", named).report.n_faces, 16u);
}

// The solid of the box is the fluid: the box's normals point into the fluid, and the sphere's normals away from the sphere's centre.
TEST(FluidInside, TurnsTheBoundaryOfTheSolid) {
  const double volume = 3.0 - 4.0 / 3.0 * std::numbers::pi * std::pow(0.2, 3);
  ReadCadOptions inside;
  inside.fluid = "inside";
  EXPECT_NEAR(total_of(read_closed("duct_with_sphere.brep.gz").model).volume, volume, 1e-6);
  EXPECT_NEAR(total_of(read_closed("duct_with_sphere.brep.gz", inside).model).volume, -volume, 1e-6);
}

}  // namespace
}  // namespace sterna
