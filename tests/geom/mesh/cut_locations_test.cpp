// Locations for pictures, found by the shape of the walls, on bodies where the right locations are known.
#include "geom/mesh/cut_locations.h"

#include <gmock/gmock.h>

#include <cmath>

#include "tests/support/hybrid_shapes.h"
#include "tests/support/test_constants.h"
#include "tests/support/test_shapes.h"

namespace sterna {
namespace {

using namespace test;
using testing::Contains;
using testing::Not;

using test::k_context;

std::vector<std::string> names_of(const std::vector<CutLocation>& locations) {
  std::vector<std::string> names;
  for (const CutLocation& location : locations) names.push_back(location.name);
  return names;
}

const CutLocation& location_of(const std::vector<CutLocation>& locations, const std::string& name) {
  for (const CutLocation& location : locations)
    if (location.name == name) return location;
  throw std::runtime_error("there is no place " + name);
}

/// Checks the guarantees of the header: planes pass through walls, and layer cells are visible around the focus.
void expect_cells_in_sight(const HybridMesh& mesh, const std::vector<CutLocation>& locations) {
  EXPECT_GE(locations.size(), 3u);
  for (const CutLocation& location : locations) {
    SCOPED_TRACE(location.name);
    EXPECT_GT(location.radius, 0.0);
    EXPECT_NEAR(dot(location.focus - location.plane.origin, location.plane.normal), 0.0, 1e-12);
    CutPlane plane = location.plane;
    plane.limits = CutLimits{location.focus, location.radius};
    const MeshCut cut = cut_mesh(mesh, plane, k_context);
    const auto is_layer = [](const CutPolygon& polygon) { return polygon.is_in_layer; };
    EXPECT_GT(std::count_if(cut.polygons.begin(), cut.polygons.end(), is_layer), 0);
  }
}

HybridMesh wing() {
  TriMesh wall = sphere(10);
  for (Point& p : wall.points) p = {p.x, 5.0 * p.y, 0.1 * p.z};
  return extrude(wall, rays_from(wall, {}), {.layer_height = 0.1});
}

TEST(CutPlaces, OfAWing) {
  const HybridMesh mesh = wing();
  const std::vector<CutLocation> locations = automatic_cuts(mesh, k_context);
  expect_cells_in_sight(mesh, locations);
  const double chord = std::sqrt(1.0 - 0.55 * 0.55);
  const CutLocation &leading = location_of(locations, "leading edge"), &trailing = location_of(locations, "trailing edge"),
                    &tip = location_of(locations, "tip");
  EXPECT_NEAR(leading.focus.y, 0.55 * 5.0, 1e-12);
  EXPECT_NEAR(leading.focus.x, -chord, 0.02);
  EXPECT_NEAR(trailing.focus.x, chord, 0.02);
  EXPECT_NEAR(tip.focus.y, 5.0, 1e-12);
  EXPECT_LT(leading.radius, 3.0);
  EXPECT_THAT(names_of(locations), Contains("middle plane"));
  EXPECT_THAT(names_of(locations), Not(Contains("junction")));
}

TEST(CutPlaces, OfAnyBody) {
  for (const HybridMesh& mesh : {sphere_shell(1), sphere_shell(4), cube_shell(2), plate_block(3), two_shells(2, 2, 3), hexahedra_block(2)}) {
    const std::vector<CutLocation> locations = automatic_cuts(mesh, k_context);
    expect_cells_in_sight(mesh, locations);
    EXPECT_THAT(names_of(locations), Not(Contains("tip")));
  }
  EXPECT_THAT(names_of(automatic_cuts(cube_shell(2), k_context)), Contains("sharp edge"));
}

TEST(CutPlaces, OfExplicitCellsAreTheSame) {
  const HybridMesh mesh = wing();
  const auto columns = automatic_cuts(mesh, k_context), cells = automatic_cuts(explicit_cells(mesh), k_context);
  EXPECT_EQ(names_of(columns), names_of(cells));
  for (std::size_t i = 0; i < columns.size(); ++i) EXPECT_EQ(columns[i].plane.origin, cells[i].plane.origin);
}

TEST(CutPlaces, SymmetryPlaneIsAHairInside) {
  HybridMesh mesh = plate_block(4);
  mesh.patches[PatchId(2)] = {"side", PatchKind::symmetry};  // all four sides are symmetry planes; the first one found is used
  const CutLocation location = location_of(automatic_cuts(mesh, k_context), "symmetry plane");
  const Point middle{0.5, 0.5, 0.5};
  EXPECT_LT(dot(middle - location.plane.origin, location.plane.normal), 0.0);
  EXPECT_NEAR(std::abs(dot(middle - location.plane.origin, location.plane.normal)), 0.5, 1e-6);
}

TEST(CutPlaces, JunctionIsConcaveEdgeBetweenPatches) {
  // A step: floor z = 0 for x < 0, riser x = 0, top z = 1. Only the edge at x = z = 0 is concave.
  HybridMesh mesh;
  for (const char* name : {"floor", "riser"}) mesh.patches.push_back({name, PatchKind::wall});
  const std::array<std::array<double, 2>, 4> profile = {{{-1, 0}, {0, 0}, {0, 1}, {1, 1}}};
  for (const auto& [x, z] : profile)
    for (int j = 0; j <= 4; ++j) mesh.points.push_back({x, static_cast<double>(j), z});
  for (int i = 0; i < 3; ++i)
    for (int j = 0; j < 4; ++j) {
      const NodeId a(5 * i + j), b(5 * i + j + 1), c(5 * i + 5 + j + 1), d(5 * i + 5 + j);
      mesh.boundary_quads.push_back({{a, b, c, d}, PatchId(i == 0 ? 0 : 1)});  // normals point out of the fluid, which is above
    }
  const CutLocation location = location_of(automatic_cuts(mesh, k_context), "junction");
  EXPECT_EQ(location.focus.x, 0.0);
  EXPECT_EQ(location.focus.z, 0.0);
  EXPECT_NEAR(std::abs(location.plane.normal.y), 1.0, 1e-15);
}

TEST(CutPlaces, OfNothing) { EXPECT_TRUE(automatic_cuts(HybridMesh{}, k_context).empty()); }

}  // namespace
}  // namespace sterna
