// Surfaces that must be refused: code, number of locations, coordinates, wording, geometry.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "tests/surfmesh/soups.h"

namespace sterna::test {
namespace {

using testing::HasSubstr;

SurfaceSoup without_facet(SurfaceSoup soup, std::size_t t) {
  soup.triangles.erase(soup.triangles.begin() + static_cast<std::ptrdiff_t>(t));
  soup.patch.pop_back();
  return soup;
}

TEST(StitchErrors, Empty) {
  EXPECT_EQ(stitch_error({}).code, ErrorCode::empty_surface);
  EXPECT_EQ(stitch_error({SurfaceSoup{.source = "nothing.stl"}}).code, ErrorCode::empty_surface);
  SurfaceSoup point;
  point.patch_names = {""};
  point.source = "point.stl";
  add_facet(point, {1, 1, 1}, {1, 1, 1}, {2, 2, 2});
  const ErrorInfo info = stitch_error({point});
  EXPECT_EQ(info.code, ErrorCode::empty_surface);
  EXPECT_THAT(info.attempted, HasSubstr("point.stl"));
  EXPECT_THAT(info.attempted, HasSubstr("all 1 are degenerate"));
}

TEST(StitchErrors, BadNumbers) {
  SurfaceSoup soup = soup_of(cube());
  soup.triangles[4][1] = 36;
  ErrorInfo info = stitch_error({soup});
  EXPECT_EQ(info.code, ErrorCode::file_malformed);
  EXPECT_THAT(info.attempted, HasSubstr("facet 5 refers to vertex 36 of 36"));
  soup = soup_of(cube());
  soup.points[7].y = std::nan("");
  info = stitch_error({soup});
  EXPECT_EQ(info.code, ErrorCode::file_malformed);
  EXPECT_THAT(info.attempted, HasSubstr("facet 3 has a coordinate that is not a finite number"));
}

TEST(StitchErrors, ToleranceAboveTheLimit) {
  const ErrorInfo info = stitch_error({soup_of(cube(2))}, {.unit = 0.001, .weld_tolerance = 0.5});
  EXPECT_EQ(info.code, ErrorCode::bad_argument);
  EXPECT_THAT(info.attempted, HasSubstr("weld_tolerance is 0.5 m, more than 2 % of the body length of 0.001 m"));
}

TEST(StitchErrors, OneFacetMissing) {
  const ErrorInfo info = stitch_error({without_facet(soup_of(cube(2)), 20)}, {.unit = 0.001});
  EXPECT_EQ(info.code, ErrorCode::open_surface);
  EXPECT_EQ(info.n_locations, 3);
  ASSERT_EQ(info.locations.size(), 3u);
  for (const ErrorLocation& location : info.locations) EXPECT_LE(norm(location.position), 0.001 * std::sqrt(3.0)) << "coordinates are metres";
  EXPECT_EQ(info.geometry.edges.size(), 3u);
  EXPECT_THAT(info.attempted, HasSubstr("open along 3 edges around 1 hole"));
  EXPECT_THAT(info.attempted, HasSubstr("joining shape.stl to one surface"));
  EXPECT_THAT(info.hint, HasSubstr("fill the holes"));
}

TEST(StitchErrors, NearMatchingBoundaryIsHinted) {
  SurfaceSoup soup = soup_of(cube(2));
  SurfaceSoup a = soup, b = soup;
  a.triangles.resize(24), a.patch.resize(24);
  b.triangles.erase(b.triangles.begin(), b.triangles.begin() + 24), b.patch.resize(24);
  const ErrorInfo info = stitch_error({a, shifted(b, {0, 0, 0.01})});
  EXPECT_EQ(info.code, ErrorCode::open_surface);
  EXPECT_THAT(info.hint, HasSubstr("weld_tolerance = 0.0101"));
  EXPECT_THAT(info.hint, HasSubstr("all of these edges"));
  EXPECT_NO_THROW(stitch({a, shifted(b, {0, 0, 0.01})}, {.weld_tolerance = 0.0101}));
}

TEST(StitchErrors, ThreeFacetsAtAnEdge) {
  SurfaceSoup soup = soup_of(cube());
  add_facet(soup, {0, 0, 0}, {1, 0, 0}, {0.5, -1, -1});
  const ErrorInfo info = stitch_error({soup});
  EXPECT_EQ(info.code, ErrorCode::non_manifold_surface);
  EXPECT_EQ(info.n_locations, 1);
  EXPECT_EQ(info.locations.at(0).position, (Vec3{0.5, 0, 0}));
  EXPECT_THAT(info.locations.at(0).what, HasSubstr("edge of 3 facets"));
  EXPECT_THAT(info.attempted, HasSubstr("1 edge has more than two facets; in addition 2 boundary edges"));
  EXPECT_EQ(info.geometry.edges.size(), 1u);
  EXPECT_EQ(info.geometry.triangles.size(), 3u);
}

TEST(StitchErrors, CubesThatShareAnEdge) {
  const ErrorInfo info = stitch_error({soup_of(cube()), shifted(soup_of(cube()), {1, 1, 0})});
  EXPECT_EQ(info.code, ErrorCode::non_manifold_surface);
  EXPECT_EQ(info.n_locations, 1);
  EXPECT_EQ(info.locations.at(0).position, (Vec3{1, 1, 0.5}));
}

TEST(StitchErrors, CubesThatTouchInAVertexCross) {
  // Each is a closed body of its own and no single vertex is faulty, but the bodies touch.
  const ErrorInfo info = stitch_error({soup_of(cube()), shifted(soup_of(cube()), {1, 1, 1})});
  EXPECT_EQ(info.code, ErrorCode::self_intersection);
  EXPECT_THAT(info.attempted, HasSubstr("all between different bodies"));
  EXPECT_THAT(info.hint, HasSubstr("sterna union"));
}

TEST(StitchErrors, VertexWithTwoFans) {
  // A cube with its corner (1,1,1) moved to (0,0,0) from inside: two triangle fans of one component meet there.
  SurfaceSoup soup = soup_of(cube(2));
  for (Vec3& p : soup.points)
    if (p == Vec3{0.5, 0.5, 1.0}) p = {0.5, 0.5, 0.0};
  const ErrorInfo info = stitch_error({soup});
  EXPECT_EQ(info.code, ErrorCode::non_manifold_surface);
  EXPECT_EQ(info.n_locations, 1);
  EXPECT_EQ(info.locations.at(0).position, (Vec3{0.5, 0.5, 0}));
  EXPECT_THAT(info.attempted, HasSubstr("1 vertex joins several fans"));
  EXPECT_EQ(info.geometry.vertices.size(), 1u);
}

TEST(StitchErrors, MoebiusStrip) {
  SurfaceSoup soup;
  soup.patch_names = {""};
  soup.source = "strip.stl";
  const int n = 24;
  const auto at = [&](int i, double side) {
    // After one turn the two sides have changed positions, exactly.
    if (i == n) {
      i = 0;
      side = -side;
    }
    const double u = 2.0 * std::acos(-1.0) * i / n, r = 2.0 + side * std::cos(0.5 * u);
    return Vec3{r * std::cos(u), r * std::sin(u), side * std::sin(0.5 * u)};
  };
  for (int i = 0; i < n; ++i) {
    add_facet(soup, at(i, -0.5), at(i + 1, -0.5), at(i + 1, 0.5));
    add_facet(soup, at(i, -0.5), at(i + 1, 0.5), at(i, 0.5));
  }
  EXPECT_EQ(stitch_error({soup}).code, ErrorCode::open_surface);
  EXPECT_THAT(stitch_error({soup}).attempted, HasSubstr("in addition 1 component without a consistent orientation"));
  const ErrorInfo info = stitch_error({soup}, {.allow_open = true});
  EXPECT_EQ(info.code, ErrorCode::not_orientable);
  EXPECT_EQ(info.n_locations, 1);
  EXPECT_THAT(info.attempted, HasSubstr("Moebius"));
}

TEST(StitchErrors, CrossingBodies) {
  const std::vector<SurfaceSoup> soups = {soup_of(sphere(3)), shifted(soup_of(sphere(3)), {0.9, 0.1, 0.2})};
  const ErrorInfo info = stitch_error(soups);
  EXPECT_EQ(info.code, ErrorCode::self_intersection);
  EXPECT_GT(info.n_locations, 10);
  EXPECT_GT(info.locations.size(), 1u);
  EXPECT_LE(info.locations.size(), 10u);
  EXPECT_FALSE(info.geometry.triangles.empty());
  EXPECT_THAT(info.attempted, HasSubstr("pairs of facets cross or touch, all between different bodies"));
  EXPECT_THAT(info.attempted, HasSubstr(" of shape.stl and facet "));
  EXPECT_NO_THROW(stitch(soups, {.check_intersections = false}));
}

TEST(StitchErrors, FlatFacetThatCannotBeFlipped) {
  // A pocket of two facets (p, q, r) and its far neighbour whose apex is joined to r already: the edge r-d exists.
  SurfaceSoup soup;
  soup.patch_names = {""};
  soup.source = "pocket.stl";
  const Vec3 p{0, 0, 0}, q{2, 0, 0}, r{1, 0, 0}, d{1, 1, 0};
  // Closing facets: flat (p, r, q), and the triangle (p, q, d) twice: once whole, once split at r.
  add_facet(soup, p, q, r);
  add_facet(soup, q, p, d);
  add_facet(soup, p, r, d);
  add_facet(soup, r, q, d);
  const ErrorInfo info = stitch_error({soup});
  EXPECT_EQ(info.code, ErrorCode::self_intersection);
  EXPECT_THAT(info.attempted, HasSubstr("1 facet has no area"));
}

}  // namespace
}  // namespace sterna::test
