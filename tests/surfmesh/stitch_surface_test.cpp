// Stitching of small hand-made shapes: repairs, orientation, names, determinism.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <numbers>
#include <random>

#include "tests/surfmesh/soups.h"

namespace sterna::test {
namespace {

using surfmesh::StitchOptions;
using testing::Contains;
using testing::HasSubstr;

TEST(Stitch, WeldsASoupToACube) {
  const auto [mesh, report] = stitch({soup_of(cube(2))});
  expect_stitched(mesh);
  EXPECT_EQ(mesh.n_triangles(), 48u);
  EXPECT_EQ(mesh.n_vertices(), 26u);
  EXPECT_DOUBLE_EQ(volume(mesh), 1.0);
  EXPECT_EQ(report.n_triangles_read, 48);
  EXPECT_EQ(report.n_vertices_read, 144);
  EXPECT_EQ(report.n_welded_exact, 144 - 26);
  EXPECT_EQ(report.n_flipped, 0);
  EXPECT_EQ(report.n_components, 1);
  EXPECT_TRUE(report.is_closed);
  EXPECT_EQ(mesh.patches.raw(), (std::vector<Patch>{{"wall", PatchKind::wall}}));
}

TEST(Stitch, MinusZeroIsZero) {
  SurfaceSoup soup = soup_of(cube());
  for (std::size_t i = 0; i < soup.points.size(); i += 2)
    for (std::size_t k = 0; k < 3; ++k)
      if (soup.points[i][k] == 0.0) soup.points[i][k] = -0.0;
  EXPECT_EQ(stitch({soup}).mesh.n_vertices(), 8u);
}

TEST(Stitch, VertexOrderAndFlippedSubsetsDoNotMatter) {
  const SurfaceSoup cube_soup = soup_of(cube());
  for (unsigned subset = 0; subset < 4096; subset += 7) {
    SurfaceSoup soup = cube_soup;
    for (unsigned t = 0; t < 12; ++t) {
      std::rotate(soup.triangles[t].begin(), soup.triangles[t].begin() + (subset + t) % 3, soup.triangles[t].end());
      if (subset >> t & 1u) std::swap(soup.triangles[t][0], soup.triangles[t][1]);
    }
    const auto [mesh, report] = stitch({soup});
    expect_stitched(mesh);
    EXPECT_DOUBLE_EQ(volume(mesh), 1.0);
    EXPECT_EQ(report.n_flipped, std::popcount(subset)) << "subset " << subset;
  }
}

TEST(Stitch, FluidInsideTurnsOnlyOuterShellInwards) {
  TriMesh room = cube(2);
  for (Point& p : room.points) p = 4.0 * (p - Point{0.5, 0.5, 0.5});
  const TriMesh body = sphere(4, 0.5);
  StitchOptions options;
  options.fluid = "inside";
  for (const bool is_turned : {false, true}) {
    const auto [mesh, report] = surfmesh::stitch_surface(
        {is_turned ? inside_out(soup_of(room)) : soup_of(room), is_turned ? inside_out(soup_of(body)) : soup_of(body)}, options, RunContext{});
    EXPECT_NEAR(volume(mesh), volume(body) - 64.0, 1e-12);
    EXPECT_EQ(report.n_components, 2);
  }
}

TEST(Stitch, FlippedSphereSubsetIsTurnedAndReported) {
  std::mt19937 random(5);
  SurfaceSoup soup = soup_of(sphere(6));
  std::int64_t n_turned = 0;
  for (auto& t : soup.triangles)
    if (random() % 5 == 0) {
      std::swap(t[0], t[2]);
      ++n_turned;
    }
  const auto [mesh, report] = stitch({soup});
  expect_stitched(mesh);
  EXPECT_EQ(report.n_flipped, n_turned);
  EXPECT_THAT(report.messages, Contains(HasSubstr("turned " + std::to_string(n_turned) + " facets with an orientation opposite")));
}

TEST(Stitch, InsideOutMirroredMovedAndScaled) {
  const TriMesh ball = sphere(5);
  const double v = volume(ball);
  {
    const auto [mesh, report] = stitch({inside_out(soup_of(ball))});
    expect_stitched(mesh);
    EXPECT_EQ(report.n_flipped, static_cast<std::int64_t>(ball.n_triangles()));
    EXPECT_THAT(report.messages, Contains(HasSubstr("1 component (500 facets) was inside out: orientation reversed")));
  }
  {
    SurfaceSoup mirrored = soup_of(ball);
    for (Vec3& p : mirrored.points) p.y = -p.y;
    const TriMesh mesh = stitch({mirrored}).mesh;
    expect_stitched(mesh);
    EXPECT_NEAR(volume(mesh), v, 1e-14);
  }
  {
    const TriMesh mesh = stitch({shifted(soup_of(ball), {1e3, -1e3, 1e3})}).mesh;
    expect_stitched(mesh);
    EXPECT_NEAR(volume(mesh), v, 1e-10);  // coordinates of 1e3 are rounded to 1e-13
  }
  for (const double unit : {1e-6, 1e-3, 0.0254, 0.3048, 1e6}) {
    const TriMesh mesh = stitch({soup_of(ball)}, {.unit = unit}).mesh;
    expect_stitched(mesh);
    EXPECT_NEAR(volume(mesh) / (unit * unit * unit), v, 1e-12);
    EXPECT_EQ(mesh.n_vertices(), ball.n_vertices());
  }
}

TEST(Stitch, ThreadsDoNotChangeTheResult) {
  std::vector<SurfaceSoup> soups;
  for (int i = 0; i < 3; ++i) soups.push_back(shifted(soup_of(sphere(20)), {3.0 * i, 0, 0}));
  soups[1] = inside_out(soups[1]);
  const auto first = stitch(soups, {.split_angle = 0.04}, 1);
  for (const int threads : {2, 7}) {
    const auto other = stitch(soups, {.split_angle = 0.04}, threads);
    EXPECT_EQ(other.mesh.points, first.mesh.points);
    EXPECT_EQ(other.mesh.triangles, first.mesh.triangles);
    EXPECT_EQ(other.mesh.triangle_patch, first.mesh.triangle_patch);
    EXPECT_EQ(other.mesh.patches, first.mesh.patches);
    EXPECT_EQ(other.report.messages, first.report.messages);
  }
}

TEST(Stitch, SeveralFilesBecomeOneSurface) {
  const SurfaceSoup whole = soup_of(cube(3));
  SurfaceSoup a = whole, b = whole;
  a.triangles.resize(30), a.patch.resize(30), a.source = "left half.stl.gz";
  b.triangles.erase(b.triangles.begin(), b.triangles.begin() + 30), b.patch.resize(b.triangles.size()), b.source = "/tmp/right.stl";
  const auto [mesh, report] = stitch({a, b});
  expect_stitched(mesh);
  EXPECT_EQ(report.n_components, 1);
  EXPECT_EQ(report.n_unused_vertices, static_cast<std::int64_t>(whole.points.size()));
  EXPECT_THAT(report.messages, Contains(HasSubstr("unused")));
  ASSERT_EQ(mesh.patches.size(), 2u);
  EXPECT_EQ(mesh.patches.raw()[0].name, "left_half");
  EXPECT_EQ(mesh.patches.raw()[1].name, "right");
  EXPECT_EQ(std::count(mesh.triangle_patch.begin(), mesh.triangle_patch.end(), PatchId(0)), 30);
  EXPECT_EQ(stitch_error({a}).code, ErrorCode::open_surface);
}

TEST(Stitch, DisjointAndNestedBodies) {
  const SurfaceSoup outer = soup_of(sphere(4, 2.0)), inner = soup_of(sphere(4, 1.0)), core = soup_of(sphere(4, 0.5));
  const double v = volume(sphere(4, 1.0));
  {
    const auto [mesh, report] = stitch({outer, shifted(inner, {5, 0, 0})});
    EXPECT_NEAR(volume(mesh), 9.0 * v, 1e-12);  // both bodies outward
    EXPECT_EQ(report.n_components, 2);
  }
  for (const bool inner_first : {false, true})
    for (const bool is_outer_turned : {false, true})
      for (const bool is_inner_turned : {false, true}) {
        SurfaceSoup o = is_outer_turned ? inside_out(outer) : outer, i = is_inner_turned ? inside_out(inner) : inner;
        const auto [mesh, report] = inner_first ? stitch({i, o}) : stitch({o, i});
        expect_stitched(mesh);
        EXPECT_NEAR(volume(mesh), 7.0 * v, 1e-12);  // a cavity, for either orientation in the file
        EXPECT_THAT(report.messages, Contains(HasSubstr("treated as a cavity")));
      }
  EXPECT_NEAR(volume(stitch({outer, core, inner}).mesh), 7.125 * v, 1e-12);  // a body in the cavity
}

TEST(Stitch, CopiesOfFacetsAreRemoved) {
  const SurfaceSoup soup = soup_of(cube(2));
  {
    SurfaceSoup twice = soup;
    for (const std::size_t t : {3u, 17u}) add_facet(twice, soup.points[3 * t], soup.points[3 * t + 2], soup.points[3 * t + 1]);
    add_facet(twice, soup.points[9], soup.points[10], soup.points[11]);  // facet 3 once more
    const auto [mesh, report] = stitch({twice});
    expect_stitched(mesh);
    EXPECT_EQ(mesh.n_triangles(), 48u);
    EXPECT_EQ(report.n_duplicate_removed, 3);
    EXPECT_THAT(report.messages, Contains("removed 3 copies of facets"));
  }
  {
    const auto [mesh, report] = stitch({joined(soup, inside_out(soup))});  // a surface with two sides
    expect_stitched(mesh);
    EXPECT_EQ(mesh.n_triangles(), 48u);
    EXPECT_EQ(report.n_duplicate_removed, 48);
  }
}

TEST(Stitch, DoubledMembraneAndFinWithoutThicknessAreRemoved) {
  // Two unit cubes that share a face; both write the face.
  const SurfaceSoup two = joined(soup_of(cube(2)), shifted(soup_of(cube(2)), {1, 0, 0}));
  const auto [mesh, report] = stitch({two});
  expect_stitched(mesh);
  EXPECT_NEAR(volume(mesh), 2.0, 1e-14);
  EXPECT_EQ(report.n_duplicate_removed, 16);
  EXPECT_THAT(report.messages, Contains(HasSubstr("8 facets of double-sided sheets without thickness")));
  // A fin of two facets on an edge of the cube.
  SurfaceSoup fin = soup_of(cube());
  add_facet(fin, {0, 0, 0}, {1, 0, 0}, {0.5, -1, -1});
  add_facet(fin, {0, 0, 0}, {0.5, -1, -1}, {1, 0, 0});
  const auto without = stitch({fin});
  expect_stitched(without.mesh);
  EXPECT_EQ(without.mesh.n_triangles(), 12u);
}

TEST(Stitch, FacetsWithRepeatedVertexAreRemoved) {
  SurfaceSoup soup = soup_of(cube());
  add_facet(soup, {0, 0, 0}, {0, 0, 0}, {1, 0, 0});
  add_facet(soup, {1, 1, 1}, {1, 1, 1}, {1, 1, 1});
  const auto [mesh, report] = stitch({soup});
  expect_stitched(mesh);
  EXPECT_EQ(report.n_degenerate_removed, 2);
  EXPECT_THAT(report.messages, Contains("removed 2 facets with a repeated vertex"));
}

/// Returns a cube whose edge (0,0,0)-(1,0,0) has `n` extra vertices on one side only; flat facets fill the gap, as a fan at the origin or as a strip.
SurfaceSoup cube_with_flat_facets(int n, bool as_fan) {
  SurfaceSoup soup;
  soup.patch_names = {""};
  soup.source = "flat.stl";
  const TriMesh body = cube();
  const Vec3 p{0, 0, 0}, q{1, 0, 0};
  std::vector<Vec3> chain{p};
  for (int i = 1; i <= n; ++i) chain.push_back({i / (n + 1.0), 0, 0});
  chain.push_back(q);
  bool is_split = false;
  for (const TriangleId t : body.triangles.ids()) {
    const auto c = corners(body, t);
    int k = 0;
    while (k < 3 && !(c[static_cast<std::size_t>(k)] == p && c[static_cast<std::size_t>((k + 1) % 3)] == q)) ++k;
    if (k == 3 || is_split) {
      add_facet(soup, c[0], c[1], c[2]);
      continue;
    }
    is_split = true;
    const Vec3 apex = c[static_cast<std::size_t>((k + 2) % 3)];
    for (std::size_t i = 0; i + 1 < chain.size(); ++i) add_facet(soup, chain[i], chain[i + 1], apex);
    // Between the chain p ... q and the straight edge q-p of the neighbour.
    if (as_fan) {
      for (std::size_t i = 1; i + 1 < chain.size(); ++i) add_facet(soup, chain[i + 1], chain[i], chain[0]);
    } else {
      std::size_t low = 0, high = chain.size() - 1;
      for (bool at_low = true; high - low > 1; at_low = !at_low) {
        if (at_low) add_facet(soup, chain[high], chain[low + 1], chain[low]), ++low;
        else add_facet(soup, chain[high], chain[high - 1], chain[low]), --high;
      }
    }
  }
  EXPECT_TRUE(is_split);
  return soup;
}

TEST(Stitch, FlatFacetsAreFlippedAway) {
  for (const bool as_fan : {true, false})
    for (const int n : {1, 2, 3, 7, 15})
      for (const double unit : {1.0, 1e-3}) {
        const SurfaceSoup soup = cube_with_flat_facets(n, as_fan);
        ASSERT_EQ(soup.triangles.size(), 12u + 2 * static_cast<unsigned>(n));
        const auto [mesh, report] = stitch({soup}, {.unit = unit});
        expect_stitched(mesh);
        EXPECT_EQ(report.n_degenerate_removed, n);
        EXPECT_EQ(mesh.n_triangles(), soup.triangles.size());
        EXPECT_NEAR(volume(mesh), unit * unit * unit, 1e-15);
        EXPECT_NEAR(area(mesh), 6.0 * unit * unit, 1e-14);
        EXPECT_THAT(report.messages, Contains(HasSubstr("of zero area")));
      }
}

TEST(Stitch, NearVerticesAreWeldedWhereThatCloses) {
  // Rounding noise of 1e-12 on a sphere: only the automatic tolerance closes the surface.
  std::mt19937 random(3);
  const auto noise = [&] { return 1e-12 * (static_cast<double>(random()) / 4294967296.0 - 0.5); };
  SurfaceSoup soup = soup_of(sphere(5));
  for (Vec3& p : soup.points) p += {noise(), noise(), noise()};
  const auto [mesh, report] = stitch({soup});
  expect_stitched(mesh);
  EXPECT_EQ(mesh.n_vertices(), sphere(5).n_vertices());
  EXPECT_EQ(report.n_welded_near, static_cast<std::int64_t>(soup.points.size() - mesh.n_vertices()));
  EXPECT_THAT(report.messages, Contains(HasSubstr("within 1.985e-09 m")));
  EXPECT_EQ(stitch_error({soup}, {.weld_tolerance = 0.0}).code, ErrorCode::open_surface);
}

TEST(Stitch, SinglePrecisionHasItsOwnTolerance) {
  // One ulp of a float on coordinates of about 1: above 1e-9, below 2.5e-7.
  SurfaceSoup soup = soup_of(sphere(4));
  for (std::size_t i = 0; i < soup.points.size(); ++i)
    for (std::size_t k = 0; k < 3; ++k) {
      const float x = static_cast<float>(soup.points[i][k]);
      soup.points[i][k] = i % 5 ? x : std::nextafter(x, 2.0f);
    }
  EXPECT_EQ(stitch_error({soup}).code, ErrorCode::open_surface);
  soup.single_precision = true;
  const auto [mesh, report] = stitch({soup});
  expect_stitched(mesh);
  EXPECT_EQ(mesh.n_vertices(), sphere(4).n_vertices());
  EXPECT_GT(report.n_welded_near, 0);
}

TEST(Stitch, SmallFeaturesSurviveAutomaticWelding) {
  // A closed body of 1 m and one of 1e-10 m: no vertex is welded while the surface is closed.
  const auto [mesh, report] = stitch({soup_of(cube()), shifted(soup_of(cube()), {2, 0, 0}), shifted(soup_of(cube()), {-1, 0, 0}, 1e-10)});
  EXPECT_EQ(mesh.n_vertices(), 24u);
  EXPECT_EQ(report.n_welded_near, 0);
}

/// Four facets of 5e-16 m^2 in total, like those left after cutting an airliner (afem_777 of the shared data): no engine could fill the region around them.
TEST(Stitch, LineThinClosedPartsAreDropped) {
  const Point a{22.4296329915802, -4.474867651151561, -1.4976376603496493}, b{22.531284837491143, -4.620135054854733, -1.4720450933317415},
      c{22.497628296598837, -4.572037568092529, -1.4805186952684144}, d{22.564713814461207, -4.667907337289712, -1.4636287844513693};
  SurfaceSoup soup = soup_of(cube(2));
  const std::size_t n = soup.triangles.size();
  for (const auto& t : {std::array{a, b, c}, std::array{a, d, b}, std::array{c, b, d}, std::array{a, c, d}}) add_facet(soup, t[0], t[1], t[2]);
  const auto [mesh, report] = stitch({soup});
  expect_stitched(mesh);
  EXPECT_EQ(mesh.n_triangles(), n);
  EXPECT_THAT(report.messages, Contains(HasSubstr("dropped 1 closed part without thickness (4 facets), the first at (22.4296, -4.47487, -1.49764)")));
}

TEST(Stitch, GivenToleranceIsInMetres) {
  SurfaceSoup soup = soup_of(cube(2));
  for (std::size_t i = 0; i < soup.points.size(); i += 3) soup.points[i].x += 1e-3;
  EXPECT_EQ(stitch_error({soup}, {.weld_tolerance = 0.5e-3}).code, ErrorCode::open_surface);
  EXPECT_EQ(stitch({soup}, {.weld_tolerance = 1.1e-3}).mesh.n_vertices(), 26u);
  EXPECT_EQ(stitch({soup}, {.unit = 1e-3, .weld_tolerance = 1.1e-6}).mesh.n_vertices(), 26u);
}

TEST(Stitch, PatchNamesAreCleanAndUnique) {
  SurfaceSoup a = soup_of(cube());
  a.has_names = true;
  a.patch_names = {"My wing (left)", "", "wall", "never used", "My_wing_left", "7 flap-1.a"};
  for (std::size_t t = 0; t < 12; ++t) a.patch[t] = std::array<std::uint32_t, 5>{0, 1, 2, 4, 5}[t % 5];
  SurfaceSoup b = shifted(a, {2, 0, 0});
  b.source = "b.stl";
  const auto names = [](const TriMesh& mesh) {
    std::vector<std::string> result;
    for (const Patch& patch : mesh.patches) result.push_back(patch.name);
    return result;
  };
  EXPECT_THAT(names(stitch({a}).mesh), testing::ElementsAre("My_wing_left", "wall", "wall_2", "My_wing_left_2", "7_flap-1.a"));
  const auto two = names(stitch({a, b}).mesh);
  EXPECT_EQ(two.size(), 10u);
  EXPECT_THAT(two, Contains("My_wing_left_3"));
  EXPECT_THAT(two, Contains("shape"));
  EXPECT_THAT(two, Contains("b"));
}

TEST(Stitch, SplitByAngle) {
  const double right = 0.5 * std::numbers::pi;
  const TriMesh six = stitch({soup_of(cube(3))}, {.split_angle = 0.9 * right}).mesh;
  expect_stitched(six);
  ASSERT_EQ(six.patches.size(), 6u);
  EXPECT_EQ(six.patches.raw()[0].name, "wall_1");
  EXPECT_EQ(six.patches.raw()[5].name, "wall_6");
  for (std::uint64_t p = 0; p < 6; ++p) EXPECT_EQ(std::count(six.triangle_patch.begin(), six.triangle_patch.end(), PatchId(p)), 18);
  EXPECT_EQ(stitch({soup_of(cube(3))}, {.split_angle = 1.1 * right}).mesh.patches.size(), 1u);
  EXPECT_EQ(stitch({soup_of(cube(3))}, {.split_angle = 1.1 * right}).mesh.patches.raw()[0].name, "wall");
}

TEST(Stitch, OpenSurfaceWhereAllowed) {
  SurfaceSoup soup = soup_of(cube(2));
  soup.triangles.resize(40), soup.patch.resize(40);
  const auto [mesh, report] = stitch({soup}, {.allow_open = true});
  EXPECT_FALSE(report.is_closed);
  EXPECT_EQ(mesh.n_triangles(), 40u);
  EXPECT_EQ(Topology(mesh, quiet()).n_boundary_halfedges(), 8u);
}

TEST(Stitch, StopIsObeyed) {
  std::stop_source stop;
  stop.request_stop();
  try {
    surfmesh::stitch_surface({soup_of(cube())}, {}, RunContext({.stop = stop.get_token()}));
    FAIL() << "not cancelled";
  } catch (const Error& error) {
    EXPECT_EQ(error.code(), ErrorCode::cancelled);
  }
}

TEST(StitchSurface, NamesKeepDigitsAndLettersOfAnyLanguage) {
  SurfaceSoup soup = soup_of(cube(1));
  soup.has_names = true;
  soup.source = "wall.stl";
  soup.patch_names = {"1",
                      "Fl\xc3\xbcgel",
                      "\xe7\xbf\xbc left",
                      "Fl\xfcgel \xe9",
                      "left wing",
                      "left_wing",
                      "a\xc2\xa0"
                      "b"};  // UTF-8, then Latin-1
  for (std::size_t t = 0; t < soup.triangles.size(); ++t) soup.patch[t] = static_cast<std::uint32_t>(t % soup.patch_names.size());
  const auto result = stitch({soup});
  std::vector<std::string> names;
  for (const Patch& patch : result.mesh.patches) names.push_back(patch.name);
  EXPECT_THAT(names, testing::ElementsAre("1", "Fl\xc3\xbcgel", "\xe7\xbf\xbc_left", "Fl\xc3\xbcgel_\xc3\xa9", "left_wing", "left_wing_2", "a_b"));
  EXPECT_THAT(result.report.messages, testing::Contains("the patch \"left wing\" of wall.stl was renamed to \"left_wing\""));
  EXPECT_THAT(result.report.messages, testing::Contains("the patch \"left_wing\" of wall.stl was renamed to \"left_wing_2\""));
  EXPECT_THAT(result.report.messages, testing::Not(testing::Contains(testing::HasSubstr("\"1\""))));
}

}  // namespace
}  // namespace sterna::test
