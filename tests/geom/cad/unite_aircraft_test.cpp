#include "geom/cad/aircraft_union.h"

#include <set>

#include "cylinder.h"
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

std::set<std::string> face_names(const Model& model) {
  std::set<std::string> names;
  for (const ModelFace& face : model.faces) names.insert(face.name);
  return names;
}

TEST(SplitSolids, EachPartHasItsOwnFacesAndComponentsAlone) {
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
    EXPECT_EQ(error.n_places(), 3);
    EXPECT_NE(std::string(error.what()).find("\"open side\""), std::string::npos) << error.what();
  }
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

// The others are in tests/bench/aircraft_union_main.cpp.
INSTANTIATE_TEST_SUITE_P(Corpus, UniteAircraft, testing::Values(std::pair("smx/torture.smx", 1u), std::pair("smx/underwingnacelle.smx", 1u), std::pair("smx/delta.smx", 1u), std::pair("cpacs/simpletest.cpacs.xml", 1u),
                                                                std::pair("cpacs/canards.xml", 1u), std::pair("cpacs/landingGears.xml", 2u), std::pair("cpacs/onera_m6.xml", 1u)));

}  // namespace
}  // namespace sterna
