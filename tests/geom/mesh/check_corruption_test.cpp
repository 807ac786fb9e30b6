// Every corruption is found, with the right kind and location.
#include <gtest/gtest.h>

#include <functional>
#include <limits>
#include <random>

#include "tests/geom/mesh/check_support.h"

namespace sterna {
namespace {

using namespace test;

constexpr std::uint32_t k_column = 40;  // a wall triangle of sphere(4)
constexpr int k_layers = 3;
constexpr std::size_t k_prism = k_column * k_layers;  // the column's first-layer prism in explicit form

HybridMesh base_mesh() { return sphere_shell(4, {.n_layers = k_layers}); }
HybridMesh base_cells() { return explicit_cells(base_mesh()); }

/// Largest distance of a finding from the centre of the corrupted prism: the faces and neighbours of a cell of size 0.3.
constexpr double k_near = 0.4;

void expect_found(const CheckReport& report, Violation violation, std::int64_t count, const Point& location) {
  EXPECT_FALSE(report.is_valid());
  EXPECT_EQ(report.count(violation), count) << to_string(violation) << "\n" << to_text(report);
  EXPECT_LT(distance_to_first(report, violation, location), k_near) << to_string(violation) << "\n" << to_text(report);
}

void expect_only(const CheckReport& report, const std::vector<Violation>& violations) {
  for (const auto& [violation, count] : report.counts)
    EXPECT_NE(std::find(violations.begin(), violations.end(), violation), violations.end()) << to_string(violation) << "\n" << to_text(report);
}

TEST(CheckCorruption, RemovedFirstLayerCell) {
  HybridMesh mesh = base_cells();
  const Point location = middle_of(mesh, mesh.prisms[k_prism]);
  mesh.prisms.erase(mesh.prisms.begin() + k_prism);
  const CheckReport report = checked(mesh);
  expect_found(report, Violation::unmatched_face, 4, location);
  expect_found(report, Violation::stray_boundary_face, 1, location);
  EXPECT_EQ(report.count(Violation::volume_mismatch), 1);
  expect_only(report, {Violation::unmatched_face, Violation::stray_boundary_face, Violation::volume_mismatch});
}

TEST(CheckCorruption, InvertedFirstLayerCell) {
  HybridMesh mesh = base_cells();
  auto& prism = mesh.prisms[k_prism];
  const Point location = middle_of(mesh, prism);
  for (std::size_t k = 0; k < 3; ++k) std::swap(prism[k], prism[k + 3]);
  const CheckReport report = checked(mesh);
  expect_found(report, Violation::invalid_cell, 1, location);
  expect_found(report, Violation::same_sense_face, 5, location);
  EXPECT_NE(to_text(report).find("prism " + std::to_string(k_prism) + ", near patch sphere is inverted"), std::string::npos) << to_text(report);
}

TEST(CheckCorruption, DuplicatedFirstLayerCell) {
  HybridMesh mesh = base_cells();
  const Point location = middle_of(mesh, mesh.prisms[k_prism]);
  mesh.prisms.push_back(mesh.prisms[k_prism]);
  const CheckReport report = checked(mesh);
  expect_found(report, Violation::overmatched_face, 5, location);
  EXPECT_EQ(report.count(Violation::invalid_cell), 0);
  EXPECT_EQ(report.count(Violation::volume_mismatch), 1);
}

TEST(CheckCorruption, TheSameForEachTetrahedron) {
  const HybridMesh mesh = base_mesh();
  for (const std::size_t t : {std::size_t{0}, mesh.tetrahedra.size() / 2, mesh.tetrahedra.size() - 1}) {
    const Point location = middle_of(mesh, mesh.tetrahedra[t]);
    HybridMesh removed = mesh, inverted = mesh, doubled = mesh;
    removed.tetrahedra.erase(removed.tetrahedra.begin() + static_cast<std::ptrdiff_t>(t));
    const CheckReport without = checked(removed);
    EXPECT_EQ(without.count(Violation::unmatched_face) + without.count(Violation::stray_boundary_face), 4) << to_text(without);
    std::swap(inverted.tetrahedra[t][2], inverted.tetrahedra[t][3]);
    const CheckReport turned = checked(inverted);
    EXPECT_EQ(turned.count(Violation::invalid_cell), 1);
    EXPECT_EQ(turned.count(Violation::same_sense_face), 4);
    EXPECT_LT(distance_to_first(turned, Violation::invalid_cell, location), 1e-12);
    doubled.tetrahedra.push_back(doubled.tetrahedra[t]);
    EXPECT_EQ(checked(doubled).count(Violation::overmatched_face), 4);
  }
}

TEST(CheckCorruption, FlippedMarker) {
  for (HybridMesh mesh : {base_mesh(), base_cells()}) {
    auto& marker = mesh.boundary_triangles[2 * k_column];
    const Point location = middle_of(mesh, marker.nodes);
    std::swap(marker.nodes[0], marker.nodes[1]);
    const CheckReport report = checked(mesh);
    expect_found(report, Violation::same_sense_face, 1, location);
    EXPECT_EQ(report.counts.size(), 1u) << to_text(report);
    EXPECT_NE(report.findings[0].what.find("boundary triangle 80, patch sphere points into its cell, prism 120"), std::string::npos) << report.findings[0].what;
  }
}

TEST(CheckCorruption, MarkerInTwoPatches) {
  for (HybridMesh mesh : {base_mesh(), base_cells()}) {
    BoundaryTriangle marker = mesh.boundary_triangles[2 * k_column];
    const Point location = middle_of(mesh, marker.nodes);
    marker.patch = PatchId(1);
    std::rotate(marker.nodes.begin(), marker.nodes.begin() + 1, marker.nodes.end());
    mesh.boundary_triangles.push_back(marker);
    const CheckReport report = checked(mesh);
    expect_found(report, Violation::duplicate_marker, 1, location);
    EXPECT_EQ(report.counts.size(), 1u) << to_text(report);
    EXPECT_NE(report.findings[0].what.find("patch farfield marks the face of boundary triangle 80, patch sphere again"), std::string::npos)
        << report.findings[0].what;
  }
}

TEST(CheckCorruption, MissingAndStrayMarker) {
  for (HybridMesh mesh : {base_mesh(), base_cells()}) {
    const Point location = middle_of(mesh, mesh.boundary_triangles[2 * k_column].nodes);
    HybridMesh missing = mesh;
    missing.boundary_triangles.erase(missing.boundary_triangles.begin() + 2 * k_column);
    expect_found(checked(missing), Violation::unmatched_face, 1, location);
    auto& nodes = mesh.boundary_triangles[2 * k_column].nodes;
    nodes[2] = NodeId(nodes[2].value() + 1);  // the next node of its growth line
    const CheckReport report = checked(mesh);
    expect_found(report, Violation::unmatched_face, 1, location);
    expect_found(report, Violation::stray_boundary_face, 1, location);
  }
}

TEST(CheckCorruption, MarkerBetweenTwoCells) {
  for (HybridMesh mesh : {base_mesh(), base_cells()}) {
    const HybridMesh columns = base_mesh();
    const auto& lines = columns.layers.base[k_column];
    const auto top = [&](std::size_t k) { return columns.layers.node(lines[k], k_layers); };
    mesh.boundary_triangles.push_back({{top(0), top(1), top(2)}, PatchId(0)});
    const CheckReport report = checked(mesh);
    expect_found(report, Violation::overmatched_face, 1, middle_of(mesh, mesh.boundary_triangles.back().nodes));
    EXPECT_NE(to_text(report).find("belongs to 2 cells and to boundary triangle"), std::string::npos) << to_text(report);
  }
}

TEST(CheckCorruption, FoldedEnvelopeTriangle) {
  for (HybridMesh mesh : {base_mesh(), base_cells()}) {
    const HybridMesh columns = base_mesh();
    const auto& lines = columns.layers.base[k_column];
    const auto top = [&](std::size_t k) -> Point& { return mesh.points[columns.layers.node(lines[k], k_layers)]; };
    // The top node moves over the opposite edge, into the neighbour.
    top(0) = 0.5 * (top(1) + top(2)) + 0.7 * (0.5 * (top(1) + top(2)) - top(0));
    const Point location = top(0);
    const CheckReport report = checked(mesh);
    EXPECT_GT(report.count(Violation::envelope_intersection), 0) << to_text(report);
    EXPECT_GT(report.count(Violation::invalid_cell), 0);
    EXPECT_EQ(report.count(Violation::unmatched_face), 0);
    EXPECT_EQ(report.count(Violation::volume_mismatch), 0) << to_text(report);  // signed volumes still agree
    EXPECT_LT(distance_to_first(report, Violation::envelope_intersection, location), 2 * k_near);
    EXPECT_LT(distance_to_first(report, Violation::invalid_cell, location), 2 * k_near);
  }
}

TEST(CheckCorruption, MovedNodeInvertsPrisms) {
  for (HybridMesh mesh : {base_mesh(), base_cells()}) {
    const HybridMesh columns = base_mesh();
    const std::uint32_t line = columns.layers.base[k_column][1];
    const NodeId node = columns.layers.node(line, 1);
    const Point location = mesh.points[node];
    mesh.points[node] = 0.99 * mesh.points[columns.layers.node(line, 0)];  // into the wall
    const CheckReport report = checked(mesh);
    const std::int64_t n_around =
        std::count_if(columns.layers.base.begin(), columns.layers.base.end(), [&](const auto& b) { return std::count(b.begin(), b.end(), line) > 0; });
    expect_found(report, Violation::invalid_cell, n_around, location);
    expect_only(report, {Violation::invalid_cell, Violation::negative_sub_volume});
  }
}

/// Returns two tetrahedra on one triangle: an upper one of the given height and a lower one of height 1.
HybridMesh two_tets(double height, const Vec3& offset) {
  HybridMesh mesh;
  for (const Point& p : {Point{0, 0, 0}, Point{1, 0, 0}, Point{0, 1, 0}, Point{0.25, 0.25, height}, Point{0.25, 0.25, -1}}) mesh.points.push_back(p + offset);
  const std::array<NodeId, 5> n = {NodeId(0), NodeId(1), NodeId(2), NodeId(3), NodeId(4)};
  mesh.tetrahedra = {{n[0], n[1], n[2], n[3]}, {n[0], n[2], n[1], n[4]}};
  const PatchId wall = mesh.patches.push_back({.name = "wall"});
  for (std::size_t k = 0; k < 3; ++k) {
    mesh.boundary_triangles.push_back({{n[k], n[(k + 1) % 3], n[3]}, wall});
    mesh.boundary_triangles.push_back({{n[(k + 1) % 3], n[k], n[4]}, wall});
  }
  return mesh;
}

TEST(CheckCorruption, CellsWithinRoundingOfDoublePrecision) {
  EXPECT_TRUE(checked(two_tets(1e-6, {})).is_valid());
  // Positive by exact signs, but a solver computes a volume of about 1e-14 of the product of the edges, with an error of 1e-15.
  const CheckReport flat = checked(two_tets(1e-14, {}));
  expect_found(flat, Violation::cell_within_rounding, 1, {0.3, 0.3, 0});
  expect_found(flat, Violation::sub_volume_within_rounding, 1, {0.3, 0.3, 0});
  expect_only(flat, {Violation::cell_within_rounding, Violation::sub_volume_within_rounding});
  EXPECT_NE(to_text(flat).find("in double precision; the limit is 1e-13"), std::string::npos) << to_text(flat);
  // Far from the origin the volume is accurate, but the mean of the nodes is rounded onto the base.
  const double far = 0x1p20, step = 0x1p-32;
  const CheckReport rounded = checked(two_tets(step, {far, far, far}));
  expect_found(rounded, Violation::sub_volume_within_rounding, 1, Point{far, far, far} + Vec3{0.3, 0.3, 0});
  expect_only(rounded, {Violation::sub_volume_within_rounding});
  EXPECT_TRUE(checked(two_tets(1024 * step, {far, far, far})).is_valid());
}

TEST(CheckCorruption, UnusedNode) {
  for (HybridMesh mesh : {base_mesh(), base_cells()}) {
    mesh.points.push_back({0, 0, 1.2});
    const CheckReport report = checked(mesh);
    expect_found(report, Violation::unused_node, 1, {0, 0, 1.2});
    EXPECT_EQ(report.counts.size(), 1u);
  }
}

TEST(CheckCorruption, BadIndicesEndTheWalk) {
  const HybridMesh mesh = base_cells();
  const NodeId outside(static_cast<std::uint64_t>(mesh.points.size()));
  const std::vector<std::function<void(HybridMesh&)>> corruptions = {[&](HybridMesh& m) { m.prisms[k_prism][4] = outside; },
                                                                     [&](HybridMesh& m) { m.tetrahedra[7][0] = NodeId{}; },
                                                                     [&](HybridMesh& m) { m.boundary_triangles[3].nodes[1] = outside; },
                                                                     [&](HybridMesh& m) {
                                                                       m.pyramids.push_back({outside, outside, outside, outside, outside});
                                                                     },
                                                                     [&](HybridMesh& m) {
                                                                       m.boundary_quads.push_back({{outside, outside, outside, outside}, PatchId(0)});
                                                                     }};
  for (const auto& corrupt : corruptions) {
    HybridMesh bad = mesh;
    corrupt(bad);
    const CheckReport report = checked(bad);
    EXPECT_EQ(report.count(Violation::bad_index), 1);
    EXPECT_FALSE(report.is_complete);
    EXPECT_NE(to_text(report).find("nothing else could be checked"), std::string::npos);
  }
}

TEST(CheckCorruption, BadLinesAndColumnsEndTheWalk) {
  const HybridMesh mesh = base_mesh();
  const std::vector<std::function<void(LayerBlock&)>> corruptions = {
      [&](LayerBlock& l) { l.base[5][0] = static_cast<std::uint32_t>(l.n_lines()); },
      [&](LayerBlock& l) { l.first_node[5] = static_cast<std::uint32_t>(mesh.points.size()) - 1; },
      [&](LayerBlock& l) { l.is_collapsed.pop_back(); },
      [&](LayerBlock& l) { l.is_collapsed[3] = 2; },
      [&](LayerBlock& l) { l.n_layers = 0; },
      [&](LayerBlock& l) { l.n_layers = -1; }};
  for (const auto& corrupt : corruptions) {
    HybridMesh bad = mesh;
    corrupt(bad.layers);
    const CheckReport report = checked(bad);
    EXPECT_GE(report.count(Violation::bad_index), 1);
    EXPECT_FALSE(report.is_complete);
  }
}

TEST(CheckCorruption, RepeatedNodesPatchesAndPointsOutOfRange) {
  HybridMesh repeated = base_cells();
  repeated.prisms[k_prism][3] = repeated.prisms[k_prism][0];
  const CheckReport report = checked(repeated);
  EXPECT_EQ(report.count(Violation::bad_index), 1);
  EXPECT_EQ(report.count(Violation::invalid_cell), 1);

  HybridMesh patch = base_mesh();
  patch.boundary_triangles[80].patch = PatchId(9);
  const CheckReport with_patch = checked(patch);
  expect_found(with_patch, Violation::bad_index, 1, middle_of(patch, patch.boundary_triangles[80].nodes));
  EXPECT_EQ(with_patch.counts.size(), 1u);

  HybridMesh point = base_mesh();
  point.points[NodeId(17)].y = std::numeric_limits<double>::quiet_NaN();
  const CheckReport with_nan = checked(point);
  EXPECT_EQ(with_nan.count(Violation::bad_point), 1);
  EXPECT_FALSE(with_nan.is_complete);
}

TEST(CheckCorruption, BrokenLine) {
  HybridMesh mesh = base_mesh();
  const Point location = mesh.points[NodeId(mesh.layers.first_node[11])];
  mesh.layers.first_node[11] -= 1;  // starts at the last node of growth line 10
  const CheckReport report = checked(mesh);
  EXPECT_EQ(report.count(Violation::broken_line), 1) << to_text(report);
  EXPECT_LT(distance_to_first(report, Violation::broken_line, location), 2 * k_near);
  EXPECT_GT(report.count(Violation::unmatched_face), 0);
}

/// Returns the kinds of violation. Faces between the layers of a duplicated column are counted in explicit form only.
std::vector<Violation> kinds(const CheckReport& report) {
  std::vector<Violation> result;
  for (const auto& [violation, count] : report.counts) result.push_back(violation);
  return result;
}

TEST(CheckCorruption, RemovedReversedAndDoubledColumnsGetCellVerdict) {
  const std::vector<std::function<void(LayerBlock&)>> corruptions = {[](LayerBlock& l) { l.base.erase(l.base.begin() + k_column); },
                                                                     [](LayerBlock& l) { std::swap(l.base[k_column][0], l.base[k_column][1]); },
                                                                     [](LayerBlock& l) { l.base.push_back(l.base[k_column]); }};
  const std::vector<Violation> expected = {Violation::unmatched_face, Violation::invalid_cell, Violation::overmatched_face};
  for (std::size_t i = 0; i < corruptions.size(); ++i) {
    for (const std::vector<std::uint32_t>& collapsed : {std::vector<std::uint32_t>{}, {base_mesh().layers.base[k_column][0]}}) {
      HybridMesh mesh = sphere_shell(4, {.n_layers = k_layers, .collapsed = collapsed});
      const Cell cell = mesh.layers.cell(k_column, 0);
      const Point location = middle_of(mesh, cell.span());
      corruptions[i](mesh.layers);
      const CheckReport columns = checked(mesh);
      EXPECT_GT(columns.count(expected[i]), 0) << to_text(columns);
      EXPECT_LT(distance_to_first(columns, expected[i], location), k_near);
      EXPECT_EQ(kinds(columns), kinds(checked(explicit_cells(mesh))));
    }
  }
}

TEST(CheckCorruption, WrongCollapseFlagIsSeen) {
  // A growth line that has layers although its neighbours and the tets treat it as collapsed, and the reverse case.
  HybridMesh mesh = sphere_shell(4, {.n_layers = k_layers, .collapsed = {base_mesh().layers.base[k_column][0]}});
  mesh.layers.is_collapsed[base_mesh().layers.base[k_column][0]] = 0;
  EXPECT_FALSE(checked(mesh).is_valid());
  mesh = base_mesh();
  mesh.layers.is_collapsed[5] = 1;
  const CheckReport report = checked(mesh);
  EXPECT_EQ(report.count(Violation::unused_node), k_layers - 1);  // the tets still use the top node
  EXPECT_GT(report.count(Violation::unmatched_face), 0);
  EXPECT_EQ(report.counts, checked(explicit_cells(mesh)).counts);
}

TEST(CheckCorruption, AQuadIsNotTwoTriangles) {
  for (HybridMesh mesh : {plate_block(3), explicit_cells(plate_block(3))}) {
    const BoundaryQuad quad = mesh.boundary_quads.back();
    const auto& n = quad.nodes;
    const Point location = middle_of(mesh, n);
    HybridMesh split = mesh;
    split.boundary_quads.pop_back();
    split.boundary_triangles.push_back({{n[0], n[1], n[2]}, quad.patch});
    split.boundary_triangles.push_back({{n[0], n[2], n[3]}, quad.patch});
    const CheckReport report = checked(split);
    expect_found(report, Violation::unmatched_face, 1, location);
    expect_found(report, Violation::stray_boundary_face, 2, location);

    HybridMesh twisted = mesh;  // the same four nodes in another cyclic order
    std::swap(twisted.boundary_quads.back().nodes[1], twisted.boundary_quads.back().nodes[2]);
    const CheckReport bow = checked(twisted);
    expect_found(bow, Violation::unmatched_face, 1, location);
    expect_found(bow, Violation::stray_boundary_face, 1, location);

    HybridMesh turned = mesh;  // the same cyclic order from another corner is the same face
    std::rotate(turned.boundary_quads.back().nodes.begin(), turned.boundary_quads.back().nodes.begin() + 3, turned.boundary_quads.back().nodes.end());
    EXPECT_TRUE(checked(turned).is_valid());
    std::reverse(turned.boundary_quads.back().nodes.begin(), turned.boundary_quads.back().nodes.end());
    expect_found(checked(turned), Violation::same_sense_face, 1, location);
  }
}

HybridMesh joined(HybridMesh mesh, HybridMesh other, double scale, const Vec3& offset) {
  move_points(other, scale, offset);
  const auto n = static_cast<std::uint32_t>(mesh.points.size());
  const auto shifted = [n](auto nodes) {
    for (NodeId& node : nodes) node = NodeId(node.value() + n);
    return nodes;
  };
  for (const Point& p : other.points) mesh.points.push_back(p);
  for (const auto& c : other.prisms) mesh.prisms.push_back(shifted(c));
  for (const auto& c : other.tetrahedra) mesh.tetrahedra.push_back(shifted(c));
  for (const auto& b : other.boundary_triangles) mesh.boundary_triangles.push_back({shifted(b.nodes), b.patch});
  return mesh;
}

TEST(CheckCorruption, CrossingBoundariesOfTwoValidMeshes) {
  const CheckReport report = checked(joined(base_cells(), base_cells(), 1.0, {5.5, 0, 0}));  // outer radius 3
  EXPECT_GT(report.count(Violation::boundary_intersection), 0) << to_text(report);
  EXPECT_LT(distance_to_first(report, Violation::boundary_intersection, {2.75, 0, 0}), 2.0);
  expect_only(report, {Violation::boundary_intersection});
  const CheckReport close = checked(joined(base_cells(), base_cells(), 1.0, {2.6, 0, 0}));  // the layers reach 1.4
  EXPECT_GT(close.count(Violation::envelope_intersection), 0);
  expect_only(close, {Violation::boundary_intersection, Violation::envelope_intersection});
}

TEST(CheckCorruption, AMeshInsideAnotherOneIsNoTiling) {
  const CheckReport report = checked(joined(base_cells(), base_cells(), 0.1, {2.2, 0, 0}));  // in the tets, between 1.4 and 3
  expect_only(report, {Violation::overlapping_parts});
  EXPECT_EQ(report.count(Violation::overlapping_parts), 2) << to_text(report);  // its wall and its outer boundary are each covered one time too many
  EXPECT_LT(distance_to_first(report, Violation::overlapping_parts, {2.2, 0, 0}), 0.4);
  // Inside the body, the second part is a domain of its own.
  const CheckReport apart = checked(joined(base_cells(), base_cells(), 0.1, {}));
  EXPECT_TRUE(apart.is_valid()) << to_text(apart);
}

TEST(CheckCorruption, RandomDamageNeverThrowsAndBothFormsAgree) {
  std::mt19937 random(5);
  const HybridMesh base = sphere_shell(2, {.n_layers = 2, .n_shells = 1, .collapsed = {3}});
  const auto any = [&](std::size_t n) { return static_cast<std::size_t>(random()) % n; };
  const auto node = [&] { return NodeId(static_cast<std::uint64_t>(any(base.points.size()))); };
  const std::vector<std::function<void(HybridMesh&)>> damages = {
      [&](HybridMesh& m) { m.points[node()] = m.points[node()]; },                             // coincident points, flat cells
      [&](HybridMesh& m) { m.points[node()] = 0.5 * (m.points[node()] + m.points[node()]); },  // collinear points
      [&](HybridMesh& m) { m.points[node()] = -1.0 * m.points[node()]; },                      // on the opposite side
      [&](HybridMesh& m) { m.tetrahedra[any(m.tetrahedra.size())][any(4)] = node(); },         // possibly a repeated node
      [&](HybridMesh& m) { m.boundary_triangles[any(m.boundary_triangles.size())].nodes[any(3)] = node(); },
      [&](HybridMesh& m) {
        m.boundary_quads.push_back({{node(), node(), node(), node()}, PatchId(0)});
      },
      [&](HybridMesh& m) { m.tetrahedra.erase(m.tetrahedra.begin() + static_cast<std::ptrdiff_t>(any(m.tetrahedra.size()))); },
      [&](HybridMesh& m) { m.layers.base[any(m.layers.n_columns())][any(3)] = static_cast<std::uint32_t>(any(m.layers.n_lines())); },
      [&](HybridMesh& m) { m.layers.is_collapsed[any(m.layers.n_lines())] ^= 1; },
  };
  int n_valid = 0;
  for (int trial = 0; trial < 400; ++trial) {
    HybridMesh mesh = base;
    for (std::size_t n = 1 + any(3); n > 0; --n) damages[any(damages.size())](mesh);
    const CheckReport columns = checked(mesh);
    n_valid += columns.is_valid();
    if (columns.is_complete) {
      EXPECT_EQ(columns.is_valid(), checked(explicit_cells(mesh)).is_valid()) << "trial " << trial << "\n" << to_text(columns);
    }
  }
  EXPECT_LT(n_valid, 20);  // a node or index replaced by itself
}

TEST(CheckCorruption, FindingsAreLimitedButAllAreCounted) {
  HybridMesh mesh = base_mesh();
  mesh.boundary_triangles.clear();
  const CheckReport report = checked(mesh, {.findings_per_kind = 3});
  EXPECT_EQ(report.count(Violation::unmatched_face), 2 * 320);
  EXPECT_EQ(report.findings.size(), 5u);  // three faces, and the volumes of both parts, which lack their outer surface
  EXPECT_NE(to_text(report).find("and 637 more"), std::string::npos);
}

}  // namespace
}  // namespace sterna
