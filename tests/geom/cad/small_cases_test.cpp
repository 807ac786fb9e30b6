// Small CAD files of tests/data/cad, each with one fault or feature (its README says which), and what becomes of them.
#include <gmock/gmock.h>

#include <algorithm>

#include "geom/cad/read_cad.h"
#include "geom/cad/shape.h"
#include "geom/model/model_measures.h"
#include "io/cad_file.h"
#include "tests/support/data.h"

namespace sterna {
namespace {

CadFile read(const std::string& name, const ReadCadOptions& options = {}) { return io::read_cad(test::corpus() / "cad" / name, options, RunContext()); }

std::size_t count(const CadReport& report, const std::string& what) {
  return static_cast<std::size_t>(std::count_if(report.mended.begin(), report.mended.end(), [&](const CadMend& mend) { return mend.what == what; }));
}

double volume(const CadFile& file) { return model_measures(file.model, RunContext()).total.volume; }

TEST(SmallCadCases, AGapIsSewn) {
  const CadFile file = read("box_gap.brep");
  EXPECT_TRUE(file.report.is_closed()) << to_text(file.report);
  EXPECT_TRUE(file.report.faults.empty());
  EXPECT_EQ(count(file.report, "edges of two faces joined"), 12u);
  EXPECT_NEAR(volume(file), 1.0, 4e-6);
  // A tolerance below the gap leaves it, in the open and with its place.
  ReadCadOptions options;
  options.sew_tolerance = 1e-6;
  const CadFile open = read("box_gap.brep", options);
  EXPECT_FALSE(open.report.is_closed());
  ASSERT_EQ(open.report.free_edges.size(), 8u);
  for (const CadFreeEdge& edge : open.report.free_edges) EXPECT_NEAR(edge.place.x, 0.0, 5e-6);
}

TEST(SmallCadCases, ADoubledFaceGoes) {
  const CadFile file = read("box_doubled_face.brep");
  EXPECT_TRUE(file.report.is_closed());
  EXPECT_EQ(file.report.n_faces, 6u);
  EXPECT_EQ(count(file.report, "doubled face removed"), 1u);
  EXPECT_NEAR(volume(file), 1.0, 1e-12);
}

TEST(SmallCadCases, InsideOutIsTurned) {
  const CadFile file = read("box_inside_out.brep");
  EXPECT_EQ(count(file.report, "solid turned right side out"), 1u);
  EXPECT_NEAR(volume(file), 1.0, 1e-12);
}

TEST(SmallCadCases, AnOpeningIsToldAndCapped) {
  const CadFile open = read("box_open.iges");
  EXPECT_NEAR(open.report.unit, 0.0254, 1e-12);
  EXPECT_FALSE(open.report.is_closed());
  ASSERT_EQ(open.report.openings.size(), 1u);
  const CadOpening& opening = open.report.openings.front();
  EXPECT_TRUE(opening.is_loop && opening.is_flat);
  EXPECT_EQ(opening.edges.size(), 4u);
  EXPECT_NEAR(opening.length, 6.0, 1e-9);
  EXPECT_NEAR(distance(opening.place, {1.0, 0.5, 0.5}), 0.0, 1e-9);
  EXPECT_NEAR(std::abs(opening.normal.z), 1.0, 1e-9);
  EXPECT_THAT(to_text(open.report), testing::HasSubstr("`cap = true` closes it"));

  ReadCadOptions options;
  options.cap = true;
  const CadFile capped = read("box_open.iges", options);
  EXPECT_TRUE(capped.report.is_closed()) << to_text(capped.report);
  EXPECT_TRUE(capped.report.faults.empty());
  EXPECT_EQ(capped.report.n_faces, 6u);
  EXPECT_NEAR(volume(capped), 1.0, 1e-9);
  EXPECT_EQ(std::count_if(capped.model.faces.begin(), capped.model.faces.end(), [](const ModelFace& face) { return face.name == "box_open cap"; }), 1);
}

TEST(SmallCadCases, EdgesThatShareTheirEndsAreOne) {
  const CadFile file = read("edges_apart.brep");
  EXPECT_EQ(count(file.report, "edges of two faces joined"), 1u);
  EXPECT_EQ(file.report.free_edges.size(), 6u);
  ASSERT_EQ(file.report.openings.size(), 1u);
  EXPECT_TRUE(file.report.openings.front().is_loop);
  EXPECT_FALSE(file.report.openings.front().is_flat);
  EXPECT_GT(file.report.mended.front().value, 0.003);  // the gap is told
}

TEST(SmallCadCases, MillimetresBecomeMetres) {
  const CadFile file = read("box_mm.step");
  EXPECT_EQ(file.report.file_unit, "millimetre");
  EXPECT_NEAR(volume(file), 0.4 * 0.2 * 0.1, 1e-12);
  EXPECT_EQ(file.model.components[ComponentId(0)].name, "block 1");  // OpenCASCADE numbers the products that it writes
}

TEST(SmallCadCases, AnAssemblyKeepsInstancesNamesAndColours) {
  const CadFile file = read("tail_assembly.step");
  EXPECT_TRUE(file.report.is_closed());
  std::vector<std::string> components;
  for (const Component& component : file.model.components) components.push_back(component.name);
  EXPECT_THAT(components, testing::UnorderedElementsAre("fin left", "fin right"));
  std::size_t n_red = 0;
  for (const ModelFace& face : file.model.faces) {
    EXPECT_EQ(face.name == "fin top", face.colour.has_value());
    n_red += face.colour && (*face.colour)[0] > 0.99f && (*face.colour)[1] < 0.01f;
  }
  EXPECT_EQ(n_red, 2u);
  const ModelMeasures m = model_measures(file.model, RunContext());
  EXPECT_NEAR(distance(m.components[0].centre, m.components[1].centre), 1.0, 1e-12);
}

TEST(SmallCadCases, TheTimeLimitIsHonoured) {
  ReadCadOptions options;
  options.time_limit = 1e-9;
  try {
    read("tail_assembly.step", options);
    FAIL();
  } catch (const Error& error) {
    EXPECT_EQ(error.code(), ErrorCode::geometry_failed);
    EXPECT_THAT(error.what(), testing::HasSubstr("longer than the limit"));
  }
}

}  // namespace
}  // namespace sterna
