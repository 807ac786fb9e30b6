// Layers that end on planes: their boundary quads must be checked like those of explicit cells, and symmetry planes may have any orientation.
#include <gtest/gtest.h>

#include "geom/mesh/check.h"
#include "geom/mesh/dual_metrics.h"
#include "tests/geom/mesh/check_support.h"
#include "tests/support/half_shapes.h"

namespace sterna {
namespace {

using namespace test;

std::vector<HybridMesh> halves() {
  std::vector<HybridMesh> meshes;
  for (const bool has_collapsed_border : {false, true}) {
    meshes.push_back(half_sphere_shell(5, {.shell = {.n_layers = 6}, .has_collapsed_border = has_collapsed_border}));
    meshes.push_back(half_shell_of_all_kinds(6, {.shell = {.n_layers = 3}, .has_collapsed_border = has_collapsed_border}));
    meshes.push_back(turned(meshes.back(), {10.0, -20.0, 5.0}));
  }
  return meshes;
}

/// Checks that both forms of a mesh agree on violations by kind, volumes, and the gates that do not need columns.
void expect_same_verdicts(const CheckReport& columns, const CheckReport& cells) {
  EXPECT_EQ(columns.counts, cells.counts) << to_text(columns) << to_text(cells);
  EXPECT_EQ(columns.n_boundary_quads, cells.n_boundary_quads);
  EXPECT_EQ(columns.cells.pyramids, cells.cells.pyramids);
  EXPECT_NEAR(columns.total_volume, cells.total_volume, 1e-13 * columns.total_volume);  // the same terms in another order
  EXPECT_NEAR(columns.dual_volume, cells.dual_volume, 1e-13 * columns.dual_volume);
  std::vector<Measure> measures = {Measure::scaled_jacobian,  Measure::dual_closure,    Measure::orthogonality,
                                   Measure::sub_volume_ratio, Measure::face_area_ratio, Measure::edge_ratio};
  // Tetrahedra of columns belong to the layer in column form, and are ordinary tetrahedra in explicit form.
  if (columns.cells.pyramids == 0)
    measures.insert(measures.end(), {Measure::min_dihedral, Measure::max_dihedral, Measure::tet_growth, Measure::interface_height, Measure::interface_volume});
  for (const Measure measure : measures) {
    const GateResult &a = columns.gate(measure), &b = cells.gate(measure);
    SCOPED_TRACE(info_of(measure).name);
    EXPECT_EQ(a.state, b.state);
    EXPECT_EQ(a.total, b.total);
    // Angles inside columns come from a polynomial accurate to 2e-8; the rounding of closures differs between the two forms.
    EXPECT_NEAR(a.worst, b.worst, measure == Measure::dual_closure ? 1e-15 : 1e-7 * std::max(1.0, std::abs(b.worst)));
  }
}

TEST(CheckHalves, ColumnsAndExplicitCellsAgree) {
  for (const HybridMesh& mesh : halves()) {
    EXPECT_FALSE(mesh.boundary_quads.empty());
    const CheckReport columns = checked(mesh);
    EXPECT_TRUE(columns.is_valid()) << to_text(columns);
    expect_same_verdicts(columns, checked(explicit_cells(mesh)));
  }
}

TEST(CheckHalves, WhatIsCheckedAheadChangesNothing) {
  for (const HybridMesh& mesh : halves()) {
    HybridMesh layers = mesh;
    layers.tetrahedra.clear();
    const RunContext context({.threads = 2});
    const LayerCheck ahead = check_ahead(layers, {}, context);
    ASSERT_NE(ahead.parts(), nullptr);
    EXPECT_EQ(to_json(check(mesh, {}, context, &ahead)), to_json(check(mesh, {}, context)));
  }
}

/// Each fault of one boundary quad of the layer is found, identically in both forms.
TEST(CheckHalves, FaultsOfQuadsAreFoundInBothForms) {
  const HybridMesh good = half_shell_of_all_kinds(5, {.shell = {.n_layers = 4}, .has_collapsed_border = true});
  const auto expect = [&](Violation violation, std::int64_t n, const char* what, const auto& damage) {
    SCOPED_TRACE(what);
    HybridMesh mesh = good;
    damage(mesh);
    for (const CheckReport& report : {checked(mesh), checked(explicit_cells(mesh))}) EXPECT_EQ(report.count(violation), n) << to_text(report);
  };
  expect(Violation::unmatched_face, 1, "a quad is missing", [](HybridMesh& m) { m.boundary_quads.erase(m.boundary_quads.begin() + 7); });
  expect(Violation::duplicate_marker, 1, "a quad is there twice", [](HybridMesh& m) { m.boundary_quads.push_back({m.boundary_quads[7].nodes, PatchId(0)}); });
  expect(Violation::same_sense_face, 1, "a quad points inwards", [](HybridMesh& m) { std::swap(m.boundary_quads[7].nodes[1], m.boundary_quads[7].nodes[3]); });
  expect(Violation::stray_boundary_face, 1, "a quad with another cycle",
         [](HybridMesh& m) { std::swap(m.boundary_quads[7].nodes[0], m.boundary_quads[7].nodes[1]); });
  expect(Violation::stray_boundary_face, 2, "a quad as two triangles", [](HybridMesh& m) {
    const BoundaryQuad q = m.boundary_quads[7];
    m.boundary_quads.erase(m.boundary_quads.begin() + 7);
    m.boundary_triangles.push_back({{q.nodes[0], q.nodes[1], q.nodes[2]}, q.patch});
    m.boundary_triangles.push_back({{q.nodes[0], q.nodes[2], q.nodes[3]}, q.patch});
  });
  expect(Violation::bad_index, 1, "a quad repeats a node", [](HybridMesh& m) { m.boundary_quads[7].nodes[1] = m.boundary_quads[7].nodes[0]; });
}

TEST(CheckHalves, SymmetryPlanesMayLieAnyhow) {
  for (const Vec3& offset : {Vec3{}, Vec3{10.0, -20.0, 5.0}}) {
    HybridMesh mesh = turned(half_sphere_shell(6), offset);
    EXPECT_TRUE(checked(mesh, {.intersections = false}).is_valid());
    // A node inside the plane, then a node of its border, is moved off the plane: this node is reported, and no other.
    Vec3 normal;
    std::vector<NodeId> nodes;
    for (const BoundaryQuad& face : mesh.boundary_quads) {
      nodes.insert(nodes.end(), face.nodes.begin(), face.nodes.end());
      normal = normalized(cross(mesh.points[face.nodes[1]] - mesh.points[face.nodes[0]], mesh.points[face.nodes[3]] - mesh.points[face.nodes[0]]));
    }
    const NodeId on_wall = mesh.layers.node(static_cast<std::uint32_t>(std::find(mesh.layers.first_node.begin(), mesh.layers.first_node.end(),
                                                                                 std::min_element(nodes.begin(), nodes.end())->value()) -
                                                                       mesh.layers.first_node.begin()),
                                            0);
    for (const NodeId node : {on_wall, NodeId(on_wall.value() + 1)}) {
      HybridMesh moved = mesh;
      moved.points[node] += 1e-9 * normal;
      const CheckReport report = checked(moved, {.intersections = false});
      EXPECT_EQ(report.count(Violation::off_symmetry_plane), 1) << to_text(report);
      EXPECT_NE(to_text(report).find("node " + std::to_string(node.value()) + " of patch symmetry is "), std::string::npos) << to_text(report);
      EXPECT_NE(to_text(report).find("e-09 m off the plane ("), std::string::npos) << to_text(report);
    }
  }
}

TEST(CheckHalves, BentSymmetryPatchIsNoPlane) {
  HybridMesh mesh = half_sphere_shell(5);
  for (Patch& patch : mesh.patches)
    if (patch.kind == PatchKind::farfield) patch.kind = PatchKind::symmetry;
  EXPECT_GT(checked(mesh, {.intersections = false}).count(Violation::off_symmetry_plane), 10);
}

}  // namespace
}  // namespace sterna
