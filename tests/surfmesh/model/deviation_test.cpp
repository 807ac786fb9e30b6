// Distances and angles against models with known values; a displaced node and a rotated facet are located correctly.
#include "surfmesh/model/deviation.h"

#include <gmock/gmock.h>

#include <cmath>
#include <numbers>
#include <random>

#include "geom/model/components.h"
#include "geom/model/shapes.h"
#include "io/file/cad_file.h"
#include "tests/support/data.h"
#include "tests/support/model_meshes.h"
#include "tests/support/test_constants.h"
#include "tests/surfmesh/model/edges_of.h"

namespace sterna::surfmesh {
namespace {

using testing::AllOf;
using testing::HasSubstr;

using test::edges_of;
using test::k_context;
using test::k_degree;

struct Made {
  Model model;
  SurfaceMesh surface;
  ModelWall wall;
  Made(Model of, const SurfaceMeshOptions& options) : model(std::move(of)), surface(mesh_model(model, options, {}, k_context)), wall(model, surface) {}
  Deviation measure(const TriMesh& mesh, const RunContext& context = k_context) const { return measure_deviation(mesh, surface.mesh, wall, {}, context); }
};

/// Returns one triangle about a point, on the first patch of the mesh.
TriMesh triangle(const TriMesh& like, const std::array<Point, 3>& points) {
  TriMesh mesh;
  for (const Point& p : points) mesh.points.push_back(p);
  mesh.triangles.push_back({VertexId(0u), VertexId(1u), VertexId(2u)});
  mesh.triangle_patch.push_back(PatchId(0u));
  mesh.patches = like.patches;
  return mesh;
}

TEST(Deviation, BallHasZeroDistanceAndExpectedNormalAngle) {
  const Made ball(test::make_ball(2.0), edges_of(1.0, 12.0 * k_degree));
  const Deviation d = ball.measure(ball.surface.mesh);
  EXPECT_EQ(d.n_nodes, static_cast<std::int64_t>(ball.surface.mesh.n_vertices()));
  EXPECT_EQ(d.n_facets, static_cast<std::int64_t>(ball.surface.mesh.n_triangles()));
  EXPECT_EQ(d.n_without, 0);  // no centroid is at a pole, and normals exist beside the poles
  EXPECT_LE(d.distance.worst, 1e-14);
  EXPECT_EQ(d.distance.state, GateState::pass);
  EXPECT_EQ(d.normal.state, GateState::pass);
  // A facet is parallel to the sphere at its circumcentre; the centroid differs from the circumcentre by less than an edge of 12 degrees.
  double exact = 0.0;
  for (const TriangleId t : ball.surface.mesh.triangles.ids()) {
    const auto p = corners(ball.surface.mesh, t);
    exact = std::max(exact, angle_between(cross(p[1] - p[0], p[2] - p[0]), p[0] + p[1] + p[2]));
  }
  EXPECT_NEAR(d.normal.worst, exact, 1e-7);
}

TEST(Deviation, MovedNodeAndTurnedFacetAreMeasured) {
  const Made ball(test::make_ball(2.0), edges_of(1.0, 12.0 * k_degree));
  for (const double off : {1e-5, 1e-3, -0.05}) {
    SCOPED_TRACE(off);
    TriMesh moved = ball.surface.mesh;
    const VertexId v(static_cast<std::uint64_t>(moved.n_vertices() / 3));
    moved.points[v] = (1.0 + off / 2.0) * moved.points[v];
    const Deviation d = ball.measure(moved);
    EXPECT_NEAR(d.distance.worst * d.length, std::abs(off), 1e-12);
    EXPECT_EQ(d.distance.state, GateState::fail);
    EXPECT_EQ(d.distance.n_beyond_hard, 1);
    ASSERT_EQ(d.distance.locations.size(), 1u);
    EXPECT_EQ(d.distance.locations[0].position, moved.points[v]);
    EXPECT_THAT(d.distance.locations[0].what,
                AllOf(HasSubstr("node " + std::to_string(v.value()) + ", patch ball"), HasSubstr("m off face \"ball\" of the model")));
  }
  TriMesh turned = ball.surface.mesh;
  const TriangleId t(static_cast<std::uint64_t>(turned.n_triangles() / 2));
  std::swap(turned.triangles[t][0], turned.triangles[t][1]);
  const Deviation d = ball.measure(turned);
  EXPECT_EQ(d.distance.state, GateState::pass);
  EXPECT_EQ(d.normal.n_beyond_hard, 1);
  EXPECT_GT(d.normal.worst, 170 * k_degree);
  EXPECT_THAT(d.normal.locations[0].what, HasSubstr("triangle " + std::to_string(t.value()) + ", patch ball"));
}

TEST(Deviation, FacesEndAtTheirBorders) {
  // Beyond an edge of the box the planes continue, but the faces do not.
  const Made box(make_box("box", {0, 0, 0}, {1, 1, 1}), edges_of(0.3, 0.2));
  const double e = 1e-4;
  const auto off = [&](const Point& p) { return box.measure(triangle(box.surface.mesh, {p, p, p})).distance.worst; };
  EXPECT_NEAR(off({1 + e, 0.37, 1 + e}), std::sqrt(2.0) * e, 1e-14);
  EXPECT_NEAR(off({1 + e, 1 + e, 1 + e}), std::sqrt(3.0) * e, 1e-14);
  EXPECT_NEAR(off({0.4, 0.37, 1 + e}), e, 1e-14);
  EXPECT_NEAR(off({0.4, 0.37, 1 - 0.2}), 0.2, 1e-14);
}

TEST(Deviation, PointsAroundCylinderMatchFormula) {
  const Made can(make_cylinder("can", {0, 0, 0}, {2, 0, 0}, 1.0), edges_of(0.5, 0.5));
  const auto exact = [](const Point& p) {
    const double r = std::hypot(p.y, p.z), outside = std::hypot(std::max(r - 1.0, 0.0), std::max({-p.x, p.x - 2.0, 0.0}));
    return outside > 0.0 ? outside : std::min({1.0 - r, p.x, 2.0 - p.x});
  };
  std::mt19937 random(7);
  std::uniform_real_distribution<double> any(-1.0, 1.0), small(-8.0, -1.0);
  for (int i = 0; i < 300; ++i) {
    // Points near the surface, mainly near its edges, at distances of 1e-8 to 0.1.
    const double angle = std::numbers::pi * any(random), scale = std::pow(10.0, small(random));
    const double r = (i % 3 == 0 ? std::abs(any(random)) : 1.0) + scale * any(random),
                 x = (i % 2 == 0 ? 2.0 : 2.0 * std::abs(any(random))) + scale * any(random);
    const Point p{x, r * std::cos(angle), r * std::sin(angle)};
    EXPECT_NEAR(can.measure(triangle(can.surface.mesh, {p, p, p})).distance.worst * 2.0, exact(p), 1e-11) << x << " " << r;
  }
}

TEST(Deviation, SharpTrailingEdgesCompareEachSideWithItself) {
  // NACA 0006 with a modified last coefficient, so that both sides end in one point.
  const auto half_thickness = [](double x) { return 0.3 * (0.2969 * std::sqrt(x) - x * (0.1260 + x * (0.3516 - x * (0.2843 - x * 0.1036)))); };
  Wing wing{.name = "wing", .is_symmetric = true, .is_cubic = true};
  for (const double y : {3.0, 1.5, 0.0}) {
    WingSection section{.name = "y", .leading_edge = {0.4 * y, y, 0.0}, .chord = 1.0};
    for (int i = 0; i <= 120; ++i) {
      const double x = 0.5 + 0.5 * std::cos(2.0 * std::numbers::pi * i / 120);
      section.points.push_back({x, (i <= 60 ? 1.0 : -1.0) * (i % 120 == 0 ? 0.0 : half_thickness(x))});
    }
    wing.sections.push_back(section);
  }
  wing.right_tip = wing.left_tip = {CapShape::strip, 1.0};
  const Made made(make_wing(wing), {});
  const Deviation d = made.measure(made.surface.mesh);
  EXPECT_LE(d.distance.worst, 1e-14);
  // The other side would be 170 degrees off. The largest angles belong to the strips that close the tips: at their sharp ends the model turns within less than
  // the shortest edge.
  EXPECT_LT(d.normal.worst, 45 * k_degree);
  EXPECT_GT(d.normal.share_within, 0.998);  // 0.9988 here: the strips
  for (const GateLocation& location : d.normal.locations) EXPECT_GT(std::abs(location.position.y), 3.0) << location.what;
  // The result is the same for any number of threads.
  for (const int threads : {2, 7}) {
    const Deviation other = made.measure(made.surface.mesh, RunContext({.threads = threads}));
    EXPECT_EQ(other.distance.worst, d.distance.worst);
    EXPECT_EQ(other.normal.worst, d.normal.worst);
    EXPECT_EQ(other.normal.share_within, d.normal.share_within);
    ASSERT_EQ(other.normal.locations.size(), d.normal.locations.size());
    for (std::size_t i = 0; i < d.normal.locations.size(); ++i) EXPECT_EQ(other.normal.locations[i].what, d.normal.locations[i].what);
  }
}

TEST(Deviation, PatchesWithOtherNamesAreTold) {
  const Made ball(test::make_ball(1.0), edges_of(1.0, 0.5));
  TriMesh other = ball.surface.mesh;
  other.patches[PatchId(0u)].name = "balloon";
  const Deviation d = ball.measure(other);
  EXPECT_EQ(d.distance.state, GateState::not_checked);
  EXPECT_THAT(d.distance.reason, HasSubstr("\"ball\""));
  EXPECT_THAT(d.unknown, testing::ElementsAre("balloon"));
}

TEST(Deviation, OfRealCad) {
  STERNA_NEEDS_SHARED_DATA();
  for (const char* file : {"cad/tigl_simplewing_simplewing.brep", "cad/dlr_f6_dlr_f6.brep"}) {
    SCOPED_TRACE(file);
    const Made made(io::read_cad(test::shared_data() / file, {}, k_context).model, {});
    const Deviation d = made.measure(made.surface.mesh);
    EXPECT_EQ(d.distance.state, GateState::pass);
    EXPECT_GT(d.normal.share_within, 0.95);
    std::printf("%s: %lld nodes, off %.2g L; normals worst %.1f deg, %.2f %% within 10 deg, %lld beyond 30 deg\n", file, static_cast<long long>(d.n_nodes),
                d.distance.worst, d.normal.worst / k_degree, 100.0 * d.normal.share_within, static_cast<long long>(d.normal.n_beyond_hard));
    // A node inside a face, moved along the facets' normal by a known distance.
    TriMesh moved = made.surface.mesh;
    const double off = 1e-4 * d.length;
    for (const VertexId v : moved.points.ids()) {
      if (made.surface.edge_locations[v].edge.is_valid() || v.index() < moved.n_vertices() / 2) continue;
      const VertexLocation& location = made.surface.locations[v];
      const SurfaceDerivatives at = made.model.faces[location.face].surface->derivatives(location.at);
      moved.points[v] += off * normalized(cross(at.du, at.dv));
      const Deviation found = made.measure(moved);
      EXPECT_NEAR(found.distance.worst, 1e-4, 1e-7);
      EXPECT_EQ(found.distance.n_beyond_hard, 1);
      EXPECT_THAT(found.distance.locations.front().what, HasSubstr("node " + std::to_string(v.value()) + ","));
      break;
    }
  }
}

}  // namespace
}  // namespace sterna::surfmesh
