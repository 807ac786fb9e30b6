// Actuator discs that end on walls with layers: spinners, ducts, both.
#include <gmock/gmock.h>

#include <cmath>
#include <map>
#include <numbers>
#include <set>

#include "geom/base/error.h"
#include "geom/math/measures.h"
#include "geom/mesh/baffles.h"
#include "tests/support/error_of.h"
#include "tests/support/halves.h"
#include "tests/support/test_constants.h"
#include "tests/volmesh/domain/room.h"
#include "tests/volmesh/driver/revolved_bodies.h"
#include "volmesh/domain/disc_baffles.h"
#include "volmesh/stages.h"

namespace sterna::volmesh {
namespace {

using testing::HasSubstr;

using test::k_context;
using test::k_pi;

MeshCase eight_layers_with(std::vector<ActuatorDisc> discs) {
  MeshCase options;
  options.envelope.layers = 8;
  options.envelope.first_height = 2e-3;
  options.farfield.farfield_radius = 15.0;
  options.discs = std::move(discs);
  return options;
}

struct Side {
  double area = 0.0;
  std::size_t n_triangles = 0, n_quads = 0;
  double off_plane = 0.0;
};

Side side_of(const HybridMesh& mesh, const std::string& name, const ActuatorDisc& disc) {
  Side side;
  const Vec3 n = normalized(disc.axis);
  const auto look = [&](std::span<const NodeId> nodes) {
    Vec3 area;
    for (std::size_t k = 0; k < nodes.size(); ++k) {
      side.off_plane = std::max(side.off_plane, std::abs(dot(mesh.points[nodes[k]] - disc.center, n)));
      if (k >= 2) area += area_vector(mesh.points[nodes[0]], mesh.points[nodes[k - 1]], mesh.points[nodes[k]]);
    }
    side.area += norm(area);
  };
  for (const auto& t : mesh.boundary_triangles)
    if (mesh.patches[t.patch].name == name) look(t.nodes), ++side.n_triangles;
  for (const auto& q : mesh.boundary_quads)
    if (mesh.patches[q.patch].name == name) look(q.nodes), ++side.n_quads;
  return side;
}

/// Expects that both sides cover the ring between two radii, face on face, in the plane, and share only the nodes of free rims.
void expect_disc(const VolumeMeshResult& result, const ActuatorDisc& disc, double inner, double outer) {
  SCOPED_TRACE(disc.name);
  const HybridMesh& mesh = result.mesh;
  EXPECT_TRUE(result.check.is_valid());
  const double area = k_pi * (outer * outer - inner * inner);
  const Side front = side_of(mesh, disc.name, disc), back = side_of(mesh, back_name(disc), disc);
  EXPECT_NEAR(front.area, area, 0.02 * area);
  EXPECT_NEAR(front.area, back.area, 1e-12 * area);
  EXPECT_EQ(front.n_triangles, back.n_triangles);
  EXPECT_EQ(front.n_quads, back.n_quads);
  EXPECT_GT(front.n_quads, 100u);
  EXPECT_LE(std::max(front.off_plane, back.off_plane), 1e-12 * disc.radius);

  const BaffleSides sides = find_baffle_sides(mesh);
  ASSERT_FALSE(sides.empty());
  std::set<std::uint32_t> shared, nodes;
  std::size_t n_single = 0;
  const auto look = [&](std::size_t face, std::span<const NodeId> of_face, PatchId patch) {
    if (mesh.patches[patch].name != disc.name) return;
    n_single += !sides.is_baffle(face);
    std::set<std::uint32_t> other;
    const std::size_t on = sides.other_side[face];
    if (on < mesh.boundary_triangles.size()) {
      for (const NodeId n : mesh.boundary_triangles[on].nodes) other.insert(n.value());
    } else {
      for (const NodeId n : mesh.boundary_quads[on - mesh.boundary_triangles.size()].nodes) other.insert(n.value());
    }
    for (const NodeId n : of_face)
      if (other.contains(n.value())) shared.insert(n.value());
  };
  for (std::size_t i = 0; i < mesh.boundary_triangles.size(); ++i) look(i, mesh.boundary_triangles[i].nodes, mesh.boundary_triangles[i].patch);
  for (std::size_t i = 0; i < mesh.boundary_quads.size(); ++i)
    look(mesh.boundary_triangles.size() + i, mesh.boundary_quads[i].nodes, mesh.boundary_quads[i].patch);
  EXPECT_EQ(n_single, 0u);
  for (const std::uint32_t n : shared) {
    const double r = distance(mesh.points[NodeId(n)], disc.center);
    EXPECT_LT(std::min(std::abs(r - disc.radius), std::abs(r - disc.inner_radius)), 1e-12 * disc.radius);
  }
}

TEST(DiscOnWall, PropellerRoundASpinner) {
  for (const double x : {0.0, -1.23}) {
    SCOPED_TRACE(x);
    const ActuatorDisc disc{.name = "prop", .center = {x, 0, 0}, .radius = 1.5};
    const VolumeMeshResult result = volume_mesh(hub(), eight_layers_with({disc}), k_context);
    expect_disc(result, disc, hub_radius(x), 1.5);
    EXPECT_GT(result.layer.coverage, 0.95);
  }
}

TEST(DiscOnWall, TiltedPlaneAndTetgen) {
  const ActuatorDisc disc{.name = "prop", .center = {-0.7, 0.02, 0.01}, .axis = {1, 0.15, -0.1}, .radius = 1.5, .inner_radius = 0.1};
  MeshCase options = eight_layers_with({disc});
  options.tetrahedra.engine = "tetgen";
  const VolumeMeshResult result = volume_mesh(hub(), options, k_context);
  EXPECT_EQ(result.tetra_engine, "tetgen");
  expect_disc(result, disc, hub_radius(-0.7), 1.5);
}

TEST(DiscOnWall, FanThatFillsADuct) {
  const ActuatorDisc disc{.name = "fan", .center = {0.1, 0, 0}, .radius = 1.5};
  expect_disc(volume_mesh(duct(), eight_layers_with({disc}), k_context), disc, 0.0, duct_radius(0.1));
}

TEST(DiscOnWall, RingInADuctWithAFreeRim) {
  const ActuatorDisc disc{.name = "fan", .center = {0.1, 0, 0}, .radius = 1.5, .inner_radius = 0.4};
  expect_disc(volume_mesh(duct(), eight_layers_with({disc}), k_context), disc, 0.4, duct_radius(0.1));
}

TEST(DiscOnWall, FanBetweenHubAndDuct) {
  TriMesh wall = duct();
  append(wall, hub());
  const ActuatorDisc disc{.name = "fan", .center = {-0.3, 0, 0}, .radius = 1.5};
  expect_disc(volume_mesh(wall, eight_layers_with({disc}), k_context), disc, hub_radius(-0.3), duct_radius(-0.3));
}

TEST(DiscOnWall, TwoDiscsOnOneHubAndOneFree) {
  const std::vector<ActuatorDisc> discs = {{.name = "front", .center = {-0.8, 0, 0}, .radius = 1.2},
                                           {.name = "free", .center = {-3.0, 0, 0}, .radius = 1.0},
                                           {.name = "rear", .center = {0.33, 0, 0}, .axis = {-1, 0, 0}, .radius = 1.4}};
  const VolumeMeshResult result = volume_mesh(hub(), eight_layers_with(discs), k_context);
  expect_disc(result, discs[0], hub_radius(-0.8), 1.2);
  expect_disc(result, discs[2], hub_radius(0.33), 1.4);
  EXPECT_EQ(side_of(result.mesh, "free", discs[1]).n_triangles, side_of(result.mesh, "free.back", discs[1]).n_triangles);
}

/// The triangles between the two discs have corners on both outlines.
TEST(DiscOnWall, TwoDiscsLessThanAnEdgeApart) {
  const std::vector<ActuatorDisc> discs = {{.name = "front", .center = {-0.1, 0, 0}, .radius = 1.2}, {.name = "rear", .center = {0.15, 0, 0}, .radius = 1.2}};
  const VolumeMeshResult result = volume_mesh(hub(6), eight_layers_with(discs), k_context);
  expect_disc(result, discs[0], hub_radius(-0.1), 1.2);
  expect_disc(result, discs[1], hub_radius(0.15), 1.2);
}

/// Two regions that share only the disc.
TEST(DiscOnWall, FanThatPartsTheFluid) {
  const TriMesh wall = room([](const std::string&) { return PatchKind::wall; });
  for (const char* engine : {"hxt", "tetgen"}) {
    SCOPED_TRACE(engine);
    MeshCase options = layers(8, 1e-3);
    options.discs = {{.name = "fan", .center = {1.93, 1, 1}, .radius = 1.6}};
    options.tetrahedra.engine = engine;
    const VolumeMeshResult result = volume_mesh(wall, options, k_context);
    EXPECT_TRUE(result.check.is_valid());
    EXPECT_EQ(result.tetra_engine, engine);
    const Side front = side_of(result.mesh, "fan", options.discs[0]), back = side_of(result.mesh, "fan.back", options.discs[0]);
    EXPECT_NEAR(front.area, 4.0, 1e-12);
    EXPECT_NEAR(back.area, 4.0, 1e-12);
    EXPECT_EQ(front.off_plane, 0.0);
    EXPECT_GT(front.n_quads, 8u * 48u);
    EXPECT_NEAR(result.check.total_volume, 16.0, 1e-11);
  }
}

/// Walls of another body so close that layers collapse at the disc outlines: cell sides there are triangles.
TEST(DiscOnWall, CollapsedLinesAtTheOutline) {
  TriMesh wall = hub(), other = hub();
  for (Point& p : other.points) p.y += 1.002;
  other.patches = Column<PatchId, Patch>{{"other", PatchKind::wall}};
  append(wall, other);
  const ActuatorDisc disc{.name = "prop", .center = {-0.03, 0.5, 0}, .radius = 1.7};
  const VolumeMeshResult result = volume_mesh(wall, eight_layers_with({disc}), k_context);
  EXPECT_TRUE(result.check.is_valid());
  EXPECT_GT(result.layer.collapsed_area, 0.0);
  const Side front = side_of(result.mesh, "prop", disc), back = side_of(result.mesh, "prop.back", disc);
  EXPECT_NEAR(front.area, k_pi * (1.7 * 1.7 - 2.0 * 0.25), 0.1);
  EXPECT_NEAR(front.area, back.area, 1e-12);
  EXPECT_EQ(front.n_triangles, back.n_triangles);
  EXPECT_EQ(front.n_quads, back.n_quads);
  EXPECT_EQ(front.off_plane, 0.0);
}

/// A disc beside a layer that ends on a symmetry plane, and with other numbers of layers.
TEST(DiscOnWall, NacelleBesideAHalfBody) {
  TriMesh wall = test::cut_off(hub(), 1, 0.0), nacelle = hub();
  for (Point& p : nacelle.points) p.y += 1.5;
  nacelle.patches = Column<PatchId, Patch>{{"nacelle", PatchKind::wall}};
  append(wall, nacelle);
  const ActuatorDisc disc{.name = "prop", .center = {-0.7, 1.5, 0}, .radius = 0.9};
  MeshCase options = eight_layers_with({disc});
  options.patches = {{.names = "nacelle", .options = {{"layers", 12}, {"first_height", 5e-4}}}};
  const VolumeMeshResult result = volume_mesh(wall, options, k_context);
  expect_disc(result, disc, hub_radius(-0.7), 0.9);
  EXPECT_FALSE(result.mesh.layers.is_uniform());
  const VolumeMeshResult by_hand =
      finish_mesh(wall, make_tetrahedra(wall, make_envelope(wall, options, {}, k_context), options, {}, k_context), options, k_context);
  EXPECT_EQ(result.mesh.points, by_hand.mesh.points);
}

TEST(DiscOnWall, SameBytesWithOneThreadAndByStages) {
  const ActuatorDisc disc{.name = "prop", .center = {-1.23, 0, 0}, .radius = 1.5};
  const MeshCase options = eight_layers_with({disc});
  const TriMesh wall = hub(6);
  const VolumeMeshResult two = volume_mesh(wall, options, k_context), one = volume_mesh(wall, options, RunContext({.threads = 1}));
  EXPECT_EQ(two.mesh.points, one.mesh.points);
  EXPECT_EQ(two.mesh.tetrahedra, one.mesh.tetrahedra);
  const VolumeMeshResult by_hand =
      finish_mesh(wall, make_tetrahedra(wall, make_envelope(wall, options, {}, k_context), options, {}, k_context), options, k_context);
  EXPECT_EQ(two.mesh.points, by_hand.mesh.points);
  EXPECT_EQ(two.mesh.tetrahedra, by_hand.mesh.tetrahedra);
  EXPECT_EQ(two.mesh.layers.base, by_hand.mesh.layers.base);
}

TEST(DiscOnWall, SaysWhereItCannotBe) {
  const auto mesh = [&](std::vector<ActuatorDisc> discs) {
    return test::error_info_of([&] { volume_mesh(hub(6), eight_layers_with(std::move(discs)), k_context); });
  };
  // The rim intersects the wall.
  const ErrorInfo border = mesh({{.name = "prop", .center = {0, 0.4, 0}, .radius = 0.3}});
  EXPECT_EQ(border.code, ErrorCode::self_intersection);
  EXPECT_THAT(border.attempted, HasSubstr("prop"));
  EXPECT_THAT(border.problem, HasSubstr("circle of the disc"));
  EXPECT_FALSE(border.locations.empty());
  // A disc beyond the farfield.
  const ErrorInfo far = mesh({{.name = "prop", .center = {0, 0, 0}, .radius = 40.0}});
  EXPECT_EQ(far.code, ErrorCode::self_intersection);
  EXPECT_THAT(far.locations.at(0).what, HasSubstr("farfield"));
  // Discs that cross each other.
  EXPECT_EQ(mesh({{.name = "a", .center = {0, 0, 0}, .radius = 1.0}, {.name = "b", .center = {0.3, 0, 0}, .axis = {1, 0.5, 0}, .radius = 1.0}}).code,
            ErrorCode::self_intersection);
}

}  // namespace
}  // namespace sterna::volmesh
