// Planes of half models on which no layer ends: separate vertices, for symmetry planes and for the ground; corners of patches on which layers end; cavities.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <numbers>
#include <string>

#include "geom/base/error.h"
#include "geom/mesh/volume_regions.h"
#include "tests/support/halves.h"
#include "tests/support/test_shapes.h"
#include "tests/volmesh/domain/room.h"
#include "volmesh/domain/complete_boundary.h"
#include "volmesh/volume_mesh.h"

namespace sterna::volmesh {
namespace {

using testing::HasSubstr;

TriMesh half_ball(std::size_t axis = 1) {
  TriMesh mesh = test::cut_off(test::sphere(8), axis, 0.0);
  mesh.patches = Column<PatchId, Patch>{{"ball", PatchKind::wall}};
  mesh.triangle_patch.assign(mesh.n_triangles(), PatchId(0));
  return mesh;
}

MeshCase case_of(int n_layers, const std::string& shape = "sphere") {
  MeshCase options = layers(n_layers, 1e-3);
  options.farfield.farfield_shape = shape;
  if (shape == "sphere") options.farfield.farfield_radius = 20.0;
  return options;
}

/// Edge lengths of the triangles of a patch in its plane.
struct PatchEdges {
  std::size_t n_triangles = 0;
  double longest_near = 0.0;  ///< m, edge of a triangle that touches the circle of radius 1.5 about the origin
  double longest = 0.0;
};

PatchEdges edges_of(const HybridMesh& mesh, const std::string& name) {
  PatchEdges edges;
  for (const auto& face : mesh.boundary_triangles) {
    if (mesh.patches[face.patch].name != name) continue;
    ++edges.n_triangles;
    double longest = 0.0;
    bool is_near = false;
    for (std::size_t k = 0; k < 3; ++k) {
      longest = std::max(longest, distance(mesh.points[face.nodes[k]], mesh.points[face.nodes[(k + 1) % 3]]));
      is_near = is_near || norm(mesh.points[face.nodes[k]]) < 1.5;
    }
    edges.longest = std::max(edges.longest, longest);
    if (is_near) edges.longest_near = std::max(edges.longest_near, longest);
  }
  return edges;
}

VolumeMeshResult meshed_half(const MeshCase& options, std::string* log = nullptr, std::size_t axis = 1) {
  const RunContext context({.threads = 2, .log = [&](LogLevel, std::string_view line) {
                              if (log) *log += std::string(line) + "\n";
                            }});
  VolumeMeshResult result = volume_mesh(half_ball(axis), options, context);
  EXPECT_TRUE(result.check.is_valid()) << to_text(result.check);
  return result;
}

TEST(BarePlanes, InviscidHalfModelHasGradedSymmetryPlane) {
  std::string log;
  const VolumeMeshResult result = meshed_half(case_of(0), &log);
  EXPECT_EQ(count_cells(result.mesh).prisms, 0);
  EXPECT_THAT(log, HasSubstr("no patch carries layers: the mesh has only tetrahedra"));
  const PatchEdges edges = edges_of(result.mesh, "symmetry");
  EXPECT_GT(edges.n_triangles, 200u);
  EXPECT_LT(edges.longest_near, 0.6);  // from edges of 0.15 on the ball; before the fix 19, from the ball to the farfield
  EXPECT_LT(result.check.gate(Measure::sub_volume_ratio).worst, 1e3);
}

TEST(BarePlanes, WallsWithoutLayersBesideOthers) {
  // Two balls: the ball at the plane has no layers.
  TriMesh wall = half_ball();
  TriMesh other = test::sphere(4);
  for (Point& p : other.points) p += Vec3{0.0, 4.0, 0.0};
  other.patches = Column<PatchId, Patch>{{"pod", PatchKind::wall}};
  other.triangle_patch.assign(other.n_triangles(), PatchId(0));
  append(wall, other);
  MeshCase options = case_of(5);
  options.patches = {{.names = "ball", .options = {{"layers", 0}}}};
  const VolumeMeshResult result = volume_mesh(wall, options, RunContext({.threads = 2}));
  EXPECT_TRUE(result.check.is_valid()) << to_text(result.check);
  EXPECT_GT(count_cells(result.mesh).prisms, 0);
  EXPECT_LT(edges_of(result.mesh, "symmetry").longest_near, 0.6);
}

TEST(BarePlanes, GroundPlaneHasLayersAndOwnEdges) {
  for (const int n_layers : {0, 6}) {
    MeshCase options = case_of(6, "box");
    options.farfield.farfield_from_x = options.farfield.farfield_from_y = -8.0;
    options.farfield.farfield_to_x = options.farfield.farfield_to_y = options.farfield.farfield_to_z = 8.0;
    options.farfield.farfield_edge = 2.0;
    options.farfield.farfield_sides = parse_sides("symmetry=wall,name:ground,edge:0.7");
    if (n_layers == 0) options.patches = {{.names = "ground", .options = {{"layers", 0}}}};
    const VolumeMeshResult result = meshed_half(options, nullptr, 2);
    const PatchEdges edges = edges_of(result.mesh, "ground");
    EXPECT_LT(edges.longest, 1.3) << n_layers;
    EXPECT_GT(edges.n_triangles, 800u) << n_layers;
    EXPECT_LT(edges.longest_near, 0.6) << n_layers;
    // The farfield is one patch again, although layers end on four of its sides.
    EXPECT_EQ(result.mesh.patches.size(), 3u);
    if (n_layers > 0) {
      EXPECT_EQ(border_edges(result).size(), 1u);
      EXPECT_GT(border_edges(result)["farfield"], 40u);
      EXPECT_GT(result.layer.coverage, 0.95);
    }
  }
}

TEST(BarePlanes, GroundPlaneBetweenInflowAndOutflow) {
  // The remainder of the box is one patch of two sides and the lid, none of whose corners is on the ground.
  MeshCase options = case_of(6, "box");
  options.farfield.farfield_from_x = options.farfield.farfield_from_y = -8.0;
  options.farfield.farfield_to_x = options.farfield.farfield_to_y = options.farfield.farfield_to_z = 8.0;
  options.farfield.farfield_edge = 2.0;
  options.farfield.farfield_sides = parse_sides("symmetry=wall,name:ground,edge:0.7 x_min=inflow x_max=outflow");
  const VolumeMeshResult result = meshed_half(options, nullptr, 2);
  EXPECT_EQ(result.mesh.patches.size(), 5u);
  std::map<std::string, std::size_t> borders = border_edges(result);
  EXPECT_EQ(borders.size(), 3u);
  EXPECT_GT(borders["farfield"], 20u);
  EXPECT_GT(result.layer.coverage, 0.95);
}

TEST(BarePlanes, EdgesOfASymmetryPlaneAreTheUsers) {
  MeshCase options = case_of(6);
  const double usual = edges_of(meshed_half(options).mesh, "symmetry").longest;
  options.farfield.farfield_sides = parse_sides("symmetry=edge:1");
  const PatchEdges fine = edges_of(meshed_half(options).mesh, "symmetry");
  EXPECT_GT(fine.n_triangles, 800u);
  EXPECT_LE(fine.longest, 1.1 * usual);
}

TEST(BarePlanes, EdgesThatHaveNoEffectAreErrors) {
  MeshCase options = case_of(6);
  options.farfield.farfield_sides = parse_sides("farfield=edge:1");
  try {
    meshed_half(options);
    ADD_FAILURE() << "no error";
  } catch (const Error& error) {
    EXPECT_THAT(error.what(), HasSubstr("the edge length of \"farfield\" has no effect"));
  }
}

/// A bar along y from 0 to 1, open at both ends.
TriMesh bar() {
  constexpr std::uint32_t k_around = 16, k_rows = 4;
  TriMesh mesh;
  for (std::uint32_t j = 0; j <= k_rows; ++j)
    for (std::uint32_t i = 0; i < k_around; ++i) {
      const double angle = 2.0 * std::numbers::pi * i / k_around;
      mesh.points.push_back({0.5 * std::cos(angle), static_cast<double>(j) / k_rows, 0.5 * std::sin(angle)});
    }
  for (std::uint32_t j = 0; j < k_rows; ++j)
    for (std::uint32_t i = 0; i < k_around; ++i) {
      const VertexId a(j * k_around + i), b(j * k_around + (i + 1) % k_around), c(b.value() + k_around), d(a.value() + k_around);
      mesh.triangles.push_back({a, c, b});
      mesh.triangles.push_back({a, d, c});
    }
  mesh.patches = Column<PatchId, Patch>{{"bar", PatchKind::wall}};
  mesh.triangle_patch.assign(mesh.n_triangles(), PatchId(0));
  return mesh;
}

TEST(BarePlanes, PeriodicPlanesGetABox) {
  std::string log;
  const RunContext context({.threads = 2, .log = [&](LogLevel, std::string_view line) { log += std::string(line) + "\n"; }});
  for (const int n_layers : {0, 4}) {
    MeshCase options = layers(n_layers, 1e-3);
    options.farfield.farfield_radius = 10.0;
    options.periodic = {{"symmetry_y_min", "symmetry_y_max"}};
    const VolumeMeshResult result = volume_mesh(bar(), options, context);
    EXPECT_EQ(result.check.periodic.size(), 1u);
    EXPECT_THAT(log, HasSubstr("the farfield is a box, 10 m around the middle of the walls"));
    EXPECT_THAT(log, testing::Not(HasSubstr("is not the mirror image")));
  }
}

TEST(FluidRegions, SealedCavitiesAreTold) {
  // A ball with a cavity: its inside is fluid that no flow reaches.
  TriMesh wall = test::sphere(6);
  TriMesh hollow = test::sphere(4, 0.4);
  for (TriangleVertices& t : hollow.triangles) std::swap(t[1], t[2]);
  hollow.patches = Column<PatchId, Patch>{{"hollow", PatchKind::wall}};
  hollow.triangle_patch.assign(hollow.n_triangles(), PatchId(0));
  append(wall, hollow);
  std::string log;
  const RunContext context({.threads = 2, .log = [&](LogLevel level, std::string_view line) {
                              if (level == LogLevel::warning) log += std::string(line) + "\n";
                            }});
  const VolumeMeshResult result = volume_mesh(wall, case_of(3), context);
  EXPECT_THAT(log, HasSubstr("the inside of \"hollow\" is a sealed cavity of 0.2"));
  EXPECT_THAT(log, HasSubstr("about (0, 0, 0), 0.8 m long"));
  EXPECT_THAT(log, HasSubstr("the fluid consists of 2 regions that are not connected"));
  const std::vector<VolumeRegion> regions = volume_regions(result.mesh);
  ASSERT_EQ(regions.size(), 2u);
  EXPECT_NEAR(regions[0].volume + regions[1].volume, result.check.total_volume, 1e-9 * result.check.total_volume);
  EXPECT_NEAR(regions[1].volume, 0.25, 0.02);
  EXPECT_THAT(regions[1].patches, testing::ElementsAre("hollow"));
  EXPECT_THAT(describe_regions(regions), HasSubstr("2 that are not connected"));
}

TEST(FluidRegions, BodiesAreNone) {
  TriMesh wall = test::sphere(4);
  TriMesh other = test::sphere(4);
  for (Point& p : other.points) p += Vec3{0.0, 4.0, 0.0};
  append(wall, other);
  const VolumeMeshResult result = volume_mesh(wall, case_of(3), RunContext({.threads = 2}));
  EXPECT_EQ(volume_regions(result.mesh).size(), 1u);
  EXPECT_EQ(describe_regions(volume_regions(result.mesh)), "");
}

}  // namespace
}  // namespace sterna::volmesh
