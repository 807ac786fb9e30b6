// Sections of volume meshes: they tile the section of the domain for any position of the plane.
#include "geom/mesh/cut.h"

#include <gtest/gtest.h>

#include <cmath>
#include <map>
#include <numbers>
#include <random>

#include "geom/base/error.h"
#include "geom/math/measures.h"
#include "tests/support/hybrid_shapes.h"
#include "tests/support/test_constants.h"

namespace sterna {
namespace {

using namespace test;

using test::k_context;

Vec3 area_of(std::span<const Point> corners) {
  Vec3 sum;
  for (std::size_t k = 1; k + 1 < corners.size(); ++k) sum += area_vector(corners[0], corners[k], corners[k + 1]);
  return sum;
}

/// Returns the sum of areas. Each polygon must be right-handed about the normal and lie in the plane.
double total_area(const MeshCut& cut, const CutPlane& plane) {
  const Vec3 normal = normalized(plane.normal);
  double sum = 0.0;
  for (std::size_t i = 0; i < cut.size(); ++i) {
    const double area = dot(area_of(cut.corners_of(i)), normal);
    EXPECT_GE(area, -1e-15) << "polygon " << i;
    sum += area;
    for (const Point& p : cut.corners_of(i)) EXPECT_NEAR(dot(p - plane.origin, normal), 0.0, 1e-14);
  }
  return sum;
}

bool is_inside(std::span<const Point> corners, const Vec3& normal, const Point& p) {
  for (std::size_t k = 0; k < corners.size(); ++k)
    if (dot(cross(corners[(k + 1) % corners.size()] - corners[k], p - corners[k]), normal) < 0.0) return false;
  return true;
}

struct Case {
  const char* name;
  HybridMesh mesh;
  CutPlane plane;
  double area;
};

std::vector<Case> cases() {
  const double hexagon = 0.75 * std::sqrt(3.0);
  std::vector<Case> all;
  const auto add = [&](const char* name, HybridMesh mesh, const Point& origin, const Vec3& normal, double area) {
    all.push_back({name, std::move(mesh), {origin, normal, std::nullopt}, area});
  };
  add("through cells", hexahedra_block(3), {0, 0, 0.4}, {0, 0, 2}, 1.0);
  add("through faces", hexahedra_block(4), {0, 0, 0.5}, {0, 0, 1}, 1.0);
  add("on the boundary, the domain below", hexahedra_block(4), {0, 0, 1}, {0, 0, 1}, 1.0);
  add("on the boundary, the domain above", hexahedra_block(4), {0, 0, 0}, {0, 0, 1}, 0.0);
  add("through edges and corners", hexahedra_block(4), {0.5, 0.5, 0.5}, {1, 1, 0}, std::sqrt(2.0));
  add("through opposite corners of cells", hexahedra_block(2), {0.5, 0.5, 0.5}, {1, 1, 1}, hexagon);
  add("a hexagon", hexahedra_block(3), {0.5, 0.5, 0.5}, {1, 1, 1}, hexagon);
  add("hexahedron and pyramid", hexahedron_with_roof(), {0.5, 0.5, 0.5}, {0, 1, 0}, 1.25);
  add("beside the mesh", hexahedra_block(2), {0, 0, 3}, {0, 0, 1}, 0.0);
  add("plate", plate_block(4), {0.37, 0, 0}, {1, 0, 0}, 2.0);
  add("plate, through nodes", plate_block(4), {0.5, 0, 0}, {1, 0, 0}, 2.0);
  add("plate, through diagonals", plate_block(4), {0, 0, 0}, {1, -1, 0}, 2.0 * std::sqrt(2.0));
  add("plate, along the layers", plate_block(4), {0, 0, 0.2}, {0, 0, 1}, 1.0);
  add("plate, along the envelope", plate_block(4, {.layer_height = 0.5}), {0, 0, 0.5}, {0, 0, 1}, 1.0);
  add("plate with collapsed lines", plate_block(4, {.collapsed = {6, 7, 12, 13, 18}}), {0.4, 0.5, 0}, {1, 0.3, 0.1}, 0.0);
  all.back().area = std::nan("");  // compared with the mesh without collapsed growth lines
  add("cube in a cube", cube_shell(3), {0, 0, 0.5}, {0, 0, -1}, 8.0);
  add("cube in a cube, along its side", cube_shell(3), {0, 0, 1.0}, {0, 0, 1}, 8.0);
  add("cube in a cube, outside it", cube_shell(3), {0, 0, 1.0}, {0, 0, -1}, 9.0);
  return all;
}

TEST(Cut, TilesTheSectionOfTheDomain) {
  for (const Case& c : cases()) {
    SCOPED_TRACE(c.name);
    const MeshCut cut = cut_mesh(c.mesh, c.plane, k_context);
    ASSERT_EQ(cut.first.size(), cut.size() + 1);
    const double expected = std::isnan(c.area) ? total_area(cut_mesh(plate_block(4), c.plane, k_context), c.plane) : c.area;
    EXPECT_NEAR(total_area(cut, c.plane), expected, 1e-12);
  }
}

TEST(Cut, NoTwoPolygonsOverlap) {
  std::mt19937 random(7);
  std::uniform_real_distribution<double> number(-2.0, 2.0);
  for (const Case& c : cases()) {
    SCOPED_TRACE(c.name);
    const MeshCut cut = cut_mesh(c.mesh, c.plane, k_context);
    const Vec3 normal = normalized(c.plane.normal);
    for (int i = 0; i < 200; ++i) {
      Point p{number(random), number(random), number(random)};
      p -= dot(p - c.plane.origin, normal) * normal;
      int n = 0;
      for (std::size_t k = 0; k < cut.size(); ++k) n += is_inside(cut.corners_of(k), normal, p);
      EXPECT_LE(n, 1) << format_point(p);
    }
  }
}

TEST(Cut, OfASphericalShell) {
  const HybridMesh mesh = sphere_shell(6);  // from radius 1 to 3
  const CutPlane plane{{0, 0, 0}, {0.3, 0.2, 1.0}, std::nullopt};
  EXPECT_NEAR(total_area(cut_mesh(mesh, plane, k_context), plane), 8.0 * std::numbers::pi, 0.02 * 8.0 * std::numbers::pi);  // inscribed polyhedron
}

TEST(Cut, OfColumnsIsThatOfExplicitCells) {
  for (const HybridMesh& mesh : {sphere_shell(3), plate_block(5, {.collapsed = {8, 9, 14, 20}}), two_shells(2, 2, 4), stepped_sphere_shell(3)}) {
    for (const Vec3& normal : {Vec3{0.3, 0.2, 1.0}, Vec3{1, 0, 0}, Vec3{1, 1, 1}}) {
      const CutPlane plane{mesh.points.raw()[mesh.layers.first_node[mesh.layers.n_lines() / 2 + 1]], normal, std::nullopt};
      const MeshCut columns = cut_mesh(mesh, plane, k_context), cells = cut_mesh(explicit_cells(mesh), plane, k_context);
      ASSERT_GT(columns.size(), 0u);
      const auto by_cell = [](const MeshCut& cut) {
        std::map<std::pair<CellKind, std::uint64_t>, std::pair<std::vector<Point>, double>> all;
        for (std::size_t i = 0; i < cut.size(); ++i) {
          const auto corners = cut.corners_of(i);
          all[{cut.polygons[i].kind, cut.polygons[i].cell}] = {{corners.begin(), corners.end()}, cut.polygons[i].volume};
        }
        return all;
      };
      EXPECT_EQ(by_cell(columns), by_cell(cells));
    }
  }
}

TEST(Cut, IsTheSameForAnyNumberOfThreads) {
  const HybridMesh mesh = sphere_shell(12, {.n_layers = 8, .n_shells = 5});
  const CutPlane plane{{0, 0, 0}, {0.3, 0.2, 1.0}, std::nullopt};
  const MeshCut one = cut_mesh(mesh, plane, RunContext({.threads = 1}));
  for (const int threads : {2, 7}) {
    const MeshCut many = cut_mesh(mesh, plane, RunContext({.threads = threads}));
    EXPECT_EQ(many.corners, one.corners);
    EXPECT_EQ(many.first, one.first);
    for (std::size_t i = 0; i < one.size(); ++i) EXPECT_EQ(many.polygons[i].cell, one.polygons[i].cell);
  }
}

TEST(Cut, TellsKindLayerQualityAndVolume) {
  const HybridMesh mesh = plate_block(2, {.n_layers = 3, .layer_height = 0.3, .ratio = 1.0});
  const CutPlane plane{{0.3, 0, 0}, {1, 0, 0}, std::nullopt};
  const MeshCut cut = cut_mesh(mesh, plane, k_context);
  for (std::size_t i = 0; i < cut.size(); ++i) {
    const CutPolygon& polygon = cut.polygons[i];
    double middle = 0.0;
    for (const Point& p : cut.corners_of(i)) middle += p.z / static_cast<double>(cut.corners_of(i).size());
    EXPECT_EQ(polygon.is_in_layer, middle < 0.3);
    EXPECT_EQ(polygon.kind, middle < 0.3 ? CellKind::prism : CellKind::tetrahedron);
    EXPECT_EQ(polygon.layer, middle < 0.3 ? static_cast<int>(middle / 0.1) : -1);
    if (polygon.kind != CellKind::prism) continue;
    EXPECT_NEAR(polygon.quality, std::sqrt(0.5), 1e-12);  // a right angle at the height, 45 degrees in the base
    EXPECT_EQ(polygon.shape, polygon.quality);
    EXPECT_NEAR(polygon.volume, 0.125 * 0.1, 1e-15);
  }
  const MeshCut block = cut_mesh(hexahedron_with_roof(), {{0.5, 0.5, 0.5}, {0, 1, 0}, std::nullopt}, k_context);
  ASSERT_EQ(block.size(), 2u);
  EXPECT_EQ(block.polygons[0].kind, CellKind::pyramid);
  EXPECT_NEAR(block.polygons[0].volume, 1.0 / 6.0, 1e-15);
  EXPECT_EQ(block.polygons[1].kind, CellKind::hexahedron);
  EXPECT_NEAR(block.polygons[1].shape, 1.0, 1e-15);
  EXPECT_TRUE(std::isnan(block.polygons[1].quality));
}

TEST(Cut, OfARegularTetrahedronHasShapeOne) {
  HybridMesh mesh;
  for (const Point& p : {Point{1, 1, 1}, Point{1, -1, -1}, Point{-1, 1, -1}, Point{-1, -1, 1}}) mesh.points.push_back(p);
  mesh.tetrahedra.push_back({NodeId(0), NodeId(2), NodeId(1), NodeId(3)});
  const CutPlane plane{{0, 0, 0}, {0, 0, 1}, std::nullopt};
  const MeshCut cut = cut_mesh(mesh, plane, k_context);
  ASSERT_EQ(cut.size(), 1u);
  EXPECT_NEAR(std::abs(cut.polygons[0].shape), 1.0, 1e-12);
  EXPECT_NEAR(cut.polygons[0].quality, 70.528779, 1e-6);
  EXPECT_NEAR(norm(area_of(cut.corners_of(0))), 2.0, 1e-14);  // the square between the edges' middles
}

TEST(Cut, BothCellsOfWarpedFaceAgreeOnCut) {
  // Two hexahedra in [0, 2] x [0, 1]^2; the corners of the face between them lie alternately in front of and behind the plane x = 1.
  for (const double shift : {0.1, -0.1})
    for (const double at : {1.0, 1.02, 0.98}) {
      HybridMesh mesh;
      for (int k = 0; k < 2; ++k)
        for (int j = 0; j < 2; ++j)
          for (int i = 0; i < 3; ++i)
            mesh.points.push_back({i + (i == 1 ? ((j + k) % 2 == 0 ? shift : -shift) : 0.0), static_cast<double>(j), static_cast<double>(k)});
      const auto node = [](int i, int j, int k) { return NodeId((k * 2 + j) * 3 + i); };
      for (int i = 0; i < 2; ++i)
        mesh.hexahedra.push_back(
            {node(i, 0, 0), node(i + 1, 0, 0), node(i + 1, 1, 0), node(i, 1, 0), node(i, 0, 1), node(i + 1, 0, 1), node(i + 1, 1, 1), node(i, 1, 1)});
      const CutPlane plane{{at, 0, 0}, {1, 0, 0}, std::nullopt};
      EXPECT_NEAR(total_area(cut_mesh(mesh, plane, k_context), plane), 1.0, 1e-14);
    }
}

TEST(Cut, CutWithinSphereHasAllCellsInside) {
  const HybridMesh mesh = sphere_shell(5);
  CutPlane plane{{0, 0, 0}, {0.3, 0.2, 1.0}, std::nullopt};
  const MeshCut whole = cut_mesh(mesh, plane, k_context);
  plane.limits = CutLimits{whole.corners.front(), 0.3};
  const MeshCut part = cut_mesh(mesh, plane, k_context);
  EXPECT_LT(part.size(), whole.size() / 2);
  std::size_t n_near = 0, n_near_in_part = 0;
  const auto count = [&](const MeshCut& cut) {
    std::size_t n = 0;
    for (const Point& p : cut.corners) n += distance(p, plane.limits->center) <= 0.3;
    return n;
  };
  n_near = count(whole);
  n_near_in_part = count(part);
  EXPECT_GT(n_near, 0u);
  EXPECT_EQ(n_near, n_near_in_part);
}

TEST(Cut, NeedsANormal) {
  try {
    cut_mesh(hexahedra_block(1), {{0, 0, 0}, {0, 0, 0}, std::nullopt}, k_context);
    FAIL();
  } catch (const Error& error) {
    EXPECT_EQ(error.code(), ErrorCode::bad_argument);
    EXPECT_NE(std::string(error.what()).find("normal"), std::string::npos);
  }
}

}  // namespace
}  // namespace sterna
