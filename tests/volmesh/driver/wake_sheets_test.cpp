// Layers that continue behind a sharp trailing edge: the wake sheet is no boundary, both sides share its faces, the wall is unchanged, and the whole mesh is
// proved valid.
#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <set>
#include <vector>

#include "geom/mesh/periodic.h"
#include "geom/mesh/topology.h"
#include "tests/support/error_of.h"
#include "tests/support/test_constants.h"
#include "tests/support/test_shapes.h"
#include "tests/volmesh/domain/room.h"
#include "tests/volmesh/domain/sharp_wing.h"
#include "tests/volmesh/driver/continued.h"
#include "volmesh/domain/complete_boundary.h"
#include "volmesh/domain/trailing_edges.h"
#include "volmesh/domain/wake_sheets.h"
#include "volmesh/stages.h"
#include "volmesh/volume_mesh.h"

namespace sterna::volmesh {
namespace {

using test::k_context;

constexpr Vec3 k_stream{1.0, 0.0, 0.0};

MeshCase wake_case(std::vector<WakeSheet> wakes) {
  MeshCase mesh_case = layers(8, 1e-3);
  mesh_case.farfield.farfield_radius = 10.0;
  mesh_case.wakes = std::move(wakes);
  return mesh_case;
}

using Location = std::array<double, 3>;
Location location_of(const Point& p) { return {p.x, p.y, p.z}; }

/// Returns the boundary faces of the wing as sorted triples of coordinates.
std::vector<std::array<Location, 3>> faces_of_wing(const HybridMesh& mesh) {
  std::vector<std::array<Location, 3>> faces;
  for (const sterna::BoundaryTriangle& face : mesh.boundary_triangles) {
    if (mesh.patches[face.patch].name != "wing") continue;
    auto& locations = faces.emplace_back();
    for (std::size_t k = 0; k < 3; ++k) locations[k] = location_of(mesh.points[face.nodes[k]]);
    std::ranges::sort(locations);
  }
  std::ranges::sort(faces);
  return faces;
}

/// A plate of chord 1 with the given thickness, with a blunt base and eight edges of 0.1 m along it.
TriMesh plate(double thickness) {
  constexpr int k_along = 10, k_span = 8;
  std::vector<std::array<double, 2>> section;  // over the upper side to the front, back along the lower side
  for (int i = 0; i <= k_along; ++i) section.push_back({1.0 - 0.1 * i, 0.5 * thickness});
  for (int i = 0; i <= k_along; ++i) section.push_back({0.1 * i, -0.5 * thickness});
  const int n = static_cast<int>(section.size());
  TriMesh mesh;
  mesh.patches.push_back({"wing", PatchKind::wall});
  for (int j = 0; j <= k_span; ++j)
    for (const auto& [x, z] : section) mesh.points.push_back({x, 0.1 * j, z});
  const auto vertex = [&](int j, int i) { return VertexId(j * n + (i + n) % n); };
  const auto add = [&](VertexId a, VertexId b, VertexId c) {
    mesh.triangles.push_back({a, b, c});
    mesh.triangle_patch.push_back(PatchId(0));
  };
  for (int j = 0; j < k_span; ++j)
    for (int i = 0; i < n; ++i) {
      add(vertex(j, i), vertex(j + 1, i + 1), vertex(j, i + 1));
      add(vertex(j, i), vertex(j + 1, i), vertex(j + 1, i + 1));
    }
  for (const int j : {0, k_span})
    for (int i = 0; i < k_along; ++i) {
      const std::array quad = {vertex(j, i), vertex(j, i + 1), vertex(j, n - 2 - i), vertex(j, n - 1 - i)};
      for (const auto& [a, b, c] : {std::array{quad[0], quad[1], quad[2]}, std::array{quad[0], quad[2], quad[3]}}) j == 0 ? add(a, b, c) : add(a, c, b);
    }
  return mesh;
}

/// Adds a second body with a separate patch.
TriMesh with_obstacle(TriMesh wall, const Vec3& low, const Vec3& high) {
  TriMesh block = test::cube(6);
  const Box unit = bounding_box(block);
  for (Point& p : block.points)
    for (std::size_t k = 0; k < 3; ++k) p[k] = low[k] + (p[k] - unit.min[k]) / (unit.max[k] - unit.min[k]) * (high[k] - low[k]);
  block.patches = Column<PatchId, Patch>{{"obstacle", PatchKind::wall}};
  block.triangle_patch.assign(block.n_triangles(), PatchId(0));
  append(wall, block);
  return wall;
}

double end_of(const TriMesh& wall) {
  double end = 0.0;
  for (const Point& p : wall.points) end = std::max(end, p.x);
  return end;
}

TEST(TrailingEdges, PlateHasItsUpperBaseEdge) {
  const TriMesh wall = plate(0.05), thick = plate(0.2);
  const Topology topology(wall, k_context), of_thick(thick, k_context);
  const std::vector<TrailingEdge> chains = find_trailing_edges(wall, topology, {"*", wall.n_triangles()}, {1, 0, 0});
  ASSERT_EQ(chains.size(), 1u);
  EXPECT_TRUE(chains[0].is_blunt);
  EXPECT_EQ(chains[0].edges.size(), 8u);
  for (const HalfedgeId h : chains[0].edges) EXPECT_EQ(wall.points[topology.from(h)], (Point{1.0, wall.points[topology.from(h)].y, 0.025}));
  EXPECT_TRUE(find_trailing_edges(thick, of_thick, {"*", thick.n_triangles()}, {1, 0, 0}).empty());
}

TEST(TrailingEdges, OfAWingItIsTheSharpOne) {
  const TriMesh wall = sharp_wing(20.0, 8);
  const Topology topology(wall, k_context);
  const WingTriangles wing{"*", wall.n_triangles()};
  const std::vector<TrailingEdge> chains = find_trailing_edges(wall, topology, wing, {1, 0, 0});
  ASSERT_EQ(chains.size(), 1u);
  EXPECT_EQ(chains[0].edges.size(), 8u);
  EXPECT_FALSE(chains[0].is_loop);
  for (const HalfedgeId h : chains[0].edges) EXPECT_EQ(wall.points[topology.from(h)].x, 1.0);
  for (std::size_t i = 0; i + 1 < chains[0].edges.size(); ++i) EXPECT_EQ(topology.to(chains[0].edges[i]), topology.from(chains[0].edges[i + 1]));
  for (const double chord : local_chords(wall, topology, wing, {1, 0, 0}, chains[0])) EXPECT_NEAR(chord, 1.176, 0.01);  // chord including the nose
  EXPECT_TRUE(find_trailing_edges(wall, topology, wing, {-1, 0, 0}).empty());  // the edge is a leading edge in this direction
  EXPECT_TRUE(find_trailing_edges(wall, topology, {"tail*", wall.n_triangles()}, {1, 0, 0}).empty());
}

TEST(WakeSheets, TheWallIsAThinBodyThen) {
  const TriMesh given = sharp_wing(20.0, 8);
  TriMesh wall = given;
  const SheetsOnWall made = add_wake_sheets(std::array{WakeSheet{}}, k_stream, 1e-3, {}, wall, k_context);
  const DoubledSheets& sheets = made.sheets;
  ASSERT_FALSE(sheets.is_empty());
  EXPECT_EQ(Topology(wall, k_context).n_boundary_halfedges(), 0u);
  EXPECT_EQ(made.sources.size(), wall.n_triangles() - given.n_triangles());
  EXPECT_EQ(sheets.n_given_vertices, given.n_vertices());
  std::size_t n_on_edge = 0;
  for (const DoubledSheets::BaseVertex& base_vertex : sheets.base_vertices) {
    EXPECT_NEAR(distance(wall.points[base_vertex.sides[0]], wall.points[base_vertex.sides[1]]), 2e-5, 1e-12);
    EXPECT_GE(base_vertex.sides[1].index(), given.n_vertices());
    if (base_vertex.sides[0].index() < given.n_vertices()) {
      EXPECT_EQ(base_vertex.point, given.points[base_vertex.sides[0]]);
      ++n_on_edge;
    }
  }
  EXPECT_EQ(n_on_edge, 7u);                          // the opened edge ends at the two corners of the wing
  for (const TriangleId t : wall.triangles.ids()) {  // no triangle has only rim vertices
    const auto is_border = [&](VertexId v) { return std::ranges::binary_search(sheets.borders, v); };
    EXPECT_FALSE(t.index() >= given.n_triangles() && std::ranges::all_of(wall.triangles[t], is_border));
  }
  double end = 0.0;
  for (const Point& p : wall.points) end = std::max(end, p.x);
  EXPECT_NEAR(end, 1.0 + 2.0 * 1.176, 0.01);  // two chords, the nose included
}

TEST(WakeSheets, WedgeMeshesAreValidAndKeepWall) {
  for (const double angle : {5.0, 30.0}) {
    const TriMesh wall = sharp_wing(angle, 8);
    const VolumeMeshResult without = volume_mesh(wall, wake_case({}), k_context), with = volume_mesh(wall, wake_case({{.length = 1.0}}), k_context);
    EXPECT_TRUE(with.check.is_valid()) << angle;
    EXPECT_GT(with.mesh.prisms.size(), 500u) << angle;
    EXPECT_EQ(faces_of_wing(with.mesh), faces_of_wing(without.mesh)) << angle;
    const CheckReport all_explicit = check(explicit_cells(with.mesh), {}, k_context);
    EXPECT_TRUE(all_explicit.is_valid()) << angle;
    EXPECT_NEAR(all_explicit.dual_volume, with.check.dual_volume, 1e-11 * with.check.dual_volume);
  }
}

/// Makes the mesh of the wedge-shaped wing with 14 layers, and first heights on the wake sheet that grow by a ratio from row to row.
VolumeMeshResult with_height_growth(double growth, const char* truncate = "never") {
  MeshCase mesh_case = layers(14, 1e-3);
  mesh_case.farfield.farfield_radius = 10.0;
  mesh_case.prisms.truncate = truncate;
  mesh_case.wakes = {{.length = 2.0, .height_growth = growth}};
  return volume_mesh(sharp_wing(20.0, 12), mesh_case, k_context);
}

/// Returns the smallest height (m) of a cell at the sheet behind x: the shortest edge off the plane z = 0 at one of its nodes.
double least_height_behind(const HybridMesh& mesh, double x) {
  constexpr double k_on_sheet = 1e-6;
  double least = 1.0;
  for (const auto& prism : mesh.prisms)
    for (std::size_t k = 0; k < 3; ++k) {
      const Point &low = mesh.points[prism[k]], &high = mesh.points[prism[k + 3]];
      if (std::abs(low.z) < k_on_sheet && low.x > x) least = std::min(least, distance(low, high));
    }
  return least;
}

TEST(WakeSheets, HeightsGrowAlongThemAndLayersGetFewer) {
  const VolumeMeshResult equal = with_height_growth(1.0), growing = with_height_growth(1.3);
  EXPECT_TRUE(equal.check.is_valid());
  EXPECT_TRUE(growing.check.is_valid());
  EXPECT_EQ(faces_of_wing(growing.mesh), faces_of_wing(equal.mesh));
  EXPECT_EQ(growing.mesh.layers.base.size(), equal.mesh.layers.base.size());
  EXPECT_TRUE(growing.mesh.layers.is_uniform());  // the remaining columns stand on the wing
  EXPECT_LT(growing.mesh.prisms.size(), 0.8 * static_cast<double>(equal.mesh.prisms.size()));
  EXPECT_LT(least_height_behind(equal.mesh, 2.0), 2e-3);
  EXPECT_GT(least_height_behind(growing.mesh, 2.0), 2.0 * least_height_behind(growing.mesh, 1.0));
  EXPECT_TRUE(check(explicit_cells(growing.mesh), {}, k_context).is_valid());
}

TEST(WakeSheets, TruncationGoesTogetherWithGrowingHeights) {
  for (const char* truncate : {"auto", "always"}) EXPECT_TRUE(with_height_growth(1.25, truncate).check.is_valid()) << truncate;
}

TEST(WakeSheets, EqualForAnyNumberOfThreads) {
  const TriMesh wall = sharp_wing(20.0, 8);
  const MeshCase mesh_case = wake_case({{.length = 0.7}});
  const VolumeMeshResult one = volume_mesh(wall, mesh_case, RunContext({.threads = 1}));
  for (const int threads : {2, 7}) {
    const VolumeMeshResult other = volume_mesh(wall, mesh_case, RunContext({.threads = threads}));
    EXPECT_EQ(other.mesh.points, one.mesh.points);
    EXPECT_EQ(other.mesh.prisms, one.mesh.prisms);
    EXPECT_EQ(other.mesh.tetrahedra, one.mesh.tetrahedra);
  }
}

TEST(WakeSheets, HalfModelSheetEndsInThePlane) {
  const VolumeMeshResult with = volume_mesh(half_sharp_wing(20.0, 6), wake_case({{.length = 1.0}}), k_context);
  EXPECT_TRUE(with.check.is_valid());
  std::size_t n_behind = 0;  // layer quadrilaterals on the plane behind the wing
  for (const BoundaryQuad& quad : with.mesh.boundary_quads) {
    EXPECT_EQ(with.mesh.patches[quad.patch].name, "symmetry");
    n_behind += std::ranges::all_of(quad.nodes, [&](NodeId n) { return with.mesh.points[n].x > 1.0; }) ? 1 : 0;
  }
  EXPECT_GT(n_behind, 20u);
}

TEST(WakeSheets, SheetBehindBluntBaseStartsAtUpperEdge) {
  const TriMesh wall = plate(0.05);
  const VolumeMeshResult with = volume_mesh(wall, wake_case({{.length = 0.6}}), k_context), without = volume_mesh(wall, wake_case({}), k_context);
  EXPECT_TRUE(with.check.is_valid());
  EXPECT_EQ(faces_of_wing(with.mesh), faces_of_wing(without.mesh));
  // Growth lines at the edges of the base have columns on one side and cells of the sheet on the other: their first heights are correct along the normal of all
  // facets.
  EXPECT_LT(with.check.gate(Measure::first_height).worst, 0.2);  // limit of the gate
}

TEST(WakeSheets, EndWhereAWallIsInTheWay) {
  const TriMesh wing = sharp_wing(20.0, 8), free = [&] {
    TriMesh wall = wing;
    add_wake_sheets(std::array{WakeSheet{.wing = "wing"}}, k_stream, 1e-3, {}, wall, k_context);
    return wall;
  }();
  EXPECT_GT(end_of(free), 3.0);
  const auto sheets_before = [&](const TriMesh& given) {
    TriMesh wall = given;
    const SheetsOnWall made = add_wake_sheets(std::array{WakeSheet{.wing = "wing"}}, k_stream, 1e-3, {}, wall, k_context);
    Box box;
    for (std::size_t t = made.sheets.n_given_triangles; t < wall.n_triangles(); ++t)
      for (const Point& p : corners(wall, TriangleId(t))) box.add(p);
    return box;
  };
  const Box before_all = sheets_before(with_obstacle(wing, {2.0, -1.0, -0.5}, {2.5, 2.0, 0.5}));
  EXPECT_LT(before_all.max.x, 2.0);
  EXPECT_GT(before_all.max.x, 1.2);
  const Box beside = sheets_before(with_obstacle(wing, {1.1, 0.55, -0.5}, {4.0, 2.0, 0.5}));  // behind the right third of the wing
  EXPECT_LT(beside.max.y, 0.55);
  EXPECT_GT(beside.max.x, 3.0);
  test::expect_error(ErrorCode::bad_argument, "no room", [&] { sheets_before(with_obstacle(wing, {1.02, -1.0, -0.5}, {2.5, 2.0, 0.5})); });
  const VolumeMeshResult mesh = volume_mesh(with_obstacle(wing, {2.0, -1.0, -0.5}, {2.5, 2.0, 0.5}), wake_case({{.wing = "wing"}}), k_context);
  EXPECT_TRUE(mesh.check.is_valid());
}

TEST(WakeSheets, AGivenPlaneOfSymmetryIsMadeAnew) {
  const TriMesh half = half_sharp_wing(20.0, 6);
  const TriMesh domain = complete_boundary(half, {wake_case({}).farfield, nullptr}, k_context);
  MeshCase mesh_case = wake_case({{.length = 1.0}});
  mesh_case.farfield = {};
  const VolumeMeshResult with = volume_mesh(domain, mesh_case, k_context);
  EXPECT_TRUE(with.check.is_valid());
  EXPECT_GT(with.mesh.prisms.size(), 200u);
  for (const BoundaryQuad& quad : with.mesh.boundary_quads) EXPECT_EQ(with.mesh.patches[quad.patch].name, "symmetry");
}

/// A wing without caps, bent between the sides, so that it meets them at different angles.
TriMesh wing_from_side_to_side(double wedge_angle, double bend) {
  constexpr int k_span = 10;
  TriMesh open = open_sharp_wing(wedge_angle, k_span, true);
  for (Point& p : open.points) p.z += bend * p.y * p.y * (0.1 * k_span - p.y);
  return open;
}

TEST(WakeSheets, FromPeriodicSideToPeriodicSideTheyMatch) {
  for (const double bend : {0.0, 0.3})
    for (const char* truncate : {"never", "auto"})
      for (const bool has_given_sides : {false, true}) {
        TriMesh wall = wing_from_side_to_side(20.0, bend);
        MeshCase mesh_case = wake_case({{.length = 1.0}});
        mesh_case.farfield = {.farfield_shape = "box"};
        mesh_case.periodic = {{"symmetry_y_min", "symmetry_y_max"}};
        mesh_case.prisms.truncate = truncate;
        if (has_given_sides) {
          wall = complete_boundary(wall, {mesh_case.farfield, nullptr}, k_context);
          mesh_case.farfield = {};
        }
        const VolumeMeshResult result = volume_mesh(wall, mesh_case, k_context);
        ASSERT_TRUE(result.check.is_valid()) << to_text(result.check);
        ASSERT_EQ(result.mesh.periodic.size(), 1u);
        const PeriodicMatch match = match_periodic(result.mesh, result.mesh.periodic[0].first, result.mesh.periodic[0].second, periodic_tolerance(result.mesh));
        EXPECT_LT(distance(match.translation, Vec3(0.0, 1.0, 0.0)), 1e-12);
        // Layers behind the trailing edge reach both sides.
        std::array<double, 2> end = {0.0, 0.0};
        for (const BoundaryQuad& quad : result.mesh.boundary_quads)
          for (const NodeId node : quad.nodes) {
            const Point& p = result.mesh.points[node];
            end[p.y > 0.5 ? 1 : 0] = std::max(end[p.y > 0.5 ? 1 : 0], p.x);
          }
        EXPECT_GT(end[0], 1.8) << bend << truncate;
        EXPECT_NEAR(end[0], end[1], 1e-12);
      }
}

TEST(WakeSheets, BetweenPeriodicSidesThereMayBeOtherWings) {
  MeshCase mesh_case = wake_case({{}});
  mesh_case.farfield = {.farfield_shape = "box"};
  mesh_case.periodic = {{"symmetry_y_min", "symmetry_y_max"}};
  TriMesh wall = wing_from_side_to_side(20.0, 0.0);
  // Another wing ends between the sides: its wake sheet has rims.
  TriMesh tip = sharp_wing(20.0, 4);
  for (Point& p : tip.points) p += Vec3{5.0, 0.3, 0.0};
  append(wall, tip);
  EXPECT_TRUE(volume_mesh(wall, mesh_case, k_context).check.is_valid());
}

TEST(WakeSheets, FollowTheInflowOfATunnel) {
  TriMesh tunnel = room([](const std::string&) { return PatchKind::slip; });
  EXPECT_EQ(stream_of(tunnel), (Vec3{1.0, 0.0, 0.0}));
  for (Patch& patch : tunnel.patches) patch.kind = patch.name == "floor" ? PatchKind::inflow : PatchKind::slip;
  EXPECT_EQ(stream_of(tunnel), (Vec3{0.0, 0.0, 1.0}));
  for (Patch& patch : tunnel.patches)
    if (patch.name == "ceiling") patch.kind = PatchKind::inflow;  // opposite inflows
  EXPECT_EQ(stream_of(tunnel), k_stream);
  for (Patch& patch : tunnel.patches) patch.kind = patch.name == "floor" ? PatchKind::inflow : PatchKind::farfield;  // the jet of an engine is not the stream
  EXPECT_EQ(stream_of(tunnel), k_stream);
}

TEST(WakeSheets, TheirDirectionIsTheStreamUnlessGiven) {
  const auto end_height = [](const WakeSheet& wake, const Vec3& stream) {
    TriMesh wall = sharp_wing(20.0, 8);
    const std::size_t n_given = wall.n_vertices();
    add_wake_sheets(std::array{wake}, stream, 1e-3, {}, wall, k_context);
    double highest = 0.0;
    for (std::size_t i = n_given; i < wall.n_vertices(); ++i) highest = std::max(highest, wall.points[VertexId(i)].z);
    return highest;
  };
  const Vec3 upward = normalized(Vec3{1.0, 0.0, 0.2});
  EXPECT_LT(end_height({}, k_stream), 0.01);
  EXPECT_GT(end_height({}, upward), 0.1);
  EXPECT_EQ(end_height({.direction = upward}, k_stream), end_height({}, upward));
}

TEST(WakeSheets, BeginWhereTipEdgesAreNotShort) {
  TriMesh wall = sharp_wing(20.0, 8);  // edges of 0.1 m; the last two 0.02 m
  for (Point& p : wall.points)
    if (p.y > 0.65) p.y = p.y > 0.75 ? 0.64 : 0.62;
  const std::size_t n_given = wall.n_vertices();
  const SheetsOnWall made = add_wake_sheets(std::array{WakeSheet{.length = 0.5}}, k_stream, 1e-3, {}, wall, k_context);
  double farthest = 0.0;
  for (const VertexId v : made.sheets.borders)
    if (v.index() < n_given) farthest = std::max(farthest, wall.points[v].y);
  EXPECT_NEAR(farthest, 0.6, 1e-12);
}

TEST(WakeSheets, WhatCannotBeIsRefused) {
  const TriMesh wall = sharp_wing(20.0, 8);
  const auto refuse = [&](const char* text, MeshCase mesh_case) {
    test::expect_error(ErrorCode::bad_argument, text, [&] { volume_mesh(wall, mesh_case, k_context); });
  };
  refuse("no patch name matches \"tail\"", wake_case({{.wing = "tail"}}));
  refuse("no trailing edge", wake_case({{.direction = Vec3{-1, 0, 0}}}));
  refuse("is zero", wake_case({{.direction = Vec3{0, 0, 0}}}));
  MeshCase with_ridges = wake_case({{}});
  with_ridges.ridges.open_ridges = "always";
  refuse("several normals", with_ridges);
  test::expect_error(ErrorCode::bad_argument, "no trailing edge", [&] { volume_mesh(sharp_wing(70.0, 8), wake_case({{}}), k_context); });
  MeshCase with_disc = wake_case({{}});
  with_disc.discs = {{.center = {3, 0, 0}, .radius = 0.5}};
  refuse("actuator discs", with_disc);
}

TEST(WakeSheets, ContinuedMeshesAreTheSame) {
  MeshCase mesh_case = wake_case({{.length = 0.5}});
  EXPECT_FALSE(expect_continued(sharp_wing(20.0, 8), mesh_case).whole.mesh.prisms.empty());
  mesh_case.prisms.truncate = "auto";
  expect_continued(half_sharp_wing(20.0, 6), mesh_case);
}

}  // namespace
}  // namespace sterna::volmesh
