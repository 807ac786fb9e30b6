// Open terrain surfaces: sides and a lid are added, layers grow on the terrain and end on the sides.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <functional>
#include <map>
#include <string>

#include "geom/base/error.h"
#include "geom/math/measures.h"
#include "geom/mesh/topology.h"
#include "tests/support/error_of.h"
#include "tests/support/test_shapes.h"
#include "tests/volmesh/domain/room.h"
#include "volmesh/domain/complete_boundary.h"
#include "volmesh/volume_mesh.h"

namespace sterna::volmesh {
namespace {

using testing::HasSubstr;

constexpr int k_cells_x = 24, k_cells_y = 18;
constexpr double k_cell = 0.25;   ///< m
constexpr double k_house = 0.75;  ///< m, height
constexpr double k_lid = 4.0;     ///< m

bool is_house(int i, int j) { return i >= 10 && i < 14 && j >= 8 && j < 11; }

/// Terrain of 6 x 4.5 m with hills; with `has_house` the house is part of the surface, on level ground.
TriMesh terrain(bool has_house) {
  TriMesh mesh;
  mesh.patches = Column<PatchId, Patch>{{"terrain", PatchKind::wall}, {"house", PatchKind::wall}};
  std::map<std::array<int, 3>, VertexId> vertices;
  const auto at = [&](int i, int j, int storey) {
    const auto [found, is_new] = vertices.try_emplace({i, j, storey}, VertexId(0));
    if (is_new) {
      const double x = k_cell * i, y = k_cell * j, r = std::hypot(x - 3.0, y - 2.375);
      const double hills = 0.3 * std::sin(1.3 * x) * std::cos(1.1 * y) * std::min(1.0, std::max(0.0, r - 0.9));
      found->second = mesh.points.push_back({x, y, hills + k_house * storey});
    }
    return found->second;
  };
  const auto quad = [&](VertexId a, VertexId b, VertexId c, VertexId d, std::uint32_t patch) {
    mesh.triangles.push_back({a, b, c});
    mesh.triangles.push_back({a, c, d});
    mesh.triangle_patch.push_back(PatchId(patch));
    mesh.triangle_patch.push_back(PatchId(patch));
  };
  const auto storey = [&](int i, int j) { return has_house && is_house(i, j) ? 1 : 0; };
  // The walls of the house are three cells high.
  const auto wall = [&](int i, int j, int k, int l) {
    for (int level = 0; level < 3; ++level) {
      const auto point = [&](int m, int n, int h) {
        if (h == 0 || h == 3) return at(m, n, h / 3);
        const auto [found, is_new] = vertices.try_emplace({m, n, 10 + h}, VertexId(0));
        if (is_new) {
          Point p = mesh.points[at(m, n, 0)];
          p.z += k_house * h / 3.0;
          found->second = mesh.points.push_back(p);
        }
        return found->second;
      };
      quad(point(i, j, level), point(k, l, level), point(k, l, level + 1), point(i, j, level + 1), 1);
    }
  };
  for (int i = 0; i < k_cells_x; ++i)
    for (int j = 0; j < k_cells_y; ++j) {
      const int s = storey(i, j);
      quad(at(i, j, s), at(i + 1, j, s), at(i + 1, j + 1, s), at(i, j + 1, s), s == 1 ? 1 : 0);
      if (s == 0) continue;
      if (!is_house(i - 1, j)) wall(i, j + 1, i, j);
      if (!is_house(i + 1, j)) wall(i + 1, j, i + 1, j + 1);
      if (!is_house(i, j - 1)) wall(i, j, i + 1, j);
      if (!is_house(i, j + 1)) wall(i + 1, j + 1, i, j + 1);
    }
  return mesh;
}

/// Volume of the fluid between the terrain and the lid: the sum over columns on triangles.
double columns_of(const TriMesh& sheet, double lid) {
  double volume = 0.0;
  for (const TriangleId t : sheet.triangles.ids()) {
    const auto [a, b, c] = corners(sheet, t);
    volume += area_vector(a, b, c).z * (lid - (a.z + b.z + c.z) / 3.0);
  }
  return volume;
}

MeshCase case_over_floor(int n_layers, const std::string& floor = "terrain") {
  MeshCase options = layers(n_layers, 5e-3);
  options.farfield.farfield_shape = "box";
  options.farfield.farfield_floor = floor;
  options.farfield.farfield_to_z = k_lid;
  return options;
}

TEST(Floor, TerrainWithHouseGetsSidesAndLid) {
  const TriMesh sheet = terrain(true);
  for (const int n_layers : {8, 0}) {
    MeshCase options = case_over_floor(n_layers);
    options.farfield.farfield_sides = parse_sides("x_min=inflow x_max=outflow y_min=slip,name:sides y_max=slip,name:sides");
    const VolumeMeshResult result = volume_mesh(sheet, options, RunContext({.threads = 2}));
    EXPECT_TRUE(result.check.is_valid()) << to_text(result.check);
    const double expected = columns_of(sheet, k_lid);
    EXPECT_NEAR(result.check.total_volume, expected, 1e-9 * expected) << n_layers;
    Edges borders = border_edges(result);
    if (n_layers == 0) {
      EXPECT_EQ(count_cells(result.mesh).prisms, 0);
      continue;
    }
    EXPECT_GT(count_cells(result.mesh).prisms, 0);
    EXPECT_GT(result.layer.coverage, 0.9);
    // The sides contain the column faces on all edges of the open boundary; the lid contains none.
    EXPECT_EQ(borders["inflow"], static_cast<std::size_t>(k_cells_y));
    EXPECT_EQ(borders["outflow"], static_cast<std::size_t>(k_cells_y));
    EXPECT_EQ(borders["sides"], static_cast<std::size_t>(2 * k_cells_x));
    EXPECT_EQ(borders["farfield"], 0u);
    for (const auto& face : result.mesh.boundary_triangles) {
      const Patch& patch = result.mesh.patches[face.patch];
      const double x = patch.name == "inflow" ? 0.0 : 6.0;
      if (patch.name != "inflow" && patch.name != "outflow") continue;
      for (const NodeId node : face.nodes) EXPECT_EQ(result.mesh.points[node].x, x);
    }
  }
}

TEST(Floor, BodiesAboveTheTerrainAreInTheBox) {
  TriMesh sheet = terrain(false);
  const double without = columns_of(sheet, k_lid);
  TriMesh body = test::sphere(3);
  for (Point& p : body.points) p = Vec3{3.0, 2.2, 1.5} + 0.5 * p;
  body.patches = Column<PatchId, Patch>{{"balloon", PatchKind::wall}};
  body.triangle_patch.assign(body.n_triangles(), PatchId(0));
  append(sheet, body);
  const VolumeMeshResult result = volume_mesh(sheet, case_over_floor(5), RunContext({.threads = 2}));
  EXPECT_TRUE(result.check.is_valid()) << to_text(result.check);
  const double expected = without - test::volume_of(body);
  EXPECT_NEAR(result.check.total_volume, expected, 1e-9 * expected);
  // Sides and lid are one patch unless rules separate them.
  EXPECT_EQ(border_edges(result)["farfield"], static_cast<std::size_t>(2 * (k_cells_x + k_cells_y)));

  for (Point& p : body.points) p.z -= 5.0;
  TriMesh below = terrain(false);
  append(below, body);
  test::expect_error(ErrorCode::bad_argument, "closed parts are below the floor", [&] { volume_mesh(below, case_over_floor(5), {}); });
}

TEST(Floor, VerticalAxisAndLidAreFound) {
  TriMesh sheet = terrain(false);
  for (Point& p : sheet.points) p = {p.y, p.z, p.x};  // y is up
  MeshCase options = case_over_floor(0, "terr*");
  options.farfield.farfield_to_z = k_automatic;
  const TriMesh whole = complete_boundary(sheet, {options.farfield}, RunContext({.threads = 1}));
  const Box of_sheet = bounding_box(sheet), box = bounding_box(whole);
  EXPECT_NEAR(box.max.y, of_sheet.max.y + 3.0, 1e-12);  // half of 6 m above the highest point
  EXPECT_EQ(box.max.x, 4.5);
  EXPECT_EQ(box.max.z, 6.0);
  EXPECT_EQ(Topology(whole, {}).n_boundary_halfedges(), 0u);
}

TEST(Floor, RimsNearTheSidesAreMovedIntoThem) {
  TriMesh sheet = terrain(false);
  for (Point& p : sheet.points)
    if (p.x == 0.0) p.x = 2e-4 * std::sin(40.0 * p.y);
  FarfieldOptions farfield = case_over_floor(0).farfield;
  farfield.farfield_from_x = 0.0;
  const TriMesh whole = complete_boundary(sheet, {farfield}, RunContext({.threads = 1}));
  EXPECT_EQ(bounding_box(whole).min.x, 0.0);
}

TEST(Floor, MistakesAreErrorsWithPlaces) {
  using Options = FarfieldOptions;
  const Options usual = case_over_floor(0).farfield;
  const auto refused = [&](
                           const TriMesh& mesh, ErrorCode code, const char* text, const std::function<void(Options&)>& change = [](Options&) {}) {
    Options options = usual;
    change(options);
    test::expect_error(code, text, [&] { complete_boundary(mesh, {options}, RunContext({.threads = 1})); });
  };
  const TriMesh sheet = terrain(false);
  TriMesh bent = sheet, turned = sheet;
  for (Point& p : bent.points)
    if (p.x == 6.0 && p.y == 2.0) p.x = 5.8;
  for (TriangleVertices& t : turned.triangles) std::swap(t[1], t[2]);
  refused(bent, ErrorCode::open_surface, "2 of 84 border edges of the floor \"terrain\" lie in none of the vertical sides of the box");
  refused(bent, ErrorCode::open_surface, "the border of the floor is 0.2 m from the nearest side, x_max at x = 6 m");
  refused(turned, ErrorCode::bad_argument, "normals of the floor point downwards");
  refused(sheet, ErrorCode::open_surface, "place the box corners at the corners of the floor", [](Options& o) { o.farfield_to_x = 8.0; });
  refused(sheet, ErrorCode::bad_argument, "no patch \"ground\"", [](Options& o) { o.farfield_floor = "ground"; });
  refused(sheet, ErrorCode::bad_argument, "a floor needs farfield = box{ floor = ... }", [](Options& o) { o.farfield_shape = "sphere"; });
  refused(sheet, ErrorCode::bad_argument, "the shape \"box\" does not have farfield_radius = 5", [](Options& o) { o.farfield_radius = 5.0; });
  refused(sheet, ErrorCode::bad_argument, "the box begins at z = 2 m, above the lowest point", [](Options& o) { o.farfield_from_z = 2.0; });
  refused(sheet, ErrorCode::bad_argument, "there is no side \"z_min\"", [](Options& o) { o.farfield_sides = parse_sides("z_min=wall"); });
  refused(terrain(true), ErrorCode::bad_argument, "raise the upper corner of the box", [](Options& o) { o.farfield_to_z = 0.1; });
  refused(test::cube(2), ErrorCode::bad_argument, "its surface is closed", [](Options& o) { o.farfield_floor = "*"; });
}

}  // namespace
}  // namespace sterna::volmesh
