// Disc outlines cut into walls: closed, in the plane, without slivers, patches preserved.
#include "volmesh/domain/cut_discs.h"

#include <gmock/gmock.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <numbers>

#include "geom/base/error.h"
#include "geom/math/measures.h"
#include "geom/mesh/topology.h"
#include "tests/support/test_constants.h"
#include "tests/volmesh/driver/revolved_bodies.h"
#include "volmesh/domain/farfield.h"

namespace sterna::volmesh {
namespace {

using testing::HasSubstr;

using test::k_context;

/// Walls and the farfield around them, which has no layers.
struct Cut {
  TriMesh before, after;
  DiscCuts cuts;
  Cut(const TriMesh& wall, const std::vector<ActuatorDisc>& discs) : before(wall) {
    append(before, farfield_sphere(wall, {.farfield_radius = 20.0}, k_context));
    after = before;
    Column<PatchId, std::uint8_t> has_layer;
    for (const Patch& patch : before.patches) has_layer.push_back(patch.kind == PatchKind::wall ? 1 : 0);
    cuts = cut_discs(after, has_layer, discs, k_context);
  }
};

double area_of(const TriMesh& mesh, PatchId patch) {
  double sum = 0.0;
  for (const TriangleId t : mesh.triangles.ids()) {
    const auto [a, b, c] = corners(mesh, t);
    if (mesh.triangle_patch[t] == patch) sum += triangle_area(a, b, c);
  }
  return sum;
}

/// Returns the smallest ratio of a triangle's height to its longest edge.
double flattest(const TriMesh& mesh) {
  double least = 1.0;
  for (const TriangleId t : mesh.triangles.ids()) {
    const auto [a, b, c] = corners(mesh, t);
    const double longest = std::max({distance(a, b), distance(b, c), distance(c, a)});
    least = std::min(least, 2.0 * triangle_area(a, b, c) / longest / longest);
  }
  return least;
}

TEST(CutDiscs, OutlineIsOneClosedPolygonInThePlane) {
  for (const double x : {-1.9, -1.37, -0.42, 0.0, 0.011, 0.77}) {
    SCOPED_TRACE(x);
    const Cut cut(hub(), {{.center = {x, 0, 0}, .radius = 1.0}});
    ASSERT_EQ(cut.cuts.discs.size(), 1u);
    const CutDisc& disc = cut.cuts.discs[0];
    EXPECT_TRUE(disc.has_outer_border);
    EXPECT_FALSE(disc.has_inner_border);
    EXPECT_EQ(Topology(cut.after, k_context).n_boundary_halfedges(), 0u);
    std::map<VertexId, VertexId> next;
    for (const auto& [from, to] : disc.outline) {
      EXPECT_TRUE(next.emplace(from, to).second);
      EXPECT_EQ(cut.after.points[from].x, x);
      EXPECT_NEAR(distance(cut.after.points[from], {x, 0, 0}), hub_radius(x), 0.02);
    }
    std::size_t n = 0;
    VertexId v = disc.outline[0][0];
    do {
      v = next.at(v);
      ++n;
    } while (v != disc.outline[0][0] && n <= disc.outline.size());
    EXPECT_EQ(n, disc.outline.size());
    // No triangle is flatter than a quarter of the flattest before, the area is preserved except for moved vertices, and the farfield is unchanged.
    EXPECT_GT(flattest(cut.after), 0.25 * flattest(cut.before));
    EXPECT_NEAR(area_of(cut.after, PatchId(0)), area_of(cut.before, PatchId(0)), 0.004 * area_of(cut.before, PatchId(0)));
    EXPECT_EQ(area_of(cut.after, PatchId(1)), area_of(cut.before, PatchId(1)));
    EXPECT_EQ(cut.after.patches, cut.before.patches);
    // Triangles are parts of their source triangles, in the same order.
    ASSERT_EQ(cut.cuts.sources.size(), cut.after.n_triangles());
    EXPECT_TRUE(std::ranges::is_sorted(cut.cuts.sources));
    for (const TriangleId t : cut.after.triangles.ids()) EXPECT_EQ(cut.after.triangle_patch[t], cut.before.triangle_patch[cut.cuts.sources[t]]);
  }
}

TEST(CutDiscs, RimsLieInFluidOrInsideBodies) {
  TriMesh wall = duct();
  append(wall, hub());
  const auto borders = [&](double inner, double outer) {
    const Cut cut(wall, {{.center = {0.1, 0, 0}, .radius = outer, .inner_radius = inner}});
    EXPECT_EQ(cut.cuts.discs.size(), 1u);
    return std::array{cut.cuts.discs.at(0).has_inner_border, cut.cuts.discs.at(0).has_outer_border};
  };
  EXPECT_EQ(borders(0.0, 1.5), (std::array{false, false}));
  EXPECT_EQ(borders(0.3, 1.5), (std::array{false, false}));
  EXPECT_EQ(borders(0.7, 1.5), (std::array{true, false}));
  EXPECT_EQ(borders(0.3, 1.0), (std::array{false, true}));
  EXPECT_EQ(borders(1.5, 2.5), (std::array{false, true}));
}

TEST(CutDiscs, FreeAndOversizedDiscsCutNothing) {
  for (const double radius : {0.7, 40.0}) {
    const Cut cut(hub(), {{.center = {radius == 0.7 ? -3.0 : 0.0, 0, 0}, .radius = radius}});
    EXPECT_TRUE(cut.cuts.discs.empty());
    EXPECT_TRUE(cut.cuts.sources.empty());
    EXPECT_EQ(cut.after.triangles, cut.before.triangles);
    EXPECT_EQ(cut.after.points, cut.before.points);
  }
}

/// Edges and corners of a cube keep their position.
TEST(CutDiscs, RidgesKeepTheirLine) {
  TriMesh wall = test::cube(6);
  const Cut cut(wall, {{.center = {0.5 + 0.03, 0.5, 0.5}, .radius = 1.0}});
  ASSERT_EQ(cut.cuts.discs.size(), 1u);
  EXPECT_NEAR(area_of(cut.after, PatchId(0)), 6.0, 1e-12);
  for (const auto& [from, to] : cut.cuts.discs[0].outline) {
    const Point& p = cut.after.points[from];
    EXPECT_EQ(std::max(std::abs(p.y - 0.5), std::abs(p.z - 0.5)), 0.5);
  }
}

ErrorInfo error_of(const TriMesh& wall, const std::vector<ActuatorDisc>& discs) {
  try {
    Cut(wall, discs);
  } catch (const Error& error) {
    return error.info();
  }
  return {.code = ErrorCode::internal, .attempted = "no error was thrown"};
}

TEST(CutDiscs, SaysWhereADiscCannotBe) {
  const ErrorInfo border = error_of(hub(), {{.name = "a", .center = {0, 0.45, 0}, .radius = 0.3}});
  EXPECT_EQ(border.code, ErrorCode::self_intersection);
  EXPECT_THAT(border.attempted, HasSubstr("\"a\""));
  ASSERT_FALSE(border.locations.empty());
  EXPECT_THAT(border.locations[0].what, HasSubstr("hub"));
  EXPECT_NEAR(border.locations[0].position.x, 0.0, 1e-12);
  // A disc in a face of a cube.
  const ErrorInfo flat = error_of(test::cube(4), {{.name = "b", .center = {1, 0.5, 0.5}, .radius = 2.0}});
  EXPECT_EQ(flat.code, ErrorCode::self_intersection);
  EXPECT_THAT(flat.locations.at(0).what, HasSubstr("lies in the plane of the disc"));
  EXPECT_THAT(flat.hint, HasSubstr("move the disc"));
  // Two discs through one polygon.
  const ErrorInfo both =
      error_of(hub(), {{.name = "c", .center = {0, 0, 0}, .radius = 1.0}, {.name = "d", .center = {0, 0, 0}, .axis = {1, 0.3, 0}, .radius = 1.0}});
  EXPECT_EQ(both.code, ErrorCode::self_intersection);
}

}  // namespace
}  // namespace sterna::volmesh
