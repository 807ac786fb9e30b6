// Fields of boundary faces against values calculated by hand.
#include "geom/mesh/surface_fields.h"

#include <gtest/gtest.h>

#include <cmath>

#include "geom/base/error.h"
#include "tests/support/hybrid_shapes.h"
#include "tests/support/test_constants.h"
#include "tests/support/test_shapes.h"

namespace sterna {
namespace {

using namespace test;

using test::k_context;

const std::vector<double>& values_of(const std::vector<SurfaceField>& fields, const char* name) {
  const SurfaceField* const field = find_field(fields, name);
  if (field == nullptr) throw std::runtime_error(std::string("no field ") + name);
  return field->values;
}

const char* const k_all[] = {"edge_length", "min_angle", "aspect", "area_ratio",  "layer_height",   "first_height",   "coverage",
                             "layers",      "growth",    "skew",   "stack_angle", "interface_jump", "scaled_jacobian"};

/// Checks that the values are equal or both NaN.
void expect_same(double a, double b, double tolerance) {
  if (std::isnan(a) && std::isnan(b)) return;
  EXPECT_NEAR(a, b, tolerance);
}

TEST(SurfaceFields, OfAPlate) {
  // Squares of side 0.5 cut along diagonals; three layers of 0.4 in all, ratio 1.5: 0.4 / 4.75 times 1, 1.5, 2.25.
  HybridMesh mesh = plate_block(2);
  const double first = 0.4 / 4.75, last = 2.25 * first, edge = (1.0 + std::sqrt(0.5)) / 3.0;
  mesh.request = {
      .first_height = first, .max_growth = 1.5, .target_height = std::vector<double>(9, 0.8), .reason = std::vector<std::uint8_t>(9, 0), .reasons = {"none"}};
  const std::vector<SurfaceField> fields = surface_fields(mesh, k_context);
  ASSERT_EQ(fields.size(), surface_field_table().size());
  const std::size_t n_triangles = mesh.boundary_triangles.size(), n = n_triangles + mesh.boundary_quads.size();
  std::size_t n_walls = 0;
  for (std::size_t f = 0; f < n; ++f) {
    const bool is_wall = f < n_triangles && mesh.boundary_triangles[f].patch == PatchId(0);
    n_walls += is_wall;
    const auto expect = [&](const char* name, double value, double tolerance = 1e-12) {
      SCOPED_TRACE(name);
      EXPECT_NEAR(values_of(fields, name)[f], value, tolerance);
    };
    if (is_wall) {
      expect("edge_length", edge);
      expect("min_angle", 45.0);
      expect("aspect", std::sqrt(3.0));
      expect("area_ratio", 1.0);
      expect("layer_height", 0.4);
      expect("first_height", first);
      expect("coverage", 0.5);
      expect("layers", 3.0);
      expect("growth", 1.5);
      expect("skew", 0.0, 2e-6);
      expect("stack_angle", 0.0, 1e-6);
      expect("interface_jump", std::sqrt(2.0 / 3.0) * edge / last);
      expect("scaled_jacobian", std::sqrt(0.5));
    } else {
      for (std::size_t i = 4; i < fields.size(); ++i) EXPECT_TRUE(std::isnan(fields[i].values[f])) << fields[i].info.name;
    }
  }
  EXPECT_EQ(n_walls, 8u);
  // The lowest quad on a side: 0.5 wide, `first` high; the quad above is 1.5 times as large.
  std::size_t lowest = n_triangles;
  while (mesh.points[mesh.boundary_quads[lowest - n_triangles].nodes[0]].z != 0.0) ++lowest;
  EXPECT_NEAR(values_of(fields, "aspect")[lowest], 0.5 / first, 1e-12);
  EXPECT_NEAR(values_of(fields, "min_angle")[lowest], 90.0, 1e-12);
  EXPECT_NEAR(values_of(fields, "area_ratio")[lowest], 1.5, 1e-12);
}

TEST(SurfaceFields, ExplicitCellsGiveColumnFieldsExceptRequests) {
  for (const HybridMesh& mesh : {sphere_shell(3), plate_block(3), two_shells(2, 2, 4)}) {
    const auto columns = surface_fields(mesh, k_context), cells = surface_fields(explicit_cells(mesh), k_context);
    for (const char* name : k_all)
      for (std::size_t f = 0; f < mesh.boundary_triangles.size(); ++f) {
        SCOPED_TRACE(name);
        expect_same(values_of(columns, name)[f], values_of(cells, name)[f], 3e-6);
      }
  }
}

TEST(SurfaceFields, OfCollapsedLines) {
  const HybridMesh mesh = plate_block(2, {.collapsed = {0, 1, 4}});  // the triangle (0, 1, 4) has no cells
  const auto fields = surface_fields(mesh, k_context);
  for (std::size_t f = 0; f < mesh.boundary_triangles.size(); ++f) {
    if (mesh.boundary_triangles[f].patch != PatchId(0)) continue;
    int n_collapsed = 0;
    for (const NodeId node : mesh.boundary_triangles[f].nodes)
      for (const std::size_t line : {0, 1, 4}) n_collapsed += mesh.layers.first_node[line] == node.value();
    EXPECT_NEAR(values_of(fields, "layer_height")[f], 0.4 * (3 - n_collapsed) / 3.0, 1e-12);
    EXPECT_EQ(values_of(fields, "layers")[f], n_collapsed == 3 ? 0.0 : 3.0);
    EXPECT_EQ(std::isnan(values_of(fields, "first_height")[f]), n_collapsed == 3);
    EXPECT_EQ(std::isnan(values_of(fields, "scaled_jacobian")[f]), n_collapsed > 0);
  }
}

TEST(SurfaceFields, OfASurface) {
  const TriMesh mesh = cube(2);
  const auto fields = surface_fields(mesh, k_context);
  ASSERT_EQ(fields.size(), 4u);
  for (const double angle : values_of(fields, "min_angle")) EXPECT_NEAR(angle, 45.0, 1e-12);
  for (const double ratio : values_of(fields, "area_ratio")) EXPECT_NEAR(ratio, 1.0, 1e-12);
  EXPECT_EQ(find_field(fields, "skew"), nullptr);
}

TEST(SurfaceFields, AreTheSameForAnyNumberOfThreads) {
  const HybridMesh mesh = sphere_shell(10);
  const auto one = surface_fields(mesh, RunContext({.threads = 1}));
  for (const int threads : {2, 7}) {
    const auto many = surface_fields(mesh, RunContext({.threads = threads}));
    for (std::size_t i = 0; i < one.size(); ++i)
      for (std::size_t f = 0; f < one[i].values.size(); ++f)
        ASSERT_TRUE(one[i].values[f] == many[i].values[f] || (std::isnan(one[i].values[f]) && std::isnan(many[i].values[f]))) << one[i].info.name;
  }
}

TEST(SurfaceFields, LimitsAreGateLimitsInTheirUnits) {
  const auto table = surface_field_table();
  const auto info = [&](std::string_view name) { return *std::find_if(table.begin(), table.end(), [&](const auto& field) { return field.name == name; }); };
  EXPECT_NEAR(info("stack_angle").limits.usual, 10.0, 1e-12);
  EXPECT_EQ(info("interface_jump").limits.hard, 8.0);
  EXPECT_EQ(info("scaled_jacobian").limits.target, 0.05);
  EXPECT_TRUE(info("scaled_jacobian").is_low_bad);
  EXPECT_TRUE(std::isnan(info("edge_length").limits.hard));
}

TEST(SurfaceFields, OfAMeshThatCannotBeRead) {
  HybridMesh mesh = plate_block(2);
  mesh.boundary_triangles[0].nodes[0] = NodeId(100000);
  try {
    surface_fields(mesh, k_context);
    FAIL();
  } catch (const Error& error) {
    EXPECT_EQ(error.code(), ErrorCode::mesh_invalid);
  }
}

}  // namespace
}  // namespace sterna
