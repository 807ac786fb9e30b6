// Actuator discs: their triangles, their two sides, and the mesh around them.
#include "tests/support/error_of.h"
#include "volmesh/domain/disc_baffles.h"

#include <gmock/gmock.h>

#include <cmath>
#include <numbers>

#include "geom/base/error.h"
#include "geom/math/measures.h"
#include "geom/mesh/baffles.h"
#include "geom/mesh/check.h"
#include "geom/mesh/topology.h"
#include "tests/support/test_constants.h"
#include "tests/support/test_shapes.h"
#include "volmesh/domain/farfield.h"
#include "volmesh/improve/improve.h"
#include "volmesh/tetra/size_field.h"
#include "volmesh/tetra/tetra.h"

namespace sterna::volmesh {
namespace {

using testing::HasSubstr;

using test::k_context;
constexpr double k_growth = 1.3;

double area_of(const TriMesh& mesh) {
  double sum = 0.0;
  for (const TriangleId t : mesh.triangles.ids()) {
    const auto [a, b, c] = corners(mesh, t);
    sum += triangle_area(a, b, c);
  }
  return sum;
}

double smallest_angle(const TriMesh& mesh) {
  double least = 10.0;
  for (const TriangleId t : mesh.triangles.ids()) {
    const auto p = corners(mesh, t);
    for (std::size_t k = 0; k < 3; ++k) {
      const Vec3 u = p[(k + 1) % 3] - p[k], v = p[(k + 2) % 3] - p[k];
      least = std::min(least, std::acos(dot(u, v) / norm(u) / norm(v)));
    }
  }
  return least;
}

TEST(ActuatorDisc, TrianglesCoverDiscsAndRings) {
  for (const double inner : {0.0, 0.05, 0.5, 0.97}) {
    for (const double edge : {0.03, 0.1, 0.9}) {
      SCOPED_TRACE(testing::Message() << inner << " " << edge);
      const ActuatorDisc disc{.name = "prop", .center = {1, 2, 3}, .axis = {1, -2, 0.5}, .radius = 1.0, .inner_radius = inner, .edge = edge};
      const TriMesh mesh = triangulate_disc(disc, {}, k_growth, k_context);
      const Topology topology(mesh, k_context);
      EXPECT_EQ(mesh.patches[PatchId(0u)].kind, PatchKind::interface);
      const Vec3 n = normalized(disc.axis);
      for (const Point& p : mesh.points) {
        EXPECT_NEAR(dot(p - disc.center, n), 0.0, 1e-14);
        EXPECT_LE(distance(p, disc.center), 1.0 + 1e-14);
        EXPECT_GE(distance(p, disc.center), inner - 1e-14);
      }
      for (const TriangleId t : mesh.triangles.ids()) {
        const auto [a, b, c] = corners(mesh, t);
        EXPECT_LT(dot(area_vector(a, b, c), n), 0.0);
      }
      // Area of the polygons between inner and outer rim.
      const auto polygon = [&](double radius) {
        double border = 0.0;
        std::size_t sides = 0;
        for (std::size_t h = 0; h < topology.n_halfedges(); ++h) {
          const HalfedgeId half(h);
          if (!topology.is_boundary(half) || std::abs(distance(mesh.points[topology.from(half)], disc.center) - radius) > 1e-9) continue;
          ++sides;
        }
        border = static_cast<double>(sides);
        return sides == 0 ? 0.0 : 0.5 * border * radius * radius * std::sin(2.0 * std::numbers::pi / border);
      };
      EXPECT_NEAR(area_of(mesh), polygon(1.0) - polygon(inner), 1e-12);
      // No triangle has all corners on the rims.
      for (const TriangleVertices& v : mesh.triangles) {
        EXPECT_TRUE(std::ranges::any_of(v, [&](VertexId w) {
          return std::ranges::none_of(topology.outgoing(w), [&](HalfedgeId h) { return topology.is_boundary(h) || topology.is_boundary(previous(h)); });
        }));
      }
      if (edge < 0.5 && inner < 0.9) {
        EXPECT_GT(smallest_angle(mesh), 25.0 * std::numbers::pi / 180.0);
      }
    }
  }
}

TEST(ActuatorDisc, EdgesAreShorterTowardsWalls) {
  TriMesh hub = test::sphere(24);
  for (Point& p : hub.points) p *= 0.3;
  const ActuatorDisc disc{.center = {0, 0, 0}, .radius = 2.0, .inner_radius = 0.35, .edge = 0.4};
  const TriMesh mesh = triangulate_disc(disc, hub, k_growth, k_context);
  double inner = 0.0, outer = 0.0;
  for (const TriangleId t : mesh.triangles.ids()) {
    const auto p = corners(mesh, t);
    for (std::size_t k = 0; k < 3; ++k) {
      const double r = std::max(norm(p[k]), norm(p[(k + 1) % 3])), length = distance(p[k], p[(k + 1) % 3]);
      if (r < 0.36) inner = std::max(inner, length);
      outer = std::max(outer, length);
    }
  }
  EXPECT_LT(inner, 0.05);
  EXPECT_GT(outer, 0.25);
}

/// Fills body, farfield and discs, and checks the mesh.
CheckReport mesh_of(const TriMesh& wall, const std::vector<ActuatorDisc>& discs, const std::string& engine, HybridMesh& mesh) {
  TriMesh boundary = wall;
  append(boundary, farfield_sphere(wall, {.farfield_radius = 20.0}, k_context));
  boundary = with_second_sides(with_discs(boundary, {}, discs, k_growth, k_context), discs);
  std::vector<Vec3> points(boundary.points.begin(), boundary.points.end());
  std::vector<std::array<std::uint32_t, 3>> triangles;
  for (const TriangleVertices& v : boundary.triangles) triangles.push_back({v[0].value(), v[1].value(), v[2].value()});
  const std::vector<Point> holes = find_cavity_points(wall, k_context);
  const TetraBoundary domain{.points = points, .triangles = triangles, .hole_points = holes, .traits = {.has_baffles = !discs.empty()}};
  const SizeField sizes = build_size_field(domain, {}, {}, k_context);
  TetraResult tets = fill(domain, &sizes, {.engine = engine, .try_other_engine = false}, k_context);
  EXPECT_EQ(tets.engine, engine);
  improve_tetrahedra(domain, tets, {}, k_context);
  points.insert(points.end(), tets.new_points.begin(), tets.new_points.end());
  mesh = {};
  mesh.points = Column<NodeId, Point>(points);
  mesh.patches = boundary.patches;
  for (const TriangleId t : boundary.triangles.ids()) {
    const TriangleVertices& v = boundary.triangles[t];
    mesh.boundary_triangles.push_back({{NodeId(v[0].value()), NodeId(v[2].value()), NodeId(v[1].value())}, boundary.triangle_patch[t]});
  }
  for (const auto& t : tets.tetrahedra) mesh.tetrahedra.push_back({NodeId(t[0]), NodeId(t[1]), NodeId(t[2]), NodeId(t[3])});
  return check(mesh, {}, k_context);
}

TEST(ActuatorDisc, DiscsInFluidAreValidWithBothEngines) {
  const std::vector<ActuatorDisc> discs = {{.name = "prop", .center = {-1.6, 0, 0}, .radius = 1.2, .edge = 0.25},
                                           {.name = "fan", .center = {0.1, 0, 0}, .axis = {1, 0.1, 0}, .radius = 2.0, .inner_radius = 1.15, .edge = 0.3}};
  for (const char* engine : {"tetgen", "hxt"}) {
    SCOPED_TRACE(engine);
    HybridMesh mesh, without;
    const CheckReport report = mesh_of(test::sphere(8), discs, engine, mesh);
    EXPECT_TRUE(report.is_valid()) << to_text(report);
    EXPECT_TRUE(report.intersections_checked);
    const CheckReport of_plain = mesh_of(test::sphere(8), {}, engine, without);
    EXPECT_NEAR(report.total_volume, of_plain.total_volume, 1e-11 * of_plain.total_volume);
    // Both sides exist, face on face, and share only the nodes of the rims.
    const BaffleSides sides = find_baffle_sides(mesh);
    ASSERT_FALSE(sides.empty());
    std::size_t n_first = 0, n_second = 0, n_single = 0;
    for (std::size_t i = 0; i < mesh.boundary_triangles.size(); ++i) {
      const Patch& patch = mesh.patches[mesh.boundary_triangles[i].patch];
      if (patch.kind != PatchKind::interface) continue;
      n_single += !sides.is_baffle(i);
      (sides.is_second(i) ? n_second : n_first) += 1;
      EXPECT_EQ(sides.is_second(i), patch.name.ends_with(".back"));
    }
    EXPECT_GT(n_first, 100u);
    EXPECT_EQ(n_first, n_second);
    EXPECT_EQ(n_single, 0u);
  }
}

TEST(ActuatorDisc, NoFluxGetsThroughASheet) {
  // No tetrahedron has nodes of both sides: the only path between the sides is around the rim.
  HybridMesh mesh;
  mesh_of(test::sphere(6), {{.center = {2, 0, 0}, .radius = 1.0, .edge = 0.2}}, "hxt", mesh);
  const BaffleSides sides = find_baffle_sides(mesh);
  std::vector<int> side(mesh.points.size(), 0);
  for (std::size_t node = 0; node < sides.twin.size(); ++node)
    if (sides.twin[node] != node) {
      side[node] = 2;
      side[sides.twin[node]] = 1;
    }
  for (const auto& tet : mesh.tetrahedra) {
    int seen = 0;
    double upstream = 0.0;
    for (const NodeId n : tet) {
      seen |= side[n.index()];
      if (side[n.index()] == 0) upstream += 2.0 - mesh.points[n].x;
    }
    ASSERT_NE(seen, 3);
    if (seen == 1) {
      EXPECT_GT(upstream, -1e-9);
    }
    if (seen == 2) {
      EXPECT_LT(upstream, 1e-9);
    }
  }
}

TEST(ActuatorDisc, SaysWhatIsWrongAndWhere) {
  const TriMesh wall = test::sphere(6);
  const auto add = [&](std::vector<ActuatorDisc> discs) { return test::error_info_of([&] { with_discs(wall, {}, discs, k_growth, k_context); }); };
  const ErrorInfo touching = add({{.name = "prop", .center = {0, 0, 0}, .radius = 2.0, .inner_radius = 0.9}});
  EXPECT_EQ(touching.code, ErrorCode::self_intersection);
  EXPECT_THAT(touching.attempted, HasSubstr("prop"));
  EXPECT_THAT(touching.hint, HasSubstr("leave a gap"));
  ASSERT_FALSE(touching.locations.empty());
  EXPECT_NEAR(touching.locations[0].position.x, 0.0, 1e-9);
  EXPECT_EQ(add({{.name = "a", .center = {3, 0, 0}, .radius = 1.0}, {.name = "b", .center = {3, 0, 0}, .axis = {0, 1, 0}, .radius = 1.0}}).code,
            ErrorCode::self_intersection);
  EXPECT_THAT(add({{.name = "a", .center = {3, 0, 0}, .radius = 1.0}, {.name = "a", .center = {5, 0, 0}, .radius = 1.0}}).problem, HasSubstr("already"));
  EXPECT_THAT(add({{.center = {3, 0, 0}, .radius = -1.0}}).problem, HasSubstr("radius"));
  EXPECT_THAT(add({{.center = {3, 0, 0}, .radius = 1.0, .inner_radius = 1.0}}).problem, HasSubstr("inner radius"));
  EXPECT_THAT(add({{.center = {3, 0, 0}, .axis = {0, 0, 0}, .radius = 1.0}}).problem, HasSubstr("axis"));
}

TEST(ActuatorDisc, OneSidedTakesTheSecondSidesAway) {
  const TriMesh wall = test::sphere(6);
  const std::vector<ActuatorDisc> discs = {{.center = {3, 0, 0}, .radius = 1.0}};
  const TriMesh both = with_second_sides(with_discs(wall, {}, discs, k_growth, k_context), discs);
  EXPECT_FALSE(find_baffle_sides(both).empty());
  EXPECT_EQ(Topology(both, k_context).n_boundary_halfedges(), 0u);
  const TriMesh one = one_sided(both);
  EXPECT_TRUE(find_baffle_sides(one).empty());
  EXPECT_EQ(2 * (one.n_triangles() - wall.n_triangles()), both.n_triangles() - wall.n_triangles());
  for (const TriangleId t : one.triangles.ids()) EXPECT_EQ(one.triangles[t], both.triangles[t]);
}

}  // namespace
}  // namespace sterna::volmesh
