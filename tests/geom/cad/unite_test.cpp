#include "geom/cad/unite.h"

#include <numbers>
#include <set>

#include "cylinder.h"

namespace sterna {
namespace {

using std::numbers::pi;

TEST(Unite, OverlappingCylindersAreOneBodyOfKnownVolume) {
  std::vector<Model> parts = {test::cylinder(1.0, 2.0, {}, "thick"), test::cylinder(0.5, 2.0, {0, 0, 1}, "thin")};
  parts[1].faces[FaceId(0)].role = FaceRole::nozzle;
  const UniteResult result = cad::unite(parts, {}, RunContext());
  const double expected = pi * 2.0 + pi * 0.25;  // the thin cylinder sticks out by 1
  EXPECT_NEAR(result.report.volume, expected, 1e-6 * expected);
  EXPECT_EQ(result.report.n_bodies, 1u);
  EXPECT_NEAR(result.report.sum_of_volumes, 2.5 * pi, 1e-5);
  EXPECT_TRUE(free_edges(result.model).empty());
  std::set<std::string> names, components;
  for (const ModelFace& face : result.model.faces) {
    names.insert(face.name);
    components.insert(result.model.components[face.component].name);
    if (face.name == "thin side") {
      EXPECT_EQ(face.role, FaceRole::nozzle);
      EXPECT_EQ(face.surface, parts[1].faces[FaceId(0)].surface);
    }
    if (face.name == "thick side") {
      EXPECT_EQ(face.surface, parts[0].faces[FaceId(0)].surface);
    }
  }
  EXPECT_EQ(names, (std::set<std::string>{"thick side", "thick top", "thick bottom", "thin side", "thin top"}));  // the thin bottom is inside
  EXPECT_EQ(components, (std::set<std::string>{"thick", "thin"}));
}

TEST(Unite, BodiesApartAreToldWithTheirGap) {
  const std::vector<Model> parts = {test::cylinder(1.0, 2.0, {}, "low"), test::cylinder(1.0, 2.0, {0, 0, 2.25}, "high")};
  const UniteResult result = cad::unite(parts, {}, RunContext());
  EXPECT_EQ(result.report.n_bodies, 2u);
  ASSERT_EQ(result.report.doubts.size(), 1u);
  EXPECT_NE(result.report.doubts.front().what.find("apart by 0.25"), std::string::npos) << result.report.doubts.front().what;
}

TEST(Unite, PartsTouchingWithWholeFaceLoseIt) {
  const std::vector<Model> parts = {test::cylinder(1.0, 2.0, {}, "low"), test::cylinder(1.0, 1.0, {0, 0, 2.0}, "high")};
  const UniteResult result = cad::unite(parts, {}, RunContext());
  EXPECT_EQ(result.report.n_bodies, 1u);
  EXPECT_NEAR(result.report.volume, 3.0 * pi, 1e-5);
  EXPECT_EQ(result.model.faces.size(), 4u);
}

TEST(Unite, AnOpenPartIsRefusedByName) {
  std::vector<Model> parts = {test::cylinder(1.0, 2.0, {}, "whole"), test::cylinder(0.5, 4.0, {}, "open")};
  parts[1].solids[SolidId(0)].is_closed = false;
  try {
    cad::unite(parts, {}, RunContext());
    FAIL();
  } catch (const Error& error) {
    EXPECT_EQ(error.code(), ErrorCode::open_surface);
    EXPECT_NE(std::string(error.what()).find("\"open\" is not closed"), std::string::npos) << error.what();
  }
}

TEST(Unite, TheSamePartsGiveTheSameModel) {
  const auto run = [] {
    const std::vector<Model> parts = {test::cylinder(1.0, 2.0, {}, "thick"), test::cylinder(0.5, 2.0, {0.2, 0, 1}, "thin")};
    const UniteResult result = cad::unite(parts, {}, RunContext());
    std::vector<std::string> names;
    for (const ModelFace& face : result.model.faces) names.push_back(face.name + std::to_string(face.borders.size()));
    for (const ModelCorner& corner : result.model.corners) names.push_back(format_point(corner.point));
    return names;
  };
  EXPECT_EQ(run(), run());
}

}  // namespace
}  // namespace sterna
