// Small CAD files of tests/data/cad, each with one fault or feature (see the README there), and the result of reading each.
#include <gmock/gmock.h>

#include <algorithm>

#include "geom/cad/read_cad.h"
#include "geom/cad/shape.h"
#include "geom/cad/write_cad.h"
#include "geom/model/model_builder.h"
#include "geom/model/model_measures.h"
#include "io/file/cad_file.h"
#include "tests/support/data.h"

namespace sterna {
namespace {

CadFile read_small(const std::string& name, const ReadCadOptions& options = {}) { return io::read_cad(test::corpus() / "cad" / name, options, RunContext()); }

std::size_t count(const CadReport& report, const std::string& what) {
  return static_cast<std::size_t>(std::count_if(report.repaired.begin(), report.repaired.end(), [&](const CadRepair& repair) { return repair.what == what; }));
}

double volume(const CadFile& file) { return model_measures(file.model, RunContext()).total.volume; }

TEST(SmallCadCases, AGapIsSewn) {
  const CadFile file = read_small("box_gap.brep");
  EXPECT_TRUE(file.report.is_closed()) << to_text(file.report);
  EXPECT_TRUE(file.report.faults.empty());
  EXPECT_EQ(count(file.report, "edges of two faces joined"), 12u);
  EXPECT_NEAR(volume(file), 1.0, 4e-6);
  // A tolerance below the gap leaves the gap open and reports its location.
  ReadCadOptions options;
  options.sew_tolerance = 1e-6;
  const CadFile open = read_small("box_gap.brep", options);
  EXPECT_FALSE(open.report.is_closed());
  ASSERT_EQ(open.report.free_edges.size(), 8u);
  for (const CadFreeEdge& edge : open.report.free_edges) EXPECT_NEAR(edge.location.x, 0.0, 5e-6);
}

TEST(SmallCadCases, ADoubledFaceGoes) {
  const CadFile file = read_small("box_doubled_face.brep");
  EXPECT_TRUE(file.report.is_closed());
  EXPECT_EQ(file.report.n_faces, 6u);
  EXPECT_EQ(count(file.report, "duplicate face removed"), 1u);
  EXPECT_NEAR(volume(file), 1.0, 1e-12);
}

TEST(SmallCadCases, InsideOutIsTurned) {
  const CadFile file = read_small("box_inside_out.brep");
  EXPECT_EQ(count(file.report, "orientation of an inside-out solid reversed"), 1u);
  EXPECT_NEAR(volume(file), 1.0, 1e-12);
}

TEST(SmallCadCases, AnOpeningIsToldAndCapped) {
  const CadFile open = read_small("box_open.iges");
  EXPECT_NEAR(open.report.unit, 0.0254, 1e-12);
  EXPECT_FALSE(open.report.is_closed());
  ASSERT_EQ(open.report.openings.size(), 1u);
  const CadOpening& opening = open.report.openings.front();
  EXPECT_TRUE(opening.is_loop && opening.is_flat);
  EXPECT_EQ(opening.edges.size(), 4u);
  EXPECT_NEAR(opening.length, 6.0, 1e-9);
  EXPECT_NEAR(distance(opening.location, {1.0, 0.5, 0.5}), 0.0, 1e-9);
  EXPECT_NEAR(std::abs(opening.normal.z), 1.0, 1e-9);
  EXPECT_THAT(to_text(open.report), testing::HasSubstr("`cap = true` closes it"));

  ReadCadOptions options;
  options.cap = true;
  const CadFile capped = read_small("box_open.iges", options);
  EXPECT_TRUE(capped.report.is_closed()) << to_text(capped.report);
  EXPECT_TRUE(capped.report.faults.empty());
  EXPECT_EQ(capped.report.n_faces, 6u);
  EXPECT_NEAR(volume(capped), 1.0, 1e-9);
  EXPECT_EQ(std::count_if(capped.model.faces.begin(), capped.model.faces.end(), [](const ModelFace& face) { return face.name == "box_open cap"; }), 1);
}

TEST(SmallCadCases, EdgesThatShareTheirEndsAreOne) {
  const CadFile file = read_small("edges_apart.brep");
  EXPECT_EQ(count(file.report, "edges of two faces joined"), 1u);
  EXPECT_EQ(file.report.free_edges.size(), 6u);
  ASSERT_EQ(file.report.openings.size(), 1u);
  EXPECT_TRUE(file.report.openings.front().is_loop);
  EXPECT_FALSE(file.report.openings.front().is_flat);
  EXPECT_GT(file.report.repaired.front().value, 0.003);  // the gap width is reported
}

TEST(SmallCadCases, MillimetresBecomeMetres) {
  const CadFile file = read_small("box_mm.step");
  EXPECT_EQ(file.report.file_unit, "millimetre");
  EXPECT_NEAR(volume(file), 0.4 * 0.2 * 0.1, 1e-12);
  EXPECT_EQ(file.model.components[ComponentId(0)].name, "block 1");  // OpenCASCADE numbers the products that it writes
}

/// Returns a wedge of chord 1 and the given span with a blunt end: a strip of the given height.
Model wedge(double span, double thickness, double strip) {
  ModelBuilder builder({.name = "wedge"});
  std::array<CornerId, 4> left, right;
  const std::array<Point, 4> section = {Point{0, 0, -0.5 * thickness}, {1, 0, -0.5 * strip}, {1, 0, 0.5 * strip}, {0, 0, 0.5 * thickness}};
  for (std::size_t i = 0; i < 4; ++i) {
    left[i] = builder.corner(section[i]);
    right[i] = builder.corner(section[i] + Vec3{0, span, 0});
  }
  std::array<EdgeId, 4> along, round_left, round_right;
  for (std::size_t i = 0; i < 4; ++i) {
    along[i] = builder.straight_edge(left[i], right[i]);
    round_left[i] = builder.straight_edge(left[i], left[(i + 1) % 4]);
    round_right[i] = builder.straight_edge(right[i], right[(i + 1) % 4]);
  }
  constexpr std::array<const char*, 4> k_names = {"lower", "strip", "upper", "front"};
  for (std::size_t i = 0; i < 4; ++i) builder.plane({round_left[i], along[(i + 1) % 4], round_right[i], along[i]}, FaceRole::wall, k_names[i]);
  builder.plane({round_left.begin(), round_left.end()}, FaceRole::wall, "left");
  builder.plane({round_right.begin(), round_right.end()}, FaceRole::wall, "right");
  return builder.closed_solid("wedge");
}

TEST(SmallCadCases, MendingKeepsTheVolumeOfAThinWing) {
  // The strip is 5e-7 of the area; removing the strip would leave a gap of 2e-5 of the volume.
  const Model model = wedge(20.0, 0.02, 1e-6);
  const BodyMeasures before = model_measures(model, RunContext()).total;
  const CadFile again =
      cad::read_cad_bytes(cad::cad_bytes(model, cad::CadFormat::step, "wedge.step", {}, RunContext()), cad::CadFormat::step, "wedge.step", {}, RunContext());
  const BodyMeasures after = model_measures(again.model, RunContext()).total;
  EXPECT_TRUE(again.report.is_closed()) << to_text(again.report);
  EXPECT_NEAR(after.area, before.area, 1e-6 * before.area) << to_text(again.report);
  EXPECT_NEAR(after.volume, before.volume, 1e-6 * before.volume) << to_text(again.report);
  ASSERT_FALSE(again.report.warnings.empty());
  EXPECT_NE(again.report.warnings.back().find("were kept"), std::string::npos) << again.report.warnings.back();
}

TEST(SmallCadCases, AnAssemblyKeepsInstancesNamesAndColours) {
  const CadFile file = read_small("tail_assembly.step");
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
    read_small("tail_assembly.step", options);
    FAIL();
  } catch (const Error& error) {
    EXPECT_EQ(error.code(), ErrorCode::geometry_failed);
    EXPECT_THAT(error.what(), testing::HasSubstr("longer than the limit"));
  }
}

}  // namespace
}  // namespace sterna
