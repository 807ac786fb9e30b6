#include "geom/cad/aircraft_union.h"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <set>

#include "cylinder.h"
#include "face_names.h"
#include "geom/cad/read_cad.h"
#include "geom/cad/write_cad.h"
#include "geom/model/components.h"
#include "geom/model/cpacs.h"
#include "geom/model/model_builder.h"
#include "geom/model/model_measures.h"
#include "geom/model/smx.h"
#include "tests/support/data.h"

namespace sterna {
namespace {

using test::face_names;

TEST(SplitSolids, EachPartHasOnlyItsFacesAndComponents) {
  Model both = test::cylinder(1.0, 2.0, {}, "low");
  append(both, test::cylinder(1.0, 2.0, {0, 0, 5}, "high"));
  const std::vector<Model> parts = cad::split_solids(both);
  ASSERT_EQ(parts.size(), 2u);
  EXPECT_EQ(parts[1].components.size(), 1u);
  EXPECT_EQ(parts[1].components[ComponentId(0)].name, "high");
  EXPECT_EQ(face_names(parts[0]), (std::set<std::string>{"low side", "low top", "low bottom"}));
  for (const Model& part : parts) {
    EXPECT_EQ(part.faces.size(), 3u);
    EXPECT_EQ(part.edges.size(), both.edges.size() / 2);
    EXPECT_TRUE(free_edges(part).empty());
  }
  EXPECT_EQ(parts[1].faces[FaceId(0)].surface, both.faces[FaceId(3)].surface);
}

TEST(SplitSolids, LooseFacesAreRefusedWithTheirPlace) {
  Model model = test::cylinder(1.0, 2.0, {}, "open");
  model.solids.resize(0);
  try {
    cad::unite_aircraft(model, {}, RunContext());
    FAIL();
  } catch (const Error& error) {
    EXPECT_EQ(error.code(), ErrorCode::open_surface);
    EXPECT_EQ(error.n_locations(), 3);
    EXPECT_NE(std::string(error.what()).find("\"open side\""), std::string::npos) << error.what();
  }
}

TEST(UniteHalves, HalvesMeetingInSymmetryPlaneBecomeOneBody) {
  // A swept wing: an edge remains along its root, but no face.
  const auto section = [](double y, double chord, double x) {
    WingSection s{.name = "s", .leading_edge = {x, y, 0.0}, .chord = chord};
    for (int i = 0; i <= 80; ++i) {
      const double a = 2.0 * std::numbers::pi * i / 80;
      s.points.push_back({0.5 + 0.5 * std::cos(a), 0.06 * std::sin(a)});
    }
    return s;
  };
  Wing wing{.name = "RightWing", .sections = {section(-4.0, 1.0, 1.5), section(0.0, 2.0, 0.0)}, .trailing_edge = std::nullopt};
  wing.right_tip = wing.left_tip = {CapShape::strip, 0.0};
  wing.has_mirror_image = true;
  Aircraft aircraft;
  aircraft.wings.push_back(wing);
  const Model halves = make_components(aircraft, RunContext());
  ASSERT_EQ(halves.solids.size(), 2u);
  const UniteResult united = cad::unite_aircraft(halves, {}, RunContext());
  EXPECT_EQ(united.report.n_bodies, 1u);
  ASSERT_EQ(united.model.solids.size(), 1u);
  EXPECT_TRUE(united.model.solids[SolidId(0)].is_closed);
  EXPECT_TRUE(free_edges(united.model).empty());
  EXPECT_NEAR(united.report.volume, united.report.sum_of_volumes, 1e-9);
  EXPECT_EQ(united.model.faces.size(), halves.faces.size() - 2);
  for (const FaceId f : united.model.faces.ids()) {
    const MeasureBox box = face_measures(united.model, f).box;
    EXPECT_GT(std::max(std::abs(box.min.y), std::abs(box.max.y)), 1e-6) << "a face is left in the plane of symmetry";
  }
  EXPECT_EQ(face_names(united.model), (std::set<std::string>{"LeftWing", "RightWing"}));
}

Model components_of(const std::string& file) {
  const std::filesystem::path path = test::shared_data() / file;
  return make_components(path.extension() == ".smx" ? read_smx(path, RunContext()).aircraft : read_cpacs(path, RunContext()).aircraft, RunContext());
}

class UniteAircraft : public testing::TestWithParam<std::pair<const char*, std::size_t>> {};

TEST_P(UniteAircraft, IsClosedAndTheSameFromStep) {
  STERNA_NEEDS_SHARED_DATA();
  const Model components = components_of(GetParam().first);
  const UniteResult united = cad::unite_aircraft(components, {}, RunContext());
  EXPECT_EQ(united.report.n_bodies, GetParam().second);
  EXPECT_TRUE(free_edges(united.model).empty());
  EXPECT_EQ(united.model.components.size(), components.components.size());
  const std::string bytes = cad::cad_bytes(united.model, cad::CadFormat::step, "again.step", {}, RunContext());
  const CadFile again = cad::read_cad_bytes(bytes, cad::CadFormat::step, "again.step", {}, RunContext());
  EXPECT_TRUE(again.report.is_closed());
  EXPECT_EQ(face_names(united.model), face_names(again.model));
  const BodyMeasures before = model_measures(united.model, RunContext()).total, after = model_measures(again.model, RunContext()).total;
  EXPECT_NEAR(after.area, before.area, 1e-6 * before.area);
  EXPECT_NEAR(after.volume, before.volume, 1e-6 * before.volume);
}

// The other aircraft are in tests/bench/aircraft_union_main.cpp.
INSTANTIATE_TEST_SUITE_P(Corpus, UniteAircraft,
                         testing::Values(std::pair("smx/torture.smx", 1u), std::pair("smx/underwingnacelle.smx", 1u), std::pair("smx/delta.smx", 1u),
                                         std::pair("cpacs/simpletest.cpacs.xml", 1u), std::pair("cpacs/canards.xml", 1u),
                                         std::pair("cpacs/landingGears.xml", 2u), std::pair("cpacs/onera_m6.xml", 1u)));

}  // namespace
}  // namespace sterna
