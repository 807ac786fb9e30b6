#include "geom/mesh/half.h"

#include <gmock/gmock.h>

#include <cmath>
#include <tuple>

#include "geom/base/error.h"
#include "geom/math/measures.h"
#include "geom/mesh/topology.h"
#include "tests/support/test_constants.h"
#include "tests/support/test_shapes.h"

namespace sterna {
namespace {

using testing::HasSubstr;

using test::k_context;

TriMesh moved(TriMesh mesh, const Vec3& by) {
  for (Point& p : mesh.points) p += by;
  return mesh;
}

double area(const TriMesh& mesh) {
  double sum = 0.0;
  for (const TriangleId t : mesh.triangles.ids()) sum += std::apply(triangle_area, corners(mesh, t));
  return sum;
}

/// Returns the flux of the coordinate `axis` along itself. This is the volume, also of a half model cut in a plane where the coordinate is zero.
double volume(const TriMesh& mesh, std::size_t axis) {
  double sum = 0.0;
  for (const TriangleId t : mesh.triangles.ids()) {
    const auto [a, b, c] = corners(mesh, t);
    sum += area_vector(a, b, c)[axis] * (a[axis] + b[axis] + c[axis]) / 3.0;
  }
  return sum;
}

/// Checks the guarantees of the header for every half.
void expect_border(const TriMesh& half, std::size_t axis, double at) {
  const Topology topology(half, k_context);
  std::vector<int> balance(half.n_vertices(), 0), n_edges(half.n_vertices(), 0);
  EXPECT_GT(topology.n_boundary_halfedges(), 0u);
  for (std::size_t i = 0; i < topology.n_halfedges(); ++i) {
    const HalfedgeId h(i);
    if (!topology.is_boundary(h)) continue;
    EXPECT_EQ(half.points[topology.from(h)][axis], at);
    EXPECT_EQ(half.points[topology.to(h)][axis], at);
    ++balance[topology.from(h).index()];
    --balance[topology.to(h).index()];
    ++n_edges[topology.from(h).index()];
  }
  for (const VertexId v : half.points.ids()) {
    EXPECT_EQ(balance[v.index()], 0);
    EXPECT_EQ(n_edges[v.index()], half.points[v][axis] == at ? 1 : 0);
    EXPECT_FALSE(topology.outgoing(v).empty());
  }
  for (const TriangleId t : half.triangles.ids()) EXPECT_GT(std::apply(triangle_area, corners(half, t)), 0.0);
}

ErrorInfo error_of(const TriMesh& surface, const HalfOptions& options) {
  try {
    half_of(surface, options, k_context);
  } catch (const Error& error) {
    return error.info();
  }
  return {};
}

TEST(Half, OfACubeIsExact) {
  for (const int n : {1, 2, 3, 4})
    for (const char axis : {'x', 'y', 'z'})
      for (const char keep : {'+', '-'}) {
        const HalfOptions options{.axis = std::string(1, axis), .at = 0.5, .keep = std::string(1, keep), .snap = 0.0};
        const TriMesh half = half_of(test::cube(n), options, k_context);
        expect_border(half, static_cast<std::size_t>(axis - 'x'), 0.5);
        EXPECT_NEAR(area(half), 3.0, 1e-14);
      }
}

TEST(Half, ExactCutsHaveHalfTheAreaAndVolume) {
  const TriMesh sphere = test::sphere(12);
  for (const char axis : {'x', 'y', 'z'}) {
    const auto k = static_cast<std::size_t>(axis - 'x');
    for (const double at : {0.0, 0.1234, -0.61}) {
      double areas = 0.0, volumes = 0.0;
      for (const char keep : {'+', '-'}) {
        const TriMesh half = half_of(moved(sphere, at == 0.0 ? Vec3{} : Vec3{0.01, 0.02, 0.03}),
                                     {.axis = std::string(1, axis), .at = at, .keep = std::string(1, keep), .tolerance = 1e-15, .snap = 0.0}, k_context);
        expect_border(half, k, at);
        areas += area(half);
        Vec3 to_plane;
        to_plane[k] = -at;
        volumes += volume(moved(half, to_plane), k);
      }
      EXPECT_NEAR(areas, area(sphere), 1e-12);
      EXPECT_NEAR(volumes, volume(sphere, k), 1e-12);
    }
  }
}

TEST(Half, HasNoSliversBesideTheRim) {
  for (int i = 0; i < 40; ++i) {
    const double at = -0.5 + 0.025 * i + 1e-4 * i * i;
    const TriMesh half = half_of(test::sphere(10), {.at = at}, k_context);
    expect_border(half, 1, at);
    double flattest = 1e300;  // height over longest edge
    for (const TriangleId t : half.triangles.ids()) {
      const auto [a, b, c] = corners(half, t);
      const double longest = std::max({distance(a, b), distance(b, c), distance(c, a)});
      flattest = std::min(flattest, 2.0 * triangle_area(a, b, c) / (longest * longest));
    }
    EXPECT_GT(flattest, 0.05) << at;  // 0.1 of the shortest edge, less the effect of oblique cuts
  }
}

TEST(Half, TellsWhereTheOtherSideIsNoImage) {
  const auto warnings_of = [](const TriMesh& surface) {
    std::vector<std::string> warnings;
    half_of(surface, {}, RunContext({.threads = 2, .log = [&](LogLevel level, std::string_view text) {
                                       if (level == LogLevel::warning) warnings.emplace_back(text);
                                     }}));
    return warnings;
  };
  TriMesh body = test::sphere(12);
  EXPECT_THAT(warnings_of(body), testing::IsEmpty());
  EXPECT_THAT(warnings_of(moved(body, {0.0, 0.03, 0.0})), testing::SizeIs(1));  // cut off centre
  TriMesh dented = body;
  for (Point& p : dented.points)
    if (p.y < -0.8) p.y *= 0.9;
  EXPECT_THAT(warnings_of(dented), testing::ElementsAre(testing::AllOf(HasSubstr("is not the mirror image of the kept side"), HasSubstr("0.1 m"))));
  TriMesh rough = body;  // different triangulations of the two sides are no asymmetry
  for (std::size_t i = 0; i < rough.points.size(); ++i) {
    Point& p = rough.points[VertexId(i)];
    if (p.y > 0.1) p = normalized(p + Vec3{0.03 * std::sin(static_cast<double>(i)), 0.0, 0.03 * std::cos(static_cast<double>(7 * i))});
  }
  EXPECT_THAT(warnings_of(rough), testing::IsEmpty());
}

TEST(Half, OfAHalfIsTheSame) {
  const TriMesh half = half_of(moved(test::sphere(9), {0.0, 0.03, 0.0}), {}, k_context);
  TriMesh rough = half;
  for (std::size_t i = 0; i < rough.points.size(); ++i)
    if (Point& p = rough.points[VertexId(i)]; p.y == 0.0) p.y += 1e-7 * std::sin(static_cast<double>(i));
  for (const TriMesh& given : {half, rough}) {
    const TriMesh again = half_of(given, {}, k_context);
    EXPECT_EQ(again.points.raw(), half.points.raw());
    EXPECT_EQ(again.triangles.raw(), half.triangles.raw());
  }
  // A flat side that closes the half is left out.
  TriMesh box = half_of(test::cube(2), {}, k_context);
  expect_border(box, 1, 0.0);
  EXPECT_NEAR(area(box), 5.0, 1e-15);
}

TEST(Half, TwiceIsAQuarter) {
  for (const double shift : {0.0, 0.013, 0.21}) {
    const TriMesh half = half_of(moved(test::sphere(8), {0.0, shift, 0.7 * shift}), {}, k_context);
    const TriMesh quarter = half_of(half, {.axis = "z"}, k_context);
    const Topology topology(quarter, k_context);
    std::size_t n_corners = 0;
    for (std::size_t i = 0; i < topology.n_halfedges(); ++i) {
      if (!topology.is_boundary(HalfedgeId(i))) continue;
      const Point a = quarter.points[topology.from(HalfedgeId(i))], b = quarter.points[topology.to(HalfedgeId(i))];
      EXPECT_TRUE((a.y == 0.0 && b.y == 0.0) || (a.z == 0.0 && b.z == 0.0));
      n_corners += a.y == 0.0 && a.z == 0.0 ? 1 : 0;
    }
    EXPECT_EQ(n_corners, 2u);
  }
}

TEST(Half, KeepsTheOrderAndThePatches) {
  TriMesh two = moved(test::sphere(3), {0.0, 2.0, 0.0});
  append(two, test::cube(2));
  append(two, moved(test::sphere(2), {0.0, -2.0, 0.0}));
  two.patches[PatchId(0)].name = "upper";
  two.patches.push_back({"nothing", PatchKind::slip});
  const TriMesh half = half_of(two, {.at = 0.5}, k_context);
  ASSERT_EQ(half.patches.size(), 2u);
  EXPECT_EQ(half.patches[PatchId(0)].name, "upper");
  EXPECT_EQ(half.patches[PatchId(1)].name, "cube");
  EXPECT_EQ(half.triangles[TriangleId(0)], two.triangles[TriangleId(0)]);
  EXPECT_EQ(half.points[VertexId(5)], two.points[VertexId(5)]);
}

TEST(Half, SaysWhatIsWrong) {
  EXPECT_EQ(error_of({}, {}).code, ErrorCode::empty_surface);
  EXPECT_EQ(error_of(test::cube(1), {.axis = "w"}).code, ErrorCode::bad_argument);
  const ErrorInfo away = error_of(moved(test::cube(1), {0.0, 0.25, 0.0}), {});
  EXPECT_EQ(away.code, ErrorCode::bad_argument);
  EXPECT_THAT(away.problem, HasSubstr("does not reach the plane: its nearest vertex is 0.25"));
  EXPECT_THAT(error_of(moved(test::cube(1), {0.0, 0.25, 0.0}), {.keep = "-"}).problem, HasSubstr("no part of the surface"));
  TriMesh holed = test::cube(3);
  holed.triangles.raw().pop_back();
  holed.triangle_patch.raw().pop_back();
  for (const char keep : {'+', '-'}) {
    const ErrorInfo open = error_of(holed, {.axis = "z", .at = 0.31, .keep = std::string(1, keep)});
    if (open.code == ErrorCode::internal) continue;  // the hole is in the other half
    EXPECT_EQ(open.code, ErrorCode::open_surface);
    EXPECT_THAT(open.problem, HasSubstr("not closed in the plane:"));
    EXPECT_FALSE(open.locations.empty());
  }
  // The plane touches the cube in one corner only.
  TriMesh turned = test::cube(1);
  for (Point& p : turned.points) p = {p.x, p.x + 2.0 * p.y + 4.0 * p.z, p.z};
  append(turned, moved(test::cube(2), {5.0, -0.31, 0.0}));
  EXPECT_EQ(error_of(turned, {}).code, ErrorCode::non_manifold_surface);
}

}  // namespace
}  // namespace sterna
