// Periodic sides, from closed surfaces to checked meshes: both sides match node by node and face by face.
#include <gmock/gmock.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>

#include "geom/mesh/periodic.h"
#include "geom/mesh/topology.h"
#include "tests/support/error_of.h"
#include "tests/support/test_constants.h"
#include "tests/support/test_shapes.h"
#include "tests/volmesh/domain/room.h"
#include "volmesh/domain/complete_boundary.h"
#include "volmesh/domain/periodic_sides.h"
#include "volmesh/layer_domain/layer_domain.h"
#include "volmesh/stages.h"

namespace sterna::volmesh {
namespace {

using testing::HasSubstr;

using test::k_context;

PatchKind all_slip(const std::string&) { return PatchKind::slip; }
bool is_wing(int i, int, int k) { return i >= 8 && i < 14 && k >= 5 && k < 7; }

MeshCase periodic_layers(int n, double first_height, std::vector<PeriodicNames> pairs = {{"left", "right"}}) {
  MeshCase options = layers(n, first_height);
  options.periodic = std::move(pairs);
  return options;
}

/// Makes the mesh; expects that it is valid and that all pairs match, by the check and by an independent test here.
VolumeMeshResult matched(const TriMesh& surface, const MeshCase& options) {
  VolumeMeshResult result = volume_mesh(surface, options, k_context);
  EXPECT_TRUE(result.check.is_valid()) << to_text(result.check);
  EXPECT_EQ(result.check.periodic.size(), options.periodic.size());
  EXPECT_EQ(result.mesh.periodic.size(), options.periodic.size());
  for (const PeriodicSides& sides : result.mesh.periodic) {
    const PeriodicMatch match = match_periodic(result.mesh, sides.first, sides.second, periodic_tolerance(result.mesh));
    EXPECT_LT(distance(match.translation, sides.translation), 1e-12);
    EXPECT_GT(match.nodes.size(), 10u);
    EXPECT_EQ(result.mesh.patches[sides.first].kind, PatchKind::interface);
  }
  return result;
}

TEST(PeriodicDomain, AWingBetweenTwoSides) {
  const VolumeMeshResult result = matched(room(all_slip, is_wing), periodic_layers(10, 1e-3));
  EXPECT_EQ(border_edges(result), (Edges{{"left", 16}, {"right", 16}}));
  EXPECT_EQ(result.check.periodic[0].first, "left");
  EXPECT_EQ(result.check.periodic[0].translation, Vec3(0, 2, 0));
  EXPECT_EQ(result.layer.collapsed_area, 0.0);
}

TEST(PeriodicDomain, SidesWithoutKindsInFileAreNoWalls) {
  TriMesh surface = room(all_slip, is_wing);
  for (Patch& patch : surface.patches)
    if (patch.name == "left" || patch.name == "right") patch.kind = PatchKind::wall;
  EXPECT_EQ(matched(surface, periodic_layers(10, 1e-3)).mesh.points, matched(room(all_slip, is_wing), periodic_layers(10, 1e-3)).mesh.points);
}

TEST(PeriodicDomain, LayersRequestedOnSidesAreRefused) {
  for (const Rule& rule : {Rule{.names = "left", .options = {{"kind", "wall"}}}, Rule{.names = "right", .options = {{"layers", 5}}}}) {
    MeshCase options = periodic_layers(10, 1e-3);
    options.patches = {rule};
    EXPECT_THAT(test::error_of([&] { volume_mesh(room(all_slip, is_wing), options, k_context); }).info().problem, HasSubstr("on \"" + rule.names + "\""));
  }
}

TEST(PeriodicDomain, FloorLayersHaveEqualEdgesOnBothSides) {
  const VolumeMeshResult result =
      matched(room([](const std::string& name) { return name == "floor" ? PatchKind::wall : PatchKind::slip; }, is_wing), periodic_layers(10, 1e-3));
  EXPECT_EQ(border_edges(result), (Edges{{"inlet", 12}, {"outlet", 12}, {"left", 40}, {"right", 40}}));
}

TEST(PeriodicDomain, TwoDirectionsShareTheirEdges) {
  const TriMesh surface = room([](const std::string&) { return PatchKind::slip; });
  MeshCase options = periodic_layers(8, 1e-3, {{"left", "right"}, {"ceiling", "floor"}});
  options.patches = {{.names = "inlet", .options = {{"kind", "wall"}}}};
  const VolumeMeshResult result = matched(surface, options);
  EXPECT_EQ(border_edges(result), (Edges{{"ceiling", 12}, {"floor", 12}, {"left", 12}, {"right", 12}}));
}

/// The wing is bent, so that it meets the two sides at different angles, and the domain is sheared: the translation is not normal to the sides.
TEST(PeriodicDomain, ABentWingInASkewedRoom) {
  TriMesh surface = room(all_slip, is_wing);
  for (Point& p : surface.points) {
    const double inside = std::sin(std::numbers::pi * p.z / 2.0) * std::sin(std::numbers::pi * p.x / 4.0);
    p.z += 0.25 * p.y * p.y * (2.0 - p.y) * inside;
    p = Vec3{p.x + 0.3 * p.y, p.y, p.z + 0.1 * p.y};
    p = Vec3{0.8 * p.x - 0.6 * p.y + 3.0, 0.6 * p.x + 0.8 * p.y, p.z};
  }
  const VolumeMeshResult result = matched(surface, periodic_layers(12, 5e-4));
  EXPECT_GT(result.layer.coverage, 0.8);
  EXPECT_NEAR(norm(result.mesh.periodic[0].translation), std::sqrt(4.0 + 0.36 + 0.04), 1e-12);
}

/// Several normals along the edges of a wing from side to side, straight and bent as above: ridges do not end at the sides, and the multi-normal fans there
/// match.
TEST(PeriodicDomain, RidgesGoOnBeyondTheSides) {
  for (const double bend : {0.0, 0.25}) {
    TriMesh surface = room(all_slip, is_wing);
    for (Point& p : surface.points) p.z += bend * p.y * p.y * (2.0 - p.y) * std::sin(std::numbers::pi * p.z / 2.0) * std::sin(std::numbers::pi * p.x / 4.0);
    MeshCase options = periodic_layers(10, 1e-3);
    options.ridges = {.open_ridges = "always", .open_angle = 80.0 * test::k_degree};
    const VolumeMeshResult result = matched(surface, options);
    EXPECT_FALSE(result.mesh.hexahedra.empty());
    // All four edges are opened from side to side, in three sectors each, or four if they turn by more than 90 degrees.
    const LayerDomain layer_domain(surface, options, k_context);
    EXPECT_EQ(layer_domain.domain.ridges.base_vertices.size(), 4u * 13u) << bend;
    EXPECT_TRUE(layer_domain.domain.ridges.ends.empty()) << bend;
    std::array<int, 2> n_triangles = {0, 0};
    for (const sterna::BoundaryTriangle& face : result.mesh.boundary_triangles)
      for (const OpenedRidges::BaseVertex& base_vertex : layer_domain.domain.ridges.base_vertices)
        for (std::size_t k = 0; k < 2; ++k)
          if (result.mesh.patches[face.patch].name == (k == 0 ? "left" : "right"))
            n_triangles[k] += std::ranges::any_of(face.nodes, [&](NodeId n) { return result.mesh.points[n] == base_vertex.point; }) ? 1 : 0;
    EXPECT_EQ(n_triangles[0], n_triangles[1]) << bend;
    EXPECT_GE(n_triangles[0], 12) << bend;
    const VolumeMeshResult one = volume_mesh(surface, options, RunContext({.threads = 1}));
    EXPECT_EQ(one.mesh.points, result.mesh.points);
  }
}

TEST(PeriodicDomain, ABodyThatTouchesNeitherSide) {
  const auto body = [](int i, int j, int k) { return i >= 8 && i < 14 && j >= 4 && j < 8 && k >= 5 && k < 7; };
  TriMesh surface = room(all_slip, body);
  const VolumeMeshResult result = matched(surface, periodic_layers(10, 1e-3));
  EXPECT_TRUE(result.mesh.boundary_quads.empty());
  MeshCase options = periodic_layers(10, 1e-3);
  options.tetrahedra.boundary_splits = "always";
  EXPECT_THAT(test::error_of([&] { volume_mesh(surface, options, k_context); }).info().problem, HasSubstr("boundary_splits"));
}

TEST(PeriodicDomain, SidesThatAreAddedInPlanes) {
  // A bar open at both ends, from plane to plane: the box around it has its sides in the planes.
  TriMesh surface;
  surface.patches.push_back({"bar", PatchKind::wall});
  const int n = 24, m = 8;
  for (int j = 0; j <= m; ++j)
    for (int i = 0; i < n; ++i) {
      const double a = 2.0 * std::numbers::pi * i / n;
      surface.points.push_back({0.5 * std::cos(a), 1.0 * j / m, 0.2 * std::sin(a)});
    }
  for (int j = 0; j < m; ++j)
    for (int i = 0; i < n; ++i) {
      const auto at = [&](int k, int l) { return VertexId(static_cast<std::size_t>(n * l + k % n)); };
      surface.triangles.push_back({at(i, j), at(i + 1, j + 1), at(i + 1, j)});
      surface.triangles.push_back({at(i, j), at(i, j + 1), at(i + 1, j + 1)});
    }
  surface.triangle_patch.assign(surface.n_triangles(), PatchId(0));
  MeshCase options = periodic_layers(10, 1e-3, {{"symmetry_y_min", "symmetry_y_max"}});
  options.farfield.farfield_shape = "box";
  const VolumeMeshResult result = matched(surface, options);
  EXPECT_EQ(border_edges(result), (Edges{{"symmetry_y_min", 24}, {"symmetry_y_max", 24}}));
}

TEST(PeriodicDomain, DifferentTriangulationOfSecondSideIsReplaced) {
  TriMesh surface = room(all_slip);
  // One diagonal is flipped, and one inner vertex moved.
  const auto right = static_cast<std::size_t>(std::ranges::find(surface.patches, "right", &Patch::name) - surface.patches.begin());
  VertexId inner;
  for (const TriangleId t : surface.triangles.ids())
    if (surface.triangle_patch[t] == PatchId(right))
      for (const VertexId v : surface.triangles[t])
        if (surface.points[v].x == 2.0 && surface.points[v].z == 1.0) inner = v;
  ASSERT_TRUE(inner.is_valid());
  surface.points[inner].x += 0.03;
  const std::size_t n_vertices = surface.n_vertices();
  std::vector<PeriodicPatches> joined = join_periodic_sides(surface, std::array{PeriodicNames{"left", "right"}}, k_context).pairs;
  ASSERT_EQ(joined.size(), 1u);
  EXPECT_EQ(surface.n_vertices(), n_vertices + 23 * 11);
  EXPECT_EQ(joined[0].vertices.size(), 25u * 13u);
  EXPECT_NO_THROW(match_periodic(surface, joined[0].first, joined[0].second, 1e-12));
}

TEST(PeriodicDomain, WallKeepsItsTrianglesBesideReplacedSide) {
  TriMesh surface = room(all_slip, is_wing);
  const auto right = PatchId(static_cast<std::size_t>(std::ranges::find(surface.patches, "right", &Patch::name) - surface.patches.begin()));
  // The triangles of the second side come first, and one inner vertex of that side is moved, so that its triangles are replaced and all others have different
  // numbers.
  TriMesh sorted = surface;
  sorted.triangles.clear();
  sorted.triangle_patch.clear();
  for (const bool is_right : {true, false})
    for (const TriangleId t : surface.triangles.ids())
      if ((surface.triangle_patch[t] == right) == is_right) {
        sorted.triangles.push_back(surface.triangles[t]);
        sorted.triangle_patch.push_back(surface.triangle_patch[t]);
      }
  for (Point& p : sorted.points)
    if (distance(p, {0.5, 2.0, 0.5}) < 1e-9) p.x += 0.03;
  TriMesh joined = sorted;
  ASSERT_FALSE(join_periodic_sides(joined, std::array{PeriodicNames{"left", "right"}}, k_context).sources.empty());
  const LayerDomain layer_domain(sorted, periodic_layers(4, 1e-3), k_context);
  for (const TriangleId t : layer_domain.domain.wall.triangles.ids()) {
    const auto of_wall = corners(layer_domain.domain.wall, t), of_surface = corners(sorted, layer_domain.domain.wall2surface[t]);
    for (std::size_t k = 0; k < 3; ++k) EXPECT_LT(distance(of_wall[k], of_surface[k]), 1e-12);
  }
}

TEST(PeriodicDomain, SixDigitVerticesMoveOntoTheirImages) {
  TriMesh surface = room(all_slip, is_wing);
  std::uint32_t state = 1;
  for (Point& p : surface.points) {
    for (std::size_t k = 0; k < 3; ++k) {
      state = state * 1664525u + 1013904223u;
      p[k] += 1e-7 * (static_cast<double>(state >> 8) / (1u << 24) - 0.5);
    }
  }
  const VolumeMeshResult result = matched(surface, periodic_layers(8, 1e-3));
  EXPECT_LT(result.check.periodic[0].worst, 1e-14);
}

TEST(PeriodicDomain, MesherVerticesMoveAlongBorderToImages) {
  TriMesh surface = room(all_slip, is_wing);
  // On the right, inner vertices on the wing's edges along x and on those of the floor are moved by a quarter of an edge.
  for (Point& p : surface.points)
    if (p.y == 2.0 && (p.z == 0.0 || std::abs(p.z - 5.0 / 6.0) < 1e-9) && p.x > 1.4 && p.x < 2.3) p.x += 0.25 / 6.0;
  TriMesh joined = surface;
  const std::vector<PeriodicPatches> sides = join_periodic_sides(joined, std::array{PeriodicNames{"left", "right"}}, k_context).pairs;
  EXPECT_EQ(sides[0].translation, Vec3(0, 2, 0));
  EXPECT_NO_THROW(match_periodic(joined, sides[0].first, sides[0].second, 1e-12));
  matched(surface, periodic_layers(8, 1e-3));
  for (Point& p : surface.points)
    if (p.y == 2.0 && p.z == 0.0 && std::abs(p.x - 2.0 - 0.25 / 6.0) < 1e-9) p.z += 0.02;  // off the edge line
  EXPECT_THAT(test::error_of([&] {
                join_periodic_sides(surface, std::array{PeriodicNames{"left", "right"}}, k_context);
              })
                  .info()
                  .problem,
              HasSubstr("have no partner"));
}

TEST(PeriodicDomain, MismatchesAreReportedWithLocationsAndDistances) {
  const auto problem_of = [](const TriMesh& surface, std::vector<PeriodicNames> pairs) {
    return test::error_of([&] { volume_mesh(surface, periodic_layers(8, 1e-3, std::move(pairs)), k_context); }).info();
  };
  const TriMesh surface = room(all_slip, is_wing);
  EXPECT_THAT(problem_of(surface, {{"left", "rigth"}}).problem, HasSubstr("did you mean \"right\"?"));
  EXPECT_THAT(problem_of(surface, {{"left", "left"}}).problem, HasSubstr("periodic with itself"));
  EXPECT_THAT(problem_of(surface, {{"left", "right"}, {"left", "floor"}}).problem, HasSubstr("in two pairs"));
  EXPECT_THAT(problem_of(surface, {{"left", "floor"}}).problem, HasSubstr("do not point in opposite directions"));
  EXPECT_THAT(problem_of(surface, {{"model", "right"}}).problem, HasSubstr("is not flat"));

  TriMesh moved = surface;
  for (Point& p : moved.points)
    if (p.y == 2.0 && std::abs(p.x - 4.0 / 3.0) < 1e-9 && p.z < 1e-9) p.x += 0.08;  // on the edge to the floor, too far to be moved back
  const ErrorInfo info = problem_of(moved, {{"left", "right"}});
  EXPECT_THAT(info.problem, HasSubstr("2 border vertices have no partner"));
  ASSERT_EQ(info.locations.size(), 2u);
  EXPECT_THAT(info.locations[0].what, HasSubstr("0.08 m away"));
  EXPECT_NEAR(info.locations[0].position.x, 4.0 / 3.0, 1e-9);

  // The wing ends before the right side, and a patch without layers has its outline there.
  const TriMesh patched = test::voxel_boundary(
      {24, 12, 12}, 1.0 / 6.0, [](int i, int j, int k) { return !is_wing(i, j, k); },
      [](const Point& p, const Vec3& normal) -> Patch {
        if (p.y == 0.0) return {"left", PatchKind::slip};
        if (p.y == 2.0) return {"right", PatchKind::slip};
        if (std::min(p.x, p.z) == 0.0 || p.x == 4.0 || p.z == 2.0) return {"box", PatchKind::slip};
        return p.y < 1.0 && normal.y == 0.0 ? Patch{"wing", PatchKind::wall} : Patch{"tip", PatchKind::slip};
      });
  EXPECT_THAT(problem_of(patched, {{"left", "right"}}).problem, HasSubstr("ends on one periodic side but not on the other"));
}

TEST(PeriodicDomain, StepsGiveSameMeshForAnyThreads) {
  const TriMesh surface = room(all_slip, is_wing);
  const MeshCase options = periodic_layers(6, 1e-3);
  const VolumeMeshResult whole = volume_mesh(surface, options, k_context);
  for (const int threads : {1, 7}) {
    const RunContext context({.threads = threads});
    const EnvelopeStage envelope = make_envelope(surface, options, {}, context);
    const VolumeMeshResult steps = finish_mesh(surface, make_tetrahedra(surface, envelope, options, {}, context), options, context);
    EXPECT_EQ(steps.mesh.points, whole.mesh.points);
    EXPECT_EQ(steps.mesh.tetrahedra, whole.mesh.tetrahedra);
    ASSERT_EQ(steps.mesh.periodic.size(), 1u);
    EXPECT_EQ(steps.mesh.periodic[0].translation, whole.mesh.periodic[0].translation);
  }
}

TEST(PeriodicDomain, TheCheckFindsSidesThatDoNotMatch) {
  VolumeMeshResult result = matched(room(all_slip, is_wing), periodic_layers(6, 1e-3));
  HybridMesh mesh = result.mesh;
  mesh.periodic[0].translation.x += 1e-6;
  EXPECT_EQ(check(mesh, {}, k_context).count(Violation::periodic_mismatch), 1);
  mesh = result.mesh;
  const PeriodicMatch match = match_periodic(mesh, mesh.periodic[0].first, mesh.periodic[0].second, periodic_tolerance(mesh));
  mesh.points[match.nodes[40][1]].x += 1e-7;
  const CheckReport report = check(mesh, {}, k_context);
  EXPECT_EQ(report.count(Violation::periodic_mismatch), 2);
  EXPECT_EQ(gate_of(Violation::periodic_mismatch), "G20");
  EXPECT_TRUE(report.periodic.empty());
  EXPECT_THAT(to_text(report), HasSubstr("no node at the image of this node"));
}

}  // namespace
}  // namespace sterna::volmesh
