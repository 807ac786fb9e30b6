// Several normals at a sharp trailing edge: the whole mesh is proved valid, the wall is unchanged, and stages that cannot handle multi-normal fans refuse them.
#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdlib>
#include <map>
#include <memory>
#include <utility>
#include <vector>

#include "io/file/surface_file.h"
#include "surfmesh/stitch/stitch_surface.h"
#include "tests/support/data.h"
#include "tests/support/error_of.h"
#include "tests/support/test_constants.h"
#include "tests/support/test_shapes.h"
#include "tests/volmesh/domain/room.h"
#include "tests/volmesh/domain/sharp_wing.h"
#include "tests/volmesh/driver/continued.h"
#include "volmesh/domain/open_ridges.h"
#include "volmesh/envelope/build_envelope.h"
#include "volmesh/envelope/patch_layers.h"
#include "volmesh/layer_domain/layer_domain.h"
#include "volmesh/parts/warm_start.h"
#include "volmesh/stages.h"
#include "volmesh/volume_mesh.h"

namespace sterna::volmesh {
namespace {

using test::k_context;

MeshCase wing_case(bool is_open) {
  MeshCase mesh_case = layers(12, 1e-3);
  mesh_case.farfield.farfield_radius = 10.0;
  if (is_open) mesh_case.ridges.open_ridges = "always";
  return mesh_case;
}

Domain opened(const TriMesh& wall, const RidgeOptions& options, std::vector<VertexId> closed = {}) {
  Domain domain;
  domain.wall = wall;
  open_ridges(options, patches_with_open_ridges(wall.patches, options, {}), 1e-3, closed, domain, k_context);
  return domain;
}

/// Returns the wall faces as sorted triples of coordinates.
std::vector<std::array<std::array<double, 3>, 3>> wall_faces(const HybridMesh& mesh) {
  std::vector<std::array<std::array<double, 3>, 3>> faces;
  for (const sterna::BoundaryTriangle& face : mesh.boundary_triangles) {
    if (mesh.patches[face.patch].name != "wing") continue;
    auto& locations = faces.emplace_back();
    for (std::size_t k = 0; k < 3; ++k) locations[k] = std::array{mesh.points[face.nodes[k]].x, mesh.points[face.nodes[k]].y, mesh.points[face.nodes[k]].z};
    std::ranges::sort(locations);
  }
  std::ranges::sort(faces);
  return faces;
}

TEST(Ridges, OpenedWallIsClosedAndContainsGivenWall) {
  const TriMesh wall = sharp_wing(30.0, 8);
  const Domain domain = opened(wall, {.open_ridges = "always"});
  const OpenedRidges& ridges = domain.ridges;
  EXPECT_EQ(ridges.base_vertices.size(), 7u);  // the ridge ends at the two corners
  EXPECT_EQ(ridges.end_vertices.size(), 2u);
  EXPECT_EQ(domain.wall.n_vertices(), wall.n_vertices() + 7 * 5);  // 150 degrees in five sectors
  EXPECT_EQ(ridges.quads.size(), 6u * 5u);
  EXPECT_EQ(ridges.ends.size(), 2u * 5u);
  const Topology topology(domain.wall, k_context);
  EXPECT_EQ(topology.n_boundary_halfedges(), 0u);
  // The opened wall equals the given wall once virtual triangles are removed and the growth lines of each ridge base vertex are merged.
  ASSERT_EQ(ridges.n_given_triangles, wall.n_triangles());
  for (const TriangleId t : wall.triangles.ids())
    for (std::size_t k = 0; k < 3; ++k) EXPECT_EQ(ridges.base_vertex[domain.wall.triangles[t][k]], wall.triangles[t][k]);
  for (const OpenedRidges::BaseVertex& base_vertex : ridges.base_vertices) EXPECT_EQ(base_vertex.point, wall.points[base_vertex.vertex]);
  for (const VertexId v : domain.wall.points.ids()) EXPECT_LE(distance(domain.wall.points[v], wall.points[ridges.base_vertex[v]]), 1.0000001e-5);
}

TEST(Ridges, ClosedVerticesAndFlatEdgesStayClosed) {
  const TriMesh wall = sharp_wing(30.0, 8);
  EXPECT_TRUE(opened(wall, {.open_ridges = "never"}).ridges.is_empty());
  EXPECT_TRUE(opened(wall, {.open_ridges = "always", .open_angle = 2.8}).ridges.is_empty());  // the edge turns by 2.62
  const Domain all = opened(wall, {.open_ridges = "always"});
  const VertexId middle = all.ridges.base_vertices[3].vertex;
  const Domain parted = opened(wall, {.open_ridges = "always"}, {middle});
  EXPECT_EQ(parted.ridges.base_vertices.size(), 6u);
  EXPECT_EQ(parted.ridges.end_vertices.size(), 3u);
}

TEST(Ridges, TooSmallAFirstHeightIsRefused) {
  TriMesh wall = sharp_wing(30.0, 8);
  for (Point& p : wall.points) p.x += 1e9;
  Domain domain;
  domain.wall = wall;
  test::expect_error(ErrorCode::bad_argument, "too small for coordinates", [&] {
    open_ridges({.open_ridges = "always"}, patches_with_open_ridges(wall.patches, {.open_ridges = "always"}, {}), 1e-3, {}, domain, k_context);
  });
}

TEST(Ridges, WedgeMeshesAreValidAndKeepWall) {
  for (const double angle : {5.0, 30.0, 70.0}) {
    const TriMesh wall = sharp_wing(angle, 12);
    const VolumeMeshResult closed = volume_mesh(wall, wing_case(false), k_context), open = volume_mesh(wall, wing_case(true), k_context);
    EXPECT_TRUE(open.check.is_valid()) << angle;
    EXPECT_GT(open.mesh.hexahedra.size(), 0u) << angle;
    EXPECT_EQ(wall_faces(open.mesh), wall_faces(closed.mesh)) << angle;
    // Columns beside explicit cells are measured in the same way as explicit cells.
    const CheckReport all_explicit = check(explicit_cells(open.mesh), {}, k_context);
    EXPECT_TRUE(all_explicit.is_valid()) << angle;
    EXPECT_EQ(all_explicit.cells.total(), open.check.cells.total());
    EXPECT_NEAR(all_explicit.dual_volume, open.check.dual_volume, 1e-11 * open.check.dual_volume);
  }
}

/// Two sharp wings side by side with separate patches: "wing" and "tail".
TriMesh two_wings() {
  TriMesh wall = sharp_wing(30.0, 8), tail = wall;
  for (Point& p : tail.points) p.x += 4.0;
  tail.patches = Column<PatchId, Patch>{{"tail", PatchKind::wall}};
  append(wall, tail);
  return wall;
}

TEST(Ridges, PatchesSayWhetherTheirsAreOpened) {
  const TriMesh wall = two_wings();
  const std::vector<Rule> wing_only = {{.names = "wing", .options = {{"open_ridges", "always"}}}},
                          not_tail = {{.names = "tail", .options = {{"open_ridges", "never"}}}};
  const auto base_vertices = [&](const char* of_all, const std::vector<Rule>& rules) {
    Domain domain;
    domain.wall = wall;
    open_ridges({}, patches_with_open_ridges(wall.patches, {.open_ridges = of_all}, rules), 1e-3, {}, domain, k_context);
    std::size_t n_behind = 0;
    for (const OpenedRidges::BaseVertex& base_vertex : domain.ridges.base_vertices) n_behind += base_vertex.point.x > 3.0 ? 1 : 0;
    return std::array{domain.ridges.base_vertices.size(), n_behind};
  };
  EXPECT_EQ(base_vertices("always", {}), (std::array<std::size_t, 2>{14, 7}));
  EXPECT_EQ(base_vertices("never", wing_only), (std::array<std::size_t, 2>{7, 0}));
  EXPECT_EQ(base_vertices("always", not_tail), (std::array<std::size_t, 2>{7, 0}));
  MeshCase mesh_case = wing_case(false);
  mesh_case.patches = wing_only;
  const VolumeMeshResult mesh = volume_mesh(wall, mesh_case, k_context);
  EXPECT_TRUE(mesh.check.is_valid());
  EXPECT_GT(mesh.mesh.hexahedra.size(), 0u);
  EXPECT_LT(mesh.layer.visibility.share_above[2], volume_mesh(wall, wing_case(false), k_context).layer.visibility.share_above[2]);
}

TEST(Ridges, EqualForAnyNumberOfThreads) {
  const TriMesh wall = sharp_wing(30.0, 8);
  const VolumeMeshResult one = volume_mesh(wall, wing_case(true), RunContext({.threads = 1}));
  for (const int threads : {2, 7}) {
    const VolumeMeshResult other = volume_mesh(wall, wing_case(true), RunContext({.threads = threads}));
    EXPECT_EQ(other.mesh.points, one.mesh.points);
    EXPECT_EQ(other.mesh.hexahedra, one.mesh.hexahedra);
    EXPECT_EQ(other.mesh.tetrahedra, one.mesh.tetrahedra);
  }
}

TEST(Ridges, HalfModelFansLieInItsPlane) {
  const TriMesh wall = half_sharp_wing(30.0, 6);
  const LayerDomain layer_domain(wall, wing_case(true), k_context);
  const Domain& domain = layer_domain.domain;
  ASSERT_EQ(domain.ridges.base_vertices.size(), 6u);  // up to the plane; the ridge ends at the corner of the tip
  EXPECT_EQ(domain.ridges.end_vertices.size(), 1u);
  const auto in_plane =
      std::ranges::find_if(domain.ridges.base_vertices, [](const OpenedRidges::BaseVertex& base_vertex) { return base_vertex.point.y == 0.0; });
  ASSERT_NE(in_plane, domain.ridges.base_vertices.end());
  EXPECT_EQ(in_plane->middle.y, 0.0);
  int n_lines = 0;
  for (const VertexId v : domain.wall.points.ids()) {
    if (domain.ridges.base_vertex[v] != in_plane->vertex) continue;
    EXPECT_EQ(domain.wall.points[v].y, 0.0);
    EXPECT_EQ(layer_domain.base.constraint[v].freedom, Freedom::plane);
    ++n_lines;
  }
  EXPECT_EQ(n_lines, 6);
  EXPECT_DOUBLE_EQ(in_plane->to_end, 0.6);  // the ridge does not end at the plane
  const VolumeMeshResult closed = volume_mesh(wall, wing_case(false), k_context), open = volume_mesh(wall, wing_case(true), k_context);
  EXPECT_TRUE(open.check.is_valid());
  EXPECT_EQ(wall_faces(open.mesh), wall_faces(closed.mesh));
  EXPECT_NEAR(open.check.dual_volume, closed.check.dual_volume, 1e-11 * closed.check.dual_volume);
  // At the trailing edge in the plane: for each of five sectors a triangle on the wall and quadrilaterals above it.
  int n_triangles = 0;
  for (const sterna::BoundaryTriangle& face : open.mesh.boundary_triangles)
    if (open.mesh.patches[face.patch].kind == PatchKind::symmetry)
      n_triangles += std::ranges::any_of(face.nodes, [&](NodeId n) { return open.mesh.points[n] == in_plane->point; }) ? 1 : 0;
  EXPECT_EQ(n_triangles, 5);
  EXPECT_LT(open.layer.visibility.share_above[2], closed.layer.visibility.share_above[2]);
  for (const int threads : {1, 7}) EXPECT_EQ(volume_mesh(wall, wing_case(true), RunContext({.threads = threads})).mesh.points, open.mesh.points);
  expect_continued(wall, wing_case(true));
}

TEST(Ridges, RidgesBentAtSymmetryPlaneEndBeforeIt) {
  for (const auto& [sweep, n_base_vertices] : {std::pair(0.5, 6), std::pair(1.0, 4)}) {  // tangents: 27 and 45 degrees
    TriMesh wall = half_sharp_wing(30.0, 6);
    for (Point& p : wall.points) p.x += sweep * p.y;
    const LayerDomain layer_domain(wall, wing_case(true), k_context);
    const auto is_inboard = [](const OpenedRidges::BaseVertex& base_vertex) { return base_vertex.point.y < 0.55; };  // the edges of the tip are ridges, too
    EXPECT_EQ(std::ranges::count_if(layer_domain.domain.ridges.base_vertices, is_inboard), n_base_vertices) << sweep;
  }
}

TEST(Ridges, PlacedPartsHaveRidgesOfWholeWall) {
  const TriMesh own = sharp_wing(30.0, 8);
  const Transform pitch = rotation({0, 0, 0}, {0, 1, 0}, 0.3);
  TriMesh wall = own;
  for (Point& p : wall.points) p = pitch.point(p);
  MeshCase mesh_case = wing_case(true);
  const VolumeMeshResult whole = volume_mesh(wall, mesh_case, k_context);
  mesh_case.parts.push_back({std::make_shared<const TriMesh>(own), pitch});
  const VolumeMeshResult placed = volume_mesh(wall, mesh_case, k_context);  // an opened wall no longer matches its part
  EXPECT_TRUE(placed.check.is_valid());
  EXPECT_FALSE(placed.mesh.hexahedra.empty());
  EXPECT_EQ(placed.mesh.points, whole.mesh.points);
  EXPECT_EQ(placed.mesh.tetrahedra, whole.mesh.tetrahedra);
}

TEST(Ridges, BetweenPatchesWithOtherLayers) {
  TriMesh wall = sharp_wing(30.0, 8);
  wall.patches.push_back({"lower", PatchKind::wall});
  for (const TriangleId t : wall.triangles.ids()) {
    const auto [a, b, c] = corners(wall, t);
    if (a.z + b.z + c.z < 0.0) wall.triangle_patch[t] = PatchId(1);
  }
  MeshCase mesh_case = wing_case(true);
  mesh_case.patches = {{.names = "lower", .options = {{"layers", 8}, {"first_height", 2e-3}}}};
  const VolumeMeshResult result = volume_mesh(wall, mesh_case, k_context);
  EXPECT_TRUE(result.check.is_valid());
  EXPECT_FALSE(result.mesh.hexahedra.empty());
}

TEST(Ridges, MembersOfAFamilyHaveThemToo) {
  const TriMesh wall = sharp_wing(30.0, 8);
  MeshCase mesh_case = wing_case(true);
  mesh_case.family = {.refinement = 1.5, .family_wake = "off"};
  const VolumeMeshResult fine = volume_mesh(wall, mesh_case, k_context);
  EXPECT_TRUE(fine.check.is_valid());
  EXPECT_FALSE(fine.mesh.hexahedra.empty());
  EXPECT_EQ(fine.mesh.layers.n_layers, 18);
  EXPECT_DOUBLE_EQ(fine.mesh.request.first_height, 1e-3 / 1.5);
}

TEST(Ridges, EnvelopesOfDeformedWallsStartFromReference) {
  LayerDomain reference(sharp_wing(35.0, 8), wing_case(true), k_context);
  const StartingEnvelope start{reference.base.wall.points, build_envelope(reference.base, reference.options.envelope, reference.collider, k_context)};
  TriMesh bent = sharp_wing(35.0, 8);
  for (Point& p : bent.points) p.z += 0.05 * p.y * p.y;
  bool is_started = false;
  Makers makers;
  makers.wall_envelope = [&](const LayerBase& base, const EnvelopeOptions& options, Collider& collider, const RunContext& context) {
    WarmStart warm = warm_start(base, options, start, collider, context);
    is_started = warm.envelope.has_value();
    EXPECT_TRUE(is_started) << warm.objection;
    return is_started ? std::move(*warm.envelope) : build_envelope(base, options, collider, context);
  };
  const VolumeMeshResult result = watched_volume_mesh(bent, wing_case(true), makers, {}, k_context);
  EXPECT_TRUE(is_started);
  EXPECT_TRUE(result.check.is_valid());
  EXPECT_FALSE(result.mesh.hexahedra.empty());
}

TEST(Ridges, ContinuedMeshesAreTheSame) {
  const Continued all_open = expect_continued(sharp_wing(30.0, 8), wing_case(true));
  EXPECT_FALSE(all_open.whole.mesh.hexahedra.empty());
  EXPECT_EQ(all_open.n_rounds, 0);
}

/// Two rounds: some multi-normal fans have no valid cells and are closed.
TEST(Ridges, ContinuedMeshesWithClosedFansAreTheSame) {
  STERNA_NEEDS_SHARED_DATA();
  const SurfaceSoup soup = io::read_surface_file(test::shared_data() / "surfaces/clean/vspgeom_geom2_geom2.stl", k_context);
  MeshCase mesh_case = layers(20, 1e-4);
  mesh_case.envelope.max_growth = 1.4;  // in lower layers no fan would stay open
  mesh_case.envelope.growth = "local";
  mesh_case.ridges.open_ridges = "always";
  const Continued geom2 = expect_continued(surfmesh::stitch_surface({soup}, {}, k_context).mesh, mesh_case);
  EXPECT_GT(geom2.n_rounds, 0);
  EXPECT_FALSE(geom2.whole.mesh.hexahedra.empty());
}

TEST(Ridges, ClosedFansMustBelongToTheWall) {
  const TriMesh wall = sharp_wing(30.0, 8);
  test::expect_error(ErrorCode::bad_argument, "one run", [&] { opened(wall, {.open_ridges = "always"}, {VertexId(wall.n_vertices())}); });
}

/// Unit cube whose edges all turn by 90 degrees: 12 ridges, 8 corners.
MeshCase cube_case() {
  MeshCase mesh_case = wing_case(true);
  mesh_case.ridges.open_angle = 80.0 * test::k_degree;
  return mesh_case;
}

/// Two flat pyramids on a square of 2 m, base to base: the sharp edges bend by 90 degrees at the four corners; n edges along each side.
TriMesh double_pyramid(int n) {
  TriMesh wall;
  wall.patches.push_back({"wing", PatchKind::wall});
  std::map<std::array<int, 3>, VertexId> vertices;  // by x, y and side; both sides share the vertices of the square
  const auto vertex = [&](int x, int y, int side) {
    const int ring = std::abs(x) + std::abs(y);
    const auto [at, is_new] = vertices.try_emplace({x, y, ring == n ? 0 : side});
    if (is_new) at->second = wall.points.push_back({1.0 * x / n, 1.0 * y / n, side * 0.3 * (n - ring) / n});
    return at->second;
  };
  for (const int side : {1, -1})
    for (int quarter = 0; quarter < 4; ++quarter) {
      const auto at = [&](int along, int across) {  // along: from one axis, across: from the next axis
        const std::array<std::array<int, 2>, 4> turned = {{{along, across}, {-across, along}, {-along, -across}, {across, -along}}};
        return vertex(turned[static_cast<std::size_t>(quarter)][0], turned[static_cast<std::size_t>(quarter)][1], side);
      };
      const auto add = [&](VertexId a, VertexId b, VertexId c) {
        wall.triangles.push_back(side > 0 ? TriangleVertices{a, b, c} : TriangleVertices{a, c, b});
        wall.triangle_patch.push_back(PatchId(0));
      };
      for (int i = 0; i < n; ++i)
        for (int j = 0; i + j < n; ++j) {
          add(at(i, j), at(i + 1, j), at(i, j + 1));
          if (i + j + 1 < n) add(at(i + 1, j), at(i + 1, j + 1), at(i, j + 1));
        }
    }
  return wall;
}

void expect_opened_wall_is_the_given_one(const TriMesh& wall, const Domain& domain) {
  const OpenedRidges& ridges = domain.ridges;
  const Topology topology(domain.wall, k_context);
  EXPECT_EQ(topology.n_boundary_halfedges(), 0u);
  const auto euler = [](const TriMesh& mesh) { return 2 * static_cast<std::int64_t>(mesh.n_vertices()) - static_cast<std::int64_t>(mesh.n_triangles()); };
  EXPECT_EQ(euler(domain.wall), euler(wall));
  ASSERT_EQ(ridges.n_given_triangles, wall.n_triangles());
  for (const TriangleId t : wall.triangles.ids())
    for (std::size_t k = 0; k < 3; ++k) EXPECT_EQ(ridges.base_vertex[domain.wall.triangles[t][k]], wall.triangles[t][k]);
  for (const auto& t : ridges.corners)
    for (const VertexId v : t) EXPECT_EQ(ridges.base_vertex[v], ridges.base_vertex[t[0]]);
}

TEST(Ridges, MeetInCorners) {
  const TriMesh wall = test::cube(6);
  const RidgeOptions options = cube_case().ridges;
  const Domain domain = opened(wall, options);
  expect_opened_wall_is_the_given_one(wall, domain);
  EXPECT_EQ(domain.ridges.base_vertices.size(), 12u * 5u + 8u);
  EXPECT_TRUE(domain.ridges.ends.empty());
  EXPECT_EQ(domain.ridges.corners.size(), 8u * 3u * 3u);  // 90 degrees in three sectors on each of three ridges
  EXPECT_EQ(domain.wall.n_vertices(), wall.n_vertices() + 12 * 5 * 3 + 8 * 9);
  // The middle growth line of a corner makes equal angles with all three sides.
  const VertexId first = domain.ridges.base_vertex[domain.ridges.corners.front()[2]];
  const auto base_vertex = std::ranges::find(domain.ridges.base_vertices, first, &OpenedRidges::BaseVertex::vertex);
  EXPECT_NEAR(base_vertex->visibility, 1.0 / std::sqrt(3.0), 1e-12);
  // Ridges end at a corner that is to stay closed.
  const VertexId closed = domain.ridges.base_vertex[domain.ridges.corners.front()[0]];
  const Domain parted = opened(wall, options, {closed});
  expect_opened_wall_is_the_given_one(wall, parted);
  EXPECT_EQ(parted.ridges.end_vertices, std::vector<VertexId>{closed});
  EXPECT_EQ(parted.ridges.corners.size(), 7u * 3u * 3u);
}

TEST(Ridges, EdgesBetweenTwoCornersAreOpenedToo) {
  const TriMesh wall = test::cube(1);  // no vertex inside a ridge
  const Domain domain = opened(wall, cube_case().ridges);
  expect_opened_wall_is_the_given_one(wall, domain);
  EXPECT_EQ(domain.ridges.base_vertices.size(), 8u);
  EXPECT_EQ(domain.ridges.quads.size(), 12u * 3u);
}

TEST(Ridges, BendAroundCornersOfSharpEdges) {
  const TriMesh wall = double_pyramid(6);
  const Domain domain = opened(wall, {.open_ridges = "always"});
  expect_opened_wall_is_the_given_one(wall, domain);
  EXPECT_EQ(domain.ridges.base_vertices.size(), 4u * 6u);
  EXPECT_TRUE(domain.ridges.ends.empty());
  EXPECT_FALSE(domain.ridges.corners.empty());
}

TEST(Ridges, ArrowsHaveACornerAndNotchesHaveNone) {
  for (const auto& [sweep, n_triangles] : {std::pair(-1.0, 2 * 5), std::pair(1.0, 0)}) {  // swept forward and back by 45 degrees; the tips have corners, too
    TriMesh wall = sharp_wing(30.0, 8);
    for (Point& p : wall.points) p.x += sweep * std::abs(p.y - 0.4);
    const Domain domain = opened(wall, {.open_ridges = "always"});
    expect_opened_wall_is_the_given_one(wall, domain);
    EXPECT_EQ(std::ranges::count_if(domain.ridges.corners, [&](const auto& t) { return std::abs(domain.wall.points[t[0]].y - 0.4) < 1e-3; }), n_triangles)
        << sweep;
    EXPECT_TRUE(volume_mesh(wall, wing_case(true), k_context).check.is_valid()) << sweep;
  }
}

/// If its trailing edge were opened, the wall would cross the round nose of a second wing just behind it: the multi-normal fans of the first wing stay closed,
/// and the mesh is made.
TEST(Ridges, ThatWouldCrossTheWallStayClosed) {
  TriMesh wall = sharp_wing(30.0, 8), beside = wall;
  for (Point& p : beside.points)
    p.x += 1.0 + std::tan(15.0 * test::k_degree) + 5e-6;  // a round nose closer to the trailing edge than the distance by which
                                                          // growth lines are raised
  append(wall, beside);
  const Domain domain = opened(wall, {.open_ridges = "always"});
  EXPECT_EQ(domain.ridges.base_vertices.size(), 7u);  // only the second wing is opened
  for (const OpenedRidges::BaseVertex& base_vertex : domain.ridges.base_vertices) EXPECT_GT(base_vertex.point.x, 1.5);
}

TEST(Ridges, MeshesWithCornersAreValidAndKeepWall) {
  MeshCase closed_case = cube_case();
  closed_case.ridges.open_ridges = "never";
  const TriMesh tip = sharp_wing(30.0, 8);
  for (const TriMesh& wall : {test::cube(6), double_pyramid(6), tip}) {
    const VolumeMeshResult closed = volume_mesh(wall, closed_case, k_context), open = volume_mesh(wall, cube_case(), k_context);
    EXPECT_TRUE(open.check.is_valid());
    EXPECT_EQ(wall_faces(open.mesh), wall_faces(closed.mesh));
    EXPECT_NEAR(open.check.dual_volume, closed.check.dual_volume, 1e-11 * closed.check.dual_volume);
    EXPECT_LT(open.layer.visibility.max_angle, 45.0 * test::k_degree);
    const CheckReport all_explicit = check(explicit_cells(open.mesh), {}, k_context);
    EXPECT_TRUE(all_explicit.is_valid());
    EXPECT_EQ(all_explicit.cells.total(), open.check.cells.total());
    for (const int threads : {1, 7}) EXPECT_EQ(volume_mesh(wall, cube_case(), RunContext({.threads = threads})).mesh.points, open.mesh.points);
  }
  expect_continued(test::cube(6), cube_case());
}

}  // namespace
}  // namespace sterna::volmesh
