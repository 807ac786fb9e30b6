// Each class of defect on synthetic shapes: the repaired surface is closed, oriented, without crossings, encloses the right region; changes are reported.
#include "surfmesh/repair/repair_surface.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <random>

#include "geom/mesh/half.h"
#include "tests/support/error_of.h"
#include "tests/surfmesh/soups.h"

namespace sterna::test {
namespace {

using surfmesh::RepairKind;
using surfmesh::RepairOptions;
using surfmesh::RepairResult;

/// Repairs and proves the guarantees of the header, for closed and half surfaces.
RepairResult repaired(const std::vector<SurfaceSoup>& soups, const RepairOptions& options = {}, int threads = 2) {
  const RunContext context = quiet(threads);
  RepairResult result = surfmesh::repair_surface(soups, {}, options, context);
  const Topology topology(result.mesh, context);  // throws where it is not manifold
  for (std::size_t i = 0; i < topology.n_halfedges(); ++i) {
    const HalfedgeId h(i);
    if (!topology.is_boundary(h)) continue;
    EXPECT_TRUE(result.report.half.has_value());
    if (!result.report.half) break;
    const auto axis = static_cast<std::size_t>(result.report.half->axis[0] - 'x');
    EXPECT_EQ(result.mesh.points[topology.from(h)][axis], result.report.half->at);
  }
  std::vector<std::array<std::uint32_t, 3>> triangles;
  for (const TriangleVertices& t : result.mesh.triangles) triangles.push_back({t[0].value(), t[1].value(), t[2].value()});
  EXPECT_EQ(find_crossings(result.mesh.points.raw(), triangles, context).total, 0);
  EXPECT_EQ(result.mesh.triangle_patch.size(), result.mesh.n_triangles());
  EXPECT_EQ(result.report.drawing.triangles.size(), result.report.drawing.change.size());
  for (const surfmesh::RepairChange& change : result.report.changes) {
    EXPECT_TRUE(is_finite(change.position));
    EXPECT_GE(change.size, 0.0);
    EXPECT_GT(change.n_facets, 0);
  }
  return result;
}

SurfaceSoup without(SurfaceSoup soup, const std::vector<std::size_t>& facets) {
  for (auto f = facets.rbegin(); f != facets.rend(); ++f) {
    soup.triangles.erase(soup.triangles.begin() + static_cast<std::ptrdiff_t>(*f));
    soup.patch.erase(soup.patch.begin() + static_cast<std::ptrdiff_t>(*f));
  }
  return soup;
}

SurfaceSoup cube_soup(const Vec3& at = {}, double size = 1.0, int n = 2) { return shifted(soup_of(cube(n)), at, size); }

TEST(RepairSurface, AcceptedSurfaceReturnsWithSameBytes) {
  const std::vector<SurfaceSoup> soups{soup_of(sphere(6)), shifted(cube_soup(), {3, 0, 0})};
  const TriMesh expected = surfmesh::stitch_surface(soups, {}, quiet()).mesh;
  const RepairResult result = repaired(soups);
  EXPECT_EQ(result.mesh.points, expected.points);
  EXPECT_EQ(result.mesh.triangles, expected.triangles);
  EXPECT_EQ(result.mesh.triangle_patch, expected.triangle_patch);
  EXPECT_EQ(result.mesh.patches, expected.patches);
  EXPECT_TRUE(result.report.changes.empty());
  EXPECT_TRUE(result.report.messages.empty());
  EXPECT_EQ(result.report.from_result, 0.0);
}

TEST(RepairSurface, HalfModelsWithOtherOpeningsAreRefused) {
  TriMesh half = half_of(sphere(12), {.axis = "y", .keep = "+"}, quiet());
  std::vector<std::size_t> top;
  for (const TriangleId t : half.triangles.ids()) {
    const auto c = corners(half, t);
    if (distance((c[0] + c[1] + c[2]) / 3.0, {0.3, 0.9, 0.2}) < 0.2) top.push_back(t.index());
  }
  const SurfaceSoup soup = without(soup_of(half), top);
  RepairOptions options;
  options.hole = options.flat_hole = 0.05;
  expect_error(ErrorCode::open_surface, "outside of its plane y", [&] { surfmesh::repair_surface({soup}, {}, options, quiet()); });
  EXPECT_FALSE(surfmesh::foresee_repair({soup}, {}, options, quiet()).is_enough);
}

TEST(ForeseeRepair, CountsWhatRepairDoes) {
  const std::vector<SurfaceSoup> soups{without(cube_soup(), {0, 1, 2, 9}), shifted(cube_soup(), {0.4, 0.3, 0.35})};
  const surfmesh::RepairForecast forecast = surfmesh::foresee_repair(soups, {}, {}, quiet());
  const RepairResult result = repaired(soups);
  EXPECT_TRUE(forecast.is_needed);
  EXPECT_TRUE(forecast.is_enough);
  EXPECT_EQ(forecast.n_holes, result.report.count(RepairKind::filled));
  EXPECT_GT(forecast.n_crossings, 0);
  EXPECT_EQ(forecast.n_facets, 92);
  EXPECT_NEAR(forecast.area, 12.0 - 4.0 / 8.0, 1e-12);
  EXPECT_DOUBLE_EQ(forecast.length, result.report.length);
  EXPECT_FALSE(forecast.problem.empty());
  EXPECT_FALSE(forecast.locations.empty());
}

TEST(ForeseeRepair, NothingIsForeseenOfWhatIsAccepted) {
  const surfmesh::RepairForecast forecast = surfmesh::foresee_repair({cube_soup()}, {}, {}, quiet());
  EXPECT_FALSE(forecast.is_needed);
  EXPECT_TRUE(forecast.is_enough);
}

TEST(ForeseeRepair, CrossingsWithoutHullAreTooMuch) {
  const std::vector<SurfaceSoup> soups{cube_soup(), shifted(cube_soup(), {0.4, 0.3, 0.35})};
  RepairOptions options;
  options.hull = false;
  EXPECT_FALSE(surfmesh::foresee_repair(soups, {}, options, quiet()).is_enough);
  EXPECT_TRUE(surfmesh::foresee_repair(soups, {}, {}, quiet()).is_enough);
}

TEST(RepairSurface, FlatHolesAreFilledFlat) {
  const RepairResult result = repaired({without(cube_soup(), {0, 1, 2, 9})});
  EXPECT_NEAR(volume_of(result.mesh), 1.0, 1e-14);
  EXPECT_GE(result.report.count(RepairKind::filled), 1);
  EXPECT_EQ(result.report.moved, 0.0);
}

TEST(RepairSurface, CurvedHolesAreFilledRound) {
  const TriMesh whole = sphere(12);
  std::vector<std::size_t> cap;
  for (const TriangleId t : whole.triangles.ids()) {
    const auto c = corners(whole, t);
    if ((c[0] + c[1] + c[2]).z / 3.0 > 0.9) cap.push_back(t.index());
  }
  ASSERT_GT(cap.size(), 20u);
  RepairOptions options;
  options.half = "off";
  options.hole = 1.0;
  // A flat lid would lose the cap's height of 0.1; a fair surface keeps most of this height.
  const RepairResult result = repaired({without(soup_of(whole), cap)}, options);
  double top = 0.0;
  for (const Point& p : result.mesh.points) top = std::max(top, p.z);
  EXPECT_GT(top, 0.95);
  EXPECT_LT(top, 1.05);
  EXPECT_EQ(result.report.count(RepairKind::filled), 1);
  EXPECT_GT(result.report.from_result, 0.0);
}

TEST(RepairSurface, HolesAboveLimitAreErrorNamingWrap) {
  RepairOptions options;
  options.half = "off";
  options.hole = options.flat_hole = 0.1;
  const Error error = error_of([&] { repaired({without(cube_soup(), {0, 1})}, options); });
  EXPECT_EQ(error.code(), ErrorCode::open_surface);
  EXPECT_THAT(error.what(), testing::HasSubstr("wrap"));
  EXPECT_FALSE(error.info().locations.empty());
  options.flat_hole = 2.0;
  options.hole_edges = 3;
  EXPECT_EQ(error_of([&] { repaired({without(cube_soup(), {0, 1})}, options); }).code(), ErrorCode::open_surface);
}

TEST(RepairSurface, SeamsAreZippedWithinTheGap) {
  // The upper half of a cube, lifted by 5e-4.
  const TriMesh whole = cube(4);
  SurfaceSoup soup = soup_of(whole);
  for (std::size_t t = 0; t < soup.triangles.size(); ++t) {
    const auto& v = soup.triangles[t];
    const double z = (soup.points[v[0]].z + soup.points[v[1]].z + soup.points[v[2]].z) / 3.0;
    if (z > 0.5)
      for (const std::uint32_t p : v) soup.points[p].z += 5e-4;
  }
  const RepairResult result = repaired({soup});
  EXPECT_GE(result.report.count(RepairKind::zipped), 1);
  EXPECT_EQ(result.report.count(RepairKind::filled), 0);
  EXPECT_EQ(result.mesh.n_triangles(), whole.n_triangles());
  EXPECT_LE(result.report.moved, 5e-4);
  EXPECT_NEAR(volume_of(result.mesh), 1.0, 1e-3);
  RepairOptions narrow;
  narrow.gap = 1e-4;
  EXPECT_EQ(repaired({soup}, narrow).report.count(RepairKind::zipped), 0);  // the gap is filled instead
}

TEST(RepairSurface, TJunctionsAreSplit) {
  // The top of a cube of 2 x 2 squares is replaced by one of 3 x 3: its boundary has other vertices.
  SurfaceSoup soup;
  soup.patch_names = {""};
  const auto add_part = [&](const TriMesh& mesh, bool is_top) {
    for (const TriangleId t : mesh.triangles.ids()) {
      const auto c = corners(mesh, t);
      const bool on_top = c[0].z == 1.0 && c[1].z == 1.0 && c[2].z == 1.0;
      if (on_top == is_top) add_facet(soup, c[0], c[1], c[2]);
    }
  };
  add_part(cube(2), false);
  add_part(cube(3), true);
  const RepairResult result = repaired({soup});
  EXPECT_NEAR(volume_of(result.mesh), 1.0, 1e-12);
  EXPECT_LE(result.report.from_result, 1e-12);
}

TEST(RepairSurface, CrossingBodiesBecomeTheirUnion) {
  const RepairResult result = repaired({cube_soup(), cube_soup({0.5, 0.25, 0.125})});
  EXPECT_NEAR(volume_of(result.mesh), 2.0 - 0.5 * 0.75 * 0.875, 1e-12);
  EXPECT_GE(result.report.count(RepairKind::cut), 1);
  EXPECT_GE(result.report.count(RepairKind::removed_inside), 1);
  EXPECT_LE(result.report.moved, 1e-12);
}

TEST(RepairSurface, BodiesThatShareAWallLoseIt) {
  // Two cubes side by side: coplanar facets on both, once with the same triangles and once with others.
  for (const int n : {2, 3}) {
    const RepairResult result = repaired({cube_soup(), cube_soup({1, 0, 0}, 1.0, n)});
    EXPECT_NEAR(volume_of(result.mesh), 2.0, 1e-12);
    for (const TriangleId t : result.mesh.triangles.ids()) {
      const auto c = corners(result.mesh, t);
      EXPECT_FALSE(c[0].x == 1.0 && c[1].x == 1.0 && c[2].x == 1.0);
    }
  }
}

TEST(RepairSurface, InnerWallsAndFinsAreRemoved) {
  SurfaceSoup soup = cube_soup();
  // A wall across the inside, through edges of the cube's facets, and a fin outside on one of its edges.
  add_facet(soup, {0.5, 0, 0}, {0.5, 1, 0}, {0.5, 1, 1});
  add_facet(soup, {0.5, 0, 0}, {0.5, 1, 1}, {0.5, 0, 1});
  add_facet(soup, {1, 0, 1}, {1, 1, 1}, {1.5, 0.5, 1.5});
  const RepairResult result = repaired({soup});
  EXPECT_NEAR(volume_of(result.mesh), 1.0, 1e-12);
  EXPECT_GE(result.report.count(RepairKind::removed_sheet) + result.report.count(RepairKind::removed_inside), 2);
}

TEST(RepairSurface, SheetsThroughABodyAreRemoved) {
  SurfaceSoup soup = soup_of(sphere(6));
  add_facet(soup, {-2, 0.01, 0.02}, {2, 0.03, 0.5}, {0.1, 0.02, 2});
  const RepairResult result = repaired({soup});
  EXPECT_NEAR(volume_of(result.mesh), volume_of(sphere(6)), 1e-12);
  EXPECT_EQ(result.report.count(RepairKind::removed_sheet), 1);
}

TEST(RepairSurface, SmallPartsAreDroppedWhereSomethingIsRepaired) {
  const SurfaceSoup speck = shifted(without(cube_soup(), {3}), {0.5, 0.5, 3.0}, 1e-4);
  const RepairResult result = repaired({without(cube_soup(), {0}), speck});
  EXPECT_NEAR(volume_of(result.mesh), 1.0, 1e-12);
  EXPECT_EQ(result.report.count(RepairKind::removed_part), 1);
}

TEST(RepairSurface, ClosedPartsWithoutThicknessAreDropped) {
  SurfaceSoup soup = without(cube_soup(), {0});
  const Point a{3, 0, 0}, b{3, 4, 0}, c{3, 2, 1e-14}, d{3, 1, 0.5};  // four facets, nearly coplanar
  for (const auto& t : {std::array{a, b, d}, std::array{b, a, c}, std::array{b, c, d}, std::array{c, a, d}}) add_facet(soup, t[0], t[1], t[2]);
  const RepairResult result = repaired({soup});
  EXPECT_NEAR(volume_of(result.mesh), 1.0, 1e-12);
  for (const Point& p : result.mesh.points) EXPECT_LE(p.x, 1.0);
}

/// Similar to the remains of cutting an airliner (afem_777 of the shared data): engines refused the mesh, and remeshing halved its edges endlessly.
TEST(RepairSurface, PartsAsThinAsALineAreDropped) {
  SurfaceSoup soup = cube_soup({0, -5, -5}, 20.0);
  const Point a{22.429632991580142, -4.474867651151577, -1.4976376603497434}, b{22.531284837491086, -4.620135054854745, -1.4720450933317424},
      c{22.497628296598783, -4.5720375680925835, -1.4805186952684706}, d{22.5647138144612, -4.667907337289754, -1.463628784451465};
  for (const auto& t : {std::array{a, b, c}, std::array{a, d, b}, std::array{c, b, d}, std::array{a, c, d}}) add_facet(soup, t[0], t[1], t[2]);
  const RepairResult result = repaired({soup, cube_soup({10, 0, 0}, 18.0, 3)});
  EXPECT_NEAR(volume_of(result.mesh), 8000.0 + 5832.0 - 10.0 * 15.0 * 15.0, 1e-9);
  EXPECT_EQ(connected_components(result.mesh, Topology(result.mesh, quiet(1))).count, 1u);
}

TEST(RepairSurface, BodiesThatTouchInAnEdgeAreJoined) {
  const RepairResult result = repaired({cube_soup(), cube_soup({1, 1, 0})});
  EXPECT_GE(result.report.count(RepairKind::joined), 1);
  EXPECT_NEAR(volume_of(result.mesh), 2.0, 1e-3);
}

TEST(RepairSurface, HalfModelsAreRecognised) {
  const TriMesh whole = sphere(10, 1.0);
  for (const std::size_t axis : {0u, 1u, 2u}) {
    for (const double off : {0.0, 1e-6, 1e-4, 9e-4}) {
      SCOPED_TRACE("axis " + std::to_string(axis) + ", off by " + std::to_string(off));
      TriMesh half = half_of(whole, {.axis = std::string(1, "xyz"[axis]), .keep = axis == 2 ? "-" : "+"}, quiet());
      std::mt19937 random(7);
      for (Point& p : half.points)
        if (p[axis] == 0.0) p[axis] = off * 2.0 * (static_cast<double>(random()) / static_cast<double>(std::mt19937::max()) - 0.5) * 2.0;
      const RepairResult result = repaired({soup_of(half)});
      ASSERT_TRUE(result.report.half.has_value());
      EXPECT_EQ(result.report.half->axis, std::string(1, "xyz"[axis]));
      EXPECT_EQ(result.report.half->at, 0.0);
      EXPECT_EQ(result.report.half->is_above, axis != 2);
      EXPECT_EQ(result.mesh.n_triangles(), half.n_triangles());
      EXPECT_LE(result.report.moved, 2.0 * off + 1e-15);
      // half_of() leaves the result unchanged.
      const TriMesh again = half_of(result.mesh, {.axis = result.report.half->axis, .at = result.report.half->at, .keep = axis == 2 ? "-" : "+"}, quiet());
      EXPECT_EQ(again.points, result.mesh.points);
      EXPECT_EQ(again.triangles, result.mesh.triangles);
    }
  }
}

TEST(RepairSurface, FlatSideMissingFacetIsNoHalfModel) {
  const RepairResult result = repaired({without(cube_soup({}, 1.0, 1), {0})});
  EXPECT_FALSE(result.report.half.has_value());
  EXPECT_NEAR(volume_of(result.mesh), 1.0, 1e-14);
}

TEST(RepairSurface, ASheetIsNoBody) {
  SurfaceSoup soup;
  soup.patch_names = {""};
  add_facet(soup, {0, 0, 0}, {1, 0, 0.3}, {0, 1, 0.3});
  add_facet(soup, {1, 0, 0.3}, {1, 1, 0}, {0, 1, 0.3});
  EXPECT_THAT(message_of([&] { repaired({soup}); }), testing::HasSubstr("wrap"));
}

TEST(RepairSurface, AStopIsHonoured) {
  std::stop_source source;
  source.request_stop();
  const RunContext context({.threads = 2, .stop = source.get_token()});
  EXPECT_EQ(error_of([&] { surfmesh::repair_surface({without(cube_soup(), {0})}, {}, {}, context); }).code(), ErrorCode::cancelled);
}

/// Returns the soup with holes, copies, flipped facets and cracks, controlled by a seed.
SurfaceSoup torn(SurfaceSoup soup, std::uint32_t seed) {
  std::mt19937 random(seed);
  const auto share = [&] { return static_cast<double>(random()) / static_cast<double>(std::mt19937::max()); };
  std::vector<std::size_t> missing;
  const std::size_t n = soup.triangles.size();
  for (std::size_t t = 0; t < n; ++t) {
    const double what = share();
    if (what < 0.02) {
      missing.push_back(t);
    } else if (what < 0.04) {
      soup.triangles.push_back(soup.triangles[t]);
      soup.patch.push_back(soup.patch[t]);
    } else if (what < 0.06) {
      std::swap(soup.triangles[t][1], soup.triangles[t][2]);
    } else if (what < 0.10) {
      Vec3& p = soup.points[soup.triangles[t][0]];  // of this facet only
      p += 2e-4 * Vec3{share() - 0.5, share() - 0.5, share() - 0.5};
    }
  }
  return without(std::move(soup), missing);
}

TEST(RepairSurface, TornBodiesAreMended) {
  for (std::uint32_t seed = 1; seed <= 20; ++seed) {
    SCOPED_TRACE("seed " + std::to_string(seed));
    const TriMesh whole = seed % 2 ? sphere(10) : cube(8);
    const RepairResult result = repaired({torn(soup_of(whole), seed)});
    EXPECT_NEAR(volume_of(result.mesh), volume_of(whole), 0.02 * volume_of(whole));
    EXPECT_LE(result.report.from_input, 0.03);
    EXPECT_FALSE(result.report.half.has_value());
  }
}

TEST(RepairSurface, AnyNumberOfThreadsGivesTheSameBytes) {
  const std::vector<SurfaceSoup> soups{torn(soup_of(sphere(12)), 3), torn(shifted(soup_of(sphere(9)), {0.9, 0.2, 0.1}), 5)};
  const RepairResult one = repaired(soups, {}, 1), four = repaired(soups, {}, 4);
  EXPECT_EQ(one.mesh.points, four.mesh.points);
  EXPECT_EQ(one.mesh.triangles, four.mesh.triangles);
  EXPECT_EQ(one.mesh.triangle_patch, four.mesh.triangle_patch);
  EXPECT_EQ(one.report.messages, four.report.messages);
  EXPECT_EQ(one.report.from_input, four.report.from_input);
}

TEST(RepairSurface, PatchesFollowTheirFacets) {
  SurfaceSoup a = without(cube_soup(), {0}), b = cube_soup({0.5, 0.25, 0.125});
  a.patch_names = {"left"};
  b.patch_names = {"right"};
  a.has_names = b.has_names = true;
  const RepairResult result = repaired({a, b});
  ASSERT_EQ(result.mesh.patches.size(), 2u);
  for (const TriangleId t : result.mesh.triangles.ids()) {
    const auto c = corners(result.mesh, t);
    const Vec3 center = (c[0] + c[1] + c[2]) / 3.0;
    const bool is_right = result.mesh.patches[result.mesh.triangle_patch[t]].name == "right";
    EXPECT_FALSE(center.x < 0.45 && is_right);
    EXPECT_FALSE(center.x > 1.05 && !is_right);
  }
}

}  // namespace
}  // namespace sterna::test
