#include <gmock/gmock.h>

#include "geom/mesh/bvh.h"
#include "tests/geom/boolean/bodies.h"

namespace sterna::test {
namespace {

using testing::HasSubstr;

/// Cutting and flipping plane faces moves vertices by rounding only.
constexpr double k_rounding = 1e-12;

TEST(UniteMeshes, OverlappingCubesHaveUnionVolume) {
  for (const bool remesh : {false, true}) {
    const UnionResult result = unite({cube(2), shifted(cube(2), {0.5, 0.25, 0.3})}, {.remesh = remesh});
    EXPECT_NEAR(volume(result.mesh), 2.0 - 0.5 * 0.75 * 0.7, k_rounding);
    EXPECT_EQ(result.report.n_components, 1);
    EXPECT_EQ(result.report.n_solids, 2);
    EXPECT_GT(result.report.n_curve_edges, 0);
  }
}

TEST(UniteMeshes, SharedFacesAreExact) {
  struct Case {
    Vec3 shift;
    double volume;
  };
  // Whole face, part of a face, four coplanar sides, a corner of coplanar sides.
  for (const Case& c : {Case{{1, 0, 0}, 2.0}, Case{{1, 0.5, 0.25}, 2.0}, Case{{0.5, 0, 0}, 1.5}, Case{{0.5, 0.5, 0}, 1.75}})
    for (const bool remesh : {false, true})
      for (const int n : {1, 3}) {
        SCOPED_TRACE(format_point(c.shift) + " n " + std::to_string(n));
        EXPECT_NEAR(volume(unite({cube(n), shifted(cube(2), c.shift)}, {.remesh = remesh}).mesh), c.volume, k_rounding);
      }
}

TEST(UniteMeshes, TheSameBodyTwiceIsThatBody) {
  const UnionResult result = unite({sphere(4), sphere(4)});
  EXPECT_EQ(result.report.n_vanished, 1);
  EXPECT_NEAR(volume(result.mesh), volume(sphere(4)), k_rounding);
}

TEST(UniteMeshes, BodiesTouchingInEdgeOrPointAreErrors) {
  const ErrorInfo edge = union_error({cube(1), shifted(cube(1), {1, 1, 0})});
  EXPECT_EQ(edge.code, ErrorCode::non_manifold_surface);
  EXPECT_THAT(edge.attempted, HasSubstr("b and a cannot be united"));
  ASSERT_FALSE(edge.locations.empty());
  EXPECT_LT(distance(edge.locations.front().position, {1, 1, 0.5}), 1.0);
  EXPECT_FALSE(edge.geometry.triangles.empty());
  const ErrorInfo point = union_error({cube(1), shifted(cube(1), {1, 1, 1})});
  EXPECT_TRUE(point.code == ErrorCode::self_intersection || point.code == ErrorCode::non_manifold_surface) << to_string(point.code);
  ASSERT_FALSE(point.locations.empty());
  EXPECT_LT(distance(point.locations.front().position, {1, 1, 1}), 1.5);
}

TEST(UniteMeshes, ABodyInsideAnotherVanishesWithAMessage) {
  const UnionResult result = unite({named(sphere(6), "outer"), named(sphere(3, 0.4), "inner")});
  EXPECT_EQ(result.report.n_vanished, 1);
  EXPECT_EQ(result.mesh.n_triangles(), sphere(6).n_triangles());
  ASSERT_EQ(result.mesh.patches.size(), 1u);
  EXPECT_EQ(result.mesh.patches.raw()[0].name, "outer");
  EXPECT_THAT(result.report.messages, testing::Contains(HasSubstr("b lies inside a: it is removed")));
}

TEST(UniteMeshes, BodiesApartStayAsTheyAre) {
  const TriMesh one = named(sphere(3), "one"), two = named(shifted(cube(2), {3, 0, 0}), "two");
  const UnionResult result = unite({one, two});
  EXPECT_EQ(result.report.n_components, 2);
  EXPECT_EQ(result.mesh.n_triangles(), one.n_triangles() + two.n_triangles());
  EXPECT_NEAR(volume(result.mesh), volume(one) + volume(two), k_rounding);
}

TEST(UniteMeshes, OrientationAndOrderOfBodiesDoNotMatter) {
  const TriMesh a = cube(2), b = turned(shifted(cube(3), {0.3, 0.2, 0.1}), 0.3, 0.7);
  TriMesh inside_out = b;
  for (auto& t : inside_out.triangles) std::swap(t[1], t[2]);
  const UnionOptions exact{.remesh = false};
  const double v = volume(unite({a, b}, exact).mesh);
  EXPECT_NEAR(volume(unite({b, a}, exact).mesh), v, k_rounding);
  EXPECT_NEAR(volume(unite({a, inside_out}, exact).mesh), v, k_rounding);
  EXPECT_LT(v, 2.0);
  EXPECT_GT(v, 1.0);
}

TEST(UniteMeshes, ScaleAndPlaceDoNotMatter) {
  const TriMesh a = sphere(5), b = shifted(sphere(4, 0.8), {0.7, 0.3, 0.1});
  const double v = volume(unite({a, b}).mesh);
  for (const double scale : {1e-6, 1e3})
    for (const Vec3& by : {Vec3{}, Vec3{1e3 * scale, -2e3 * scale, 500 * scale}}) {
      const UnionResult result = unite({shifted(a, by, scale), shifted(b, by, scale)});
      // Remeshing decides by rounded lengths and may choose otherwise; the result stays within the permitted deviation.
      EXPECT_NEAR(volume(result.mesh) / (scale * scale * scale), v, 0.01 * v);
      EXPECT_LT(result.report.after.n_slivers, result.report.before.n_slivers + 1);
    }
}

TEST(UniteMeshes, ManyPositionsOfASphereInACube) {
  const TriMesh a = named(cube(4), "cube");
  for (int i = 0; i < 25; ++i) {
    SCOPED_TRACE(i);
    const TriMesh b = named(shifted(turned(sphere(3 + i % 3, 0.3 + 0.01 * i), 0.1 * i, 0.2 * i), {0.9 + 0.03 * i, 0.5 - 0.02 * i, 0.1 * (i % 7)}), "ball");
    const UnionResult exact = unite({a, b}, {.remesh = false});
    const UnionResult result = unite({a, b});
    EXPECT_NEAR(volume(result.mesh), volume(exact.mesh), 0.01 * volume(exact.mesh));
    EXPECT_GE(result.report.after.min_angle, std::min(result.report.before.min_angle, k_sliver_angle));
  }
}

TEST(UniteMeshes, StingKeepsPatchesAndSurfaceAwayFromCurve) {
  const TriMesh body = named(stretched(sphere(12), {2.0, 0.5, 0.5}), "body"), sting = named(shifted(cylinder(0.12, 2.5, 24, 20), {1.0, 0.0, 0.02}), "sting");
  const UnionResult result = unite({body, sting});
  ASSERT_EQ(result.mesh.patches.size(), 2u);
  EXPECT_EQ(result.mesh.patches.raw()[0].name, "body");
  EXPECT_EQ(result.mesh.patches.raw()[1].name, "sting");
  // A thin triangle may remain where the intersection curve itself has a short edge with a kink.
  EXPECT_GT(result.report.before.n_slivers, 20);
  EXPECT_LE(result.report.after.n_slivers, 2);
  EXPECT_GT(result.report.after.min_angle, 0.03);
  // Far from the intersection curve (near x = 1.9) every triangle is a triangle of the input.
  std::set<std::array<double, 3>> input;
  for (const TriMesh& mesh : {body, sting})
    for (const Point& p : mesh.points) input.insert({p.x, p.y, p.z});
  std::size_t n_far = 0;
  for (const TriangleId t : result.mesh.triangles.ids())
    for (const Point& p : corners(result.mesh, t)) {
      if (p.x > 0.0 && p.x < 3.2) continue;
      ++n_far;
      EXPECT_TRUE(input.contains({p.x, p.y, p.z})) << format_point(p);
    }
  EXPECT_GT(n_far, 500u);
  // Every vertex lies on the surface of its patch, within the deviation.
  const TriangleTree on_body(body, quiet()), on_sting(sting, quiet());
  for (const TriangleId t : result.mesh.triangles.ids())
    for (const Point& p : corners(result.mesh, t))
      EXPECT_LT((result.mesh.triangle_patch[t] == PatchId(0) ? on_body : on_sting).nearest(p).distance, 0.005) << format_point(p);
  EXPECT_LT(result.report.max_deviation, 0.005);
}

TEST(UniteMeshes, LengthsGradeFromSmallBodyToLargeFace) {
  // Half-sunk rod: some vertices of the rod lie in the floor's plane, others 6e-18 beside the plane.
  const UnionResult result = unite({named(shifted(cube(1), {-0.5, -0.5, -1}), "floor"), named(cylinder(0.05, 0.5, 16, 8), "rod")});
  const UnionResult stands = unite({named(shifted(cube(1), {-0.9, -0.45, -0.55}), "floor"), named(cylinder(0.05, 0.5, 16, 8), "rod")});
  for (const UnionResult* r : {&result, &stands}) {
    EXPECT_EQ(r->report.after.n_slivers, 0);
    EXPECT_LT(r->mesh.n_triangles(), 4000u);
  }
}

/// Remeshed strips along coarse pipes lose 1 % of the volume within the permitted distance.
TEST(UniteMeshes, StripsThatChangeTheGeometryAreAWarning) {
  const TriMesh main_pipe = named(cylinder(0.2, 2.0, 48, 4), "main"),
                branch = named(shifted(turned(cylinder(0.12, 1.0, 48, 4), 1.57, 0.0), {1.0, 0, 0}), "branch");
  std::string warnings;
  const RunContext context({.threads = 1, .log = [&](LogLevel level, std::string_view line) {
                              if (level == LogLevel::warning) warnings += std::string(line) + "\n";
                            }});
  const auto volume_of = [&](const UnionOptions& options) {
    warnings.clear();
    return volume(unite_meshes({{"a", main_pipe}, {"b", branch}}, options, context).mesh);
  };
  const double exact = volume_of({.remesh = false});
  EXPECT_EQ(warnings, "");
  EXPECT_GT(std::abs(volume_of({}) / exact - 1.0), 1e-3);
  EXPECT_THAT(warnings, testing::AllOf(HasSubstr("changed the geometry: enclosed volume"), HasSubstr("0.01 local edge lengths"), HasSubstr("such as 0.001")));
  EXPECT_NEAR(volume_of({.deviation = 0.001}), exact, 1e-3 * exact);
  EXPECT_EQ(warnings, "");
}

TEST(UniteMeshes, HollowsAreDroppedUnlessTheyAreKept) {
  // Six plates around the cube [0, 1]^3.
  std::vector<TriMesh> plates;
  const double s = 0.2;
  for (std::size_t axis = 0; axis < 3; ++axis)
    for (const double side : {-s, 1.0}) {
      Vec3 size{1 + 2 * s, 1 + 2 * s, 1 + 2 * s}, corner{-s, -s, -s};
      size[axis] = s;
      corner[axis] = side;
      // Slightly different sizes: no two plates share a plane.
      const double e = 0.01 * static_cast<double>(plates.size() + 1);
      plates.push_back(shifted(stretched(cube(2), {size.x + e, size.y + e, size.z + e}), {corner.x - 0.4 * e, corner.y - 0.4 * e, corner.z - 0.4 * e}));
    }
  const UnionResult dropped = unite(plates), kept = unite(plates, {.keep_cavities = true});
  EXPECT_EQ(dropped.report.n_cavities, 1);
  EXPECT_EQ(dropped.report.n_components, 1);
  EXPECT_EQ(kept.report.n_components, 2);
  EXPECT_NEAR(volume(dropped.mesh) - volume(kept.mesh), 1.0, 0.2);
  EXPECT_THAT(dropped.report.messages, testing::Contains(HasSubstr("is removed: the outer flow does not reach it")));
}

TEST(UniteMeshes, EqualPatchNamesGetPartNames) {
  const UnionResult result = unite({named(cube(2), "wall"), named(shifted(cube(2), {0.5, 0.25, 0.3}), "wall")});
  ASSERT_EQ(result.mesh.patches.size(), 2u);
  EXPECT_EQ(result.mesh.patches.raw()[0].name, "a_wall");
  EXPECT_EQ(result.mesh.patches.raw()[1].name, "b_wall");
}

TEST(UniteMeshes, OpenOrCrossingPartsAreErrorsWithLocation) {
  TriMesh open = cube(2);
  open.triangles.raw().pop_back();
  open.triangle_patch.raw().pop_back();
  const ErrorInfo hole = union_error({sphere(2), open});
  EXPECT_EQ(hole.code, ErrorCode::open_surface);
  EXPECT_THAT(hole.attempted, HasSubstr("b is open: 3 edges"));
  EXPECT_EQ(hole.locations.size(), 3u);
  TriMesh pierced = sphere(4);
  pierced.points.raw()[0] = -1.5 * pierced.points.raw()[0];
  const ErrorInfo crossing = union_error({pierced, shifted(cube(1), {5, 0, 0})});
  EXPECT_EQ(crossing.code, ErrorCode::self_intersection);
  EXPECT_THAT(crossing.attempted, HasSubstr("a crosses itself"));
  EXPECT_FALSE(crossing.locations.empty());
  EXPECT_FALSE(crossing.hint.empty());
  EXPECT_EQ(union_error({}).code, ErrorCode::empty_surface);
}

TEST(UniteMeshes, ThreadsDoNotChangeTheResult) {
  const std::vector<TriMesh> bodies = {sphere(8), shifted(sphere(7), {0.7, 0.1, 0.2}), shifted(turned(cube(5), 0.2, 0.4), {-1.0, 0.3, 0.2})};
  const UnionResult first = unite(bodies, {}, 1);
  for (const int threads : {2, 7}) {
    const UnionResult other = unite(bodies, {}, threads);
    EXPECT_EQ(other.mesh.points, first.mesh.points);
    EXPECT_EQ(other.mesh.triangles, first.mesh.triangles);
    EXPECT_EQ(other.mesh.triangle_patch, first.mesh.triangle_patch);
    EXPECT_EQ(other.report.messages, first.report.messages);
  }
}

TEST(UniteMeshes, StopsWhenAsked) {
  std::stop_source stop;
  stop.request_stop();
  const RunContext context({.threads = 1, .stop = stop.get_token()});
  try {
    unite_meshes({{"a", cube(1)}, {"b", shifted(cube(1), {0.5, 0.5, 0.5})}}, {}, context);
    ADD_FAILURE() << "not stopped";
  } catch (const Error& error) {
    EXPECT_EQ(error.code(), ErrorCode::cancelled);
  }
}

}  // namespace
}  // namespace sterna::test
