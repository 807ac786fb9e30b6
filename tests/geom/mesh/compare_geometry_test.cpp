// Each kind of geometry loss is introduced in a surface, and the comparison must name the kind.
#include "geom/mesh/compare_geometry.h"

#include <gmock/gmock.h>

#include <nlohmann/json.hpp>

#include "geom/mesh/half.h"
#include "tests/support/test_shapes.h"

namespace sterna {
namespace {

using testing::HasSubstr;
using testing::IsEmpty;
using testing::SizeIs;

const RunContext k_quiet;

TriMesh named(TriMesh mesh, const std::string& name, const Vec3& by = {}, double scale = 1.0) {
  for (Patch& patch : mesh.patches) patch.name = name;
  for (Vec3& p : mesh.points) p = scale * p + by;
  return mesh;
}

TriMesh together(std::initializer_list<TriMesh> parts) {
  TriMesh all;
  for (const TriMesh& part : parts) append(all, part);
  return all;
}

TriMesh turned(TriMesh mesh) {
  for (TriangleVertices& t : mesh.triangles) std::swap(t[1], t[2]);
  return mesh;
}

const TriMesh k_ball = named(test::sphere(4), "ball"), k_cube = named(test::cube(2), "cube", {5, 0, 0});

TEST(CompareGeometry, EqualSurfacesDoNotDiffer) {
  const TriMesh both = together({k_ball, k_cube});
  const GeometryChange change = compare_geometry(both, both, "repair", k_quiet);
  EXPECT_TRUE(change.is_small());
  EXPECT_THAT(warnings_of(change), IsEmpty());
  EXPECT_EQ(change.before.n_closed, 2);
  ASSERT_TRUE(change.before.volume);
  EXPECT_NEAR(*change.before.volume, *change.after.volume, 1e-12);
}

TEST(CompareGeometry, SenseInTheFileDoesNotMatter) {
  const GeometryChange change = compare_geometry(together({turned(k_ball), k_cube}), together({k_ball, k_cube}), "reading", k_quiet);
  EXPECT_TRUE(change.is_small()) << to_json(change);
}

TEST(CompareGeometry, MissingPatchIsNamed) {
  TriMesh after = k_cube;
  for (Patch& patch : after.patches) patch.name = "other";
  const GeometryChange change = compare_geometry(k_cube, after, "wrap", k_quiet);
  ASSERT_THAT(change.missing_patches, SizeIs(1));
  ASSERT_THAT(warnings_of(change), SizeIs(1));
  EXPECT_THAT(warnings_of(change)[0], HasSubstr("wrap: the result has no patch \"cube\" (6 m2)"));
}

TEST(CompareGeometry, NumberedPiecesStandForTheirPatch) {
  TriMesh after = k_cube;
  after.patches.raw()[0].name = "cube_1";
  const PatchId second = after.patches.push_back({"cube_2", PatchKind::wall});
  for (std::size_t t = 0; t < after.n_triangles() / 2; ++t) after.triangle_patch[TriangleId(t)] = second;
  EXPECT_THAT(warnings_of(compare_geometry(k_cube, after, "remesh", k_quiet)), IsEmpty());
}

TEST(CompareGeometry, MissingPartIsNamed) {
  const GeometryChange change = compare_geometry(together({k_ball, k_cube}), k_ball, "repair", k_quiet);
  ASSERT_THAT(change.missing_parts, SizeIs(1));
  EXPECT_EQ(change.missing_parts[0].name, "cube");
  EXPECT_NEAR(change.missing_parts[0].volume, 1.0, 1e-12);
  EXPECT_THAT(warnings_of(change), testing::Contains(HasSubstr("part \"cube\" (1 m3) of the input is missing")));
}

TEST(CompareGeometry, PartsOfOnePatchAreToldByPlace) {
  const TriMesh far = named(test::cube(2), "cube", {9, 0, 0});
  const GeometryChange change = compare_geometry(together({k_cube, far}), k_cube, "repair", k_quiet);
  ASSERT_THAT(change.missing_parts, SizeIs(1));
  EXPECT_THAT(change.missing_parts[0].name, HasSubstr("cube about (9"));
}

TEST(CompareGeometry, ChangesOfAreaAndVolumeHaveFigures) {
  const TriMesh larger = named(test::cube(2), "cube", {5, 0, 0}, 1.001);
  const GeometryChange change = compare_geometry(k_cube, larger, "remesh", k_quiet);
  EXPECT_TRUE(change.is_area_changed());
  EXPECT_TRUE(change.is_volume_changed());
  ASSERT_THAT(warnings_of(change), SizeIs(1));
  EXPECT_THAT(warnings_of(change)[0], HasSubstr("enclosed volume 1 -> 1.003 m3 (+0.3 %)"));
  EXPECT_THAT(warnings_of(compare_geometry(k_cube, named(test::cube(2), "cube", {5, 0, 0}, 1.0001), "remesh", k_quiet)), IsEmpty());
}

TEST(CompareGeometry, JoinedPartsAreNamed) {
  const TriMesh left = named(test::cube(2), "left"), right = named(test::cube(2), "right", {1, 0, 0});
  TriMesh one = together({left, right});  // without the common wall
  TriMesh joined;
  joined.points = one.points;
  joined.patches = one.patches;
  for (const TriangleId t : one.triangles.ids()) {
    const auto c = corners(one, t);
    const double x = bounding_box(left).max.x;
    if (c[0].x == x && c[1].x == x && c[2].x == x) continue;
    joined.triangles.push_back(one.triangles[t]);
    joined.triangle_patch.push_back(one.triangle_patch[t]);
  }
  const GeometryChange change = compare_geometry(one, joined, "repair", k_quiet);
  EXPECT_EQ(change.before.n_closed, 2) << to_json(change);
  ASSERT_THAT(change.joined_parts, SizeIs(1));
  EXPECT_THAT(warnings_of(change), testing::Contains(HasSubstr("are one part of the result")));
  EXPECT_THAT(warnings_of(change, GeometryChangeUse::unites_bodies), IsEmpty());
}

TEST(CompareGeometry, HalfIsComparedWithPartBeyondPlane) {
  const TriMesh whole = together({k_ball, k_cube});
  const HalfOptions options;
  EXPECT_THAT(warnings_of(compare_geometry(beyond_plane(whole, options), half_of(whole, {.snap = 0.0}, k_quiet), "half", k_quiet)), IsEmpty());
  EXPECT_THAT(warnings_of(compare_geometry(beyond_plane(whole, options), half_of(k_ball, {.snap = 0.0}, k_quiet), "half", k_quiet)),
              testing::Contains(HasSubstr("no patch \"cube\"")));
}

TEST(CompareGeometry, JsonHasAllFigures) {
  const auto json = nlohmann::json::parse(to_json(compare_geometry(together({k_ball, k_cube}), k_ball, "repair", k_quiet)));
  EXPECT_EQ(json.at("by"), "repair");
  EXPECT_EQ(json.at("missing_patches").at(0).at("name"), "cube");
  EXPECT_EQ(json.at("closed_parts").at("before"), 2);
  EXPECT_GT(json.at("volume").at("before").get<double>(), json.at("volume").at("after").get<double>());
}

}  // namespace
}  // namespace sterna
