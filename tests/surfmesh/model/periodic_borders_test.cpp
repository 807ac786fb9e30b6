// Borders of periodic sides are discretised identically: bars and wings through both sides of a duct, corners on one side only, bands, two directions.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <map>
#include <set>

#include "geom/base/error.h"
#include "geom/model/deform.h"
#include "geom/model/shapes.h"
#include "surfmesh/model/edge_samples.h"
#include "surfmesh/model/model_sizes.h"
#include "surfmesh/model/model_topology.h"
#include "surfmesh/model/periodic_borders.h"
#include "surfmesh/model/surface_mesh.h"
#include "tests/support/error_of.h"
#include "tests/support/rows.h"
#include "tests/support/test_constants.h"
#include "tests/surfmesh/model/edges_of.h"

namespace sterna::surfmesh {
namespace {

using test::edges_of;
using test::expect_error;
using test::k_context;
using testing::AllOf;
using testing::HasSubstr;

Model through_duct(const std::vector<Model>& bodies) { return test::through_duct(bodies); }

/// Returns a bar along y, longer than the duct is wide; unless the bar is slanted, its sections on both sides are equal.
Model bar(double slant = 0.0) { return make_cylinder("bar", {-slant, -1.0, 0.0}, {slant, 1.0, 0.0}, 0.25); }

Model blade(double trailing_edge) { return test::blade(trailing_edge, "2412", 0.06); }

SurfaceMeshOptions alike(double max_edge, const std::string& pairs = "tunnel_left,tunnel_right") {
  SurfaceMeshOptions options = edges_of(max_edge);
  options.sizes.min_edge = 0.1 * max_edge;
  options.sizes.growth = 1.4;
  options.periodic = side_pairs(pairs);
  return options;
}

/// Vertices of edges between a patch and other patches, and these edges.
struct PatchBorder {
  std::vector<Point> points;
  std::vector<std::array<Point, 2>> edges;
};

PatchBorder border_of(const TriMesh& mesh, const std::string& name) {
  std::set<std::array<VertexId, 2>> open;
  for (const TriangleId t : mesh.triangles.ids())
    if (mesh.patches[mesh.triangle_patch[t]].name == name)
      for (std::size_t k = 0; k < 3; ++k) {
        const VertexId a = mesh.triangles[t][k], b = mesh.triangles[t][(k + 1) % 3];
        if (open.erase({b, a}) == 0) open.insert({a, b});
      }
  std::set<VertexId> vertices;
  PatchBorder border;
  for (const auto& [a, b] : open) {
    vertices.insert({a, b});
    border.edges.push_back({mesh.points[a], mesh.points[b]});
  }
  for (const VertexId v : vertices) border.points.push_back(mesh.points[v]);
  return border;
}

/// Checks that every vertex and every edge has its image, within rounding or within the corner tolerance of the boolean operation.
void expect_images(const TriMesh& mesh, const std::string& first, const std::string& second, const Vec3& way, std::size_t n_least) {
  constexpr double k_off = 1e-9;
  const PatchBorder here = border_of(mesh, first), there = border_of(mesh, second);
  EXPECT_EQ(here.points.size(), there.points.size());
  EXPECT_GE(here.points.size(), n_least);
  for (const Point& p : here.points)
    EXPECT_TRUE(std::ranges::any_of(there.points, [&](const Point& q) { return distance(p + way, q) < k_off; })) << format_point(p);
  for (const auto& [a, b] : here.edges)
    EXPECT_TRUE(
        std::ranges::any_of(there.edges, [&](const std::array<Point, 2>& e) { return distance(a + way, e[1]) < k_off && distance(b + way, e[0]) < k_off; }))
        << format_point(a) << " to " << format_point(b);
}

PeriodicBorders borders_of(const Model& model, const SurfaceMeshOptions& options) {
  const Column<EdgeId, EdgeSamples> edges = sample_edges(model, k_context);
  const ModelSizes sizes = sizes_of_faces(model, edges, options, {}, k_context);
  std::vector<AbsorbedPart> absorbed;
  ModelTopology topology = absorb_small_parts(model, edges, sizes, absorbed);
  return find_periodic_borders(model, edges, options.periodic, topology);
}

std::size_t n_stops(const PeriodicBorders& borders) {
  std::size_t n = 0;
  for (const std::vector<BorderStop>& stops : borders.stops) n += stops.size();
  return n;
}

void expect_closed(const TriMesh& mesh) {
  std::map<std::array<VertexId, 2>, int> edges;
  for (const TriangleVertices& v : mesh.triangles)
    for (std::size_t k = 0; k < 3; ++k) ++edges[{v[k], v[(k + 1) % 3]}];
  for (const auto& [edge, n] : edges) {
    EXPECT_EQ(n, 1);
    EXPECT_EQ(edges.count({edge[1], edge[0]}), 1u);
  }
}

TEST(PeriodicBorders, ABarThroughBothSides) {
  const Model model = through_duct({bar()});
  const SurfaceMesh mesh = mesh_model(model, alike(0.15), {}, k_context);
  expect_closed(mesh.mesh);
  expect_images(mesh.mesh, "tunnel_left", "tunnel_right", {0, 1, 0}, 60);
  EXPECT_GT(mesh.report.share_20_130, 0.999);
  EXPECT_EQ(n_stops(borders_of(model, alike(0.15))), 2u);  // the boolean operation leaves a corner at a different location of each side
}

TEST(PeriodicBorders, WingsWithSharpBluntNearlySharpTrailingEdges) {
  for (const double trailing_edge : {0.0, 2e-4, 0.01}) {  // the second edge is absorbed: both sides keep the same corner
    const Model model = through_duct({blade(trailing_edge)});
    const SurfaceMesh mesh = mesh_model(model, alike(0.1), {}, k_context);
    expect_closed(mesh.mesh);
    expect_images(mesh.mesh, "tunnel_left", "tunnel_right", {0, 1, 0}, 80);
  }
}

TEST(PeriodicBorders, BandsAndStripsEndAtThem) {
  const Model model = through_duct({blade(0.01)});
  SurfaceMeshOptions options = alike(0.1);
  options.sizes.leading_edge_chordwise = options.sizes.trailing_edge_chordwise = 0.01;
  options.sizes.leading_edge_stretch = options.sizes.trailing_edge_stretch = 5.0;
  options.trailing_edge_cells = 3.0;
  const SurfaceMesh mesh = mesh_model(model, options, {}, k_context);
  EXPECT_GT(mesh.report.bands.n_triangles, 100);
  EXPECT_EQ(mesh.report.bands.n_strips, 2);  // on the halves of the wing
  expect_closed(mesh.mesh);
  expect_images(mesh.mesh, "tunnel_left", "tunnel_right", {0, 1, 0}, 80);
}

TEST(PeriodicBorders, WhatOneSideAsksForTheOtherGets) {
  const Model model = through_duct({bar()});
  const std::array<Rule, 1> rules = {Rule{.names = "tunnel_left", .options = {{"max_edge", 0.05}}}};
  const SurfaceMesh mesh = mesh_model(model, alike(0.2), rules, k_context);
  expect_closed(mesh.mesh);
  expect_images(mesh.mesh, "tunnel_left", "tunnel_right", {0, 1, 0}, 200);
  EXPECT_GT(mesh.report.min_angle, 20.0 * test::k_degree);
}

TEST(PeriodicBorders, PairsInTwoDirectionsShareEdges) {
  const Model model = through_duct({bar(), make_cylinder("post", {1.5, 0.05, -2.0}, {1.5, 0.05, 2.0}, 0.15)});
  const SurfaceMesh mesh = mesh_model(model, alike(0.15, " tunnel_right , tunnel_left;tunnel_floor,tunnel_ceiling"), {}, k_context);
  expect_closed(mesh.mesh);
  expect_images(mesh.mesh, "tunnel_left", "tunnel_right", {0, 1, 0}, 60);
  expect_images(mesh.mesh, "tunnel_floor", "tunnel_ceiling", {0, 0, 2}, 60);
}

TEST(PeriodicBorders, CornersOfOneSideAreVerticesOfBoth) {
  // Two halves, rotated against each other, so that their seams lie at different locations.
  Model left = make_cylinder("bar", {0.0, -1.0, 0.0}, {0.0, 0.0, 0.0}, 0.25), right = make_cylinder("bar", {0.0, 0.0, 0.0}, {0.0, 1.0, 0.0}, 0.25);
  right = transformed(right, rotation({0.0, 0.0, 0.0}, {0.0, 1.0, 0.0}, 0.7));
  const Model model = through_duct({left, right});
  const PeriodicBorders borders = borders_of(model, alike(0.15));
  EXPECT_GE(n_stops(borders), 2u);
  for (const std::vector<std::size_t>& kind : borders.kinds) EXPECT_EQ(kind.size(), 2u);
  const SurfaceMesh mesh = mesh_model(model, alike(0.15), {}, k_context);
  expect_closed(mesh.mesh);
  expect_images(mesh.mesh, "tunnel_left", "tunnel_right", {0, 1, 0}, 60);
}

TEST(PeriodicBorders, OpenEndsAreSidesNamedAfterTheirPlanes) {
  // The remainder of a wing between two planes: volume_mesh closes the end planes by patches of these names.
  Model wing = through_duct({blade(0.01)});
  Column<FaceId, ModelFace> left;
  for (const ModelFace& face : wing.faces)
    if (face.name == "blade") left.push_back(face);
  wing.faces = std::move(left);
  wing.solids = {};
  const SurfaceMesh mesh = mesh_model(wing, alike(0.1, "symmetry_y_min,symmetry_y_max"), {}, k_context);
  std::vector<Point> low, high;
  std::map<std::array<VertexId, 2>, int> edges;
  for (const TriangleVertices& v : mesh.mesh.triangles)
    for (std::size_t k = 0; k < 3; ++k) ++edges[{v[k], v[(k + 1) % 3]}];
  for (const auto& [edge, n] : edges)
    if (!edges.contains({edge[1], edge[0]})) (mesh.mesh.points[edge[0]].y < 0.0 ? low : high).push_back(mesh.mesh.points[edge[0]]);
  EXPECT_GT(low.size(), 20u);
  EXPECT_EQ(low.size(), high.size());
  for (const Point& p : low) EXPECT_TRUE(std::ranges::any_of(high, [&](const Point& q) { return distance(p + Vec3{0, 1, 0}, q) < 1e-9; })) << format_point(p);
}

TEST(PeriodicBorders, TranslationBetweenRoundSidesFollowsFromBorders) {
  TestSectionOptions options;
  options.length = 4.0;
  options.diameter = 1.0;
  const Transform turn = rotation({0.1, 0.2, 0.3}, {1.0, 2.0, 0.5}, 0.8);
  const Model round = transformed(make_test_section(options), turn);
  const SurfaceMesh mesh = mesh_model(round, alike(0.15, "inflow,outflow"), {}, k_context);
  expect_images(mesh.mesh, "inflow", "outflow", turn.point({4.0, 0.0, 0.0}) - turn.point({0.0, 0.0, 0.0}), 18);
}

TEST(PeriodicBorders, AnyNumberOfThreadsGivesTheSame) {
  const Model model = through_duct({blade(0.01)});
  const SurfaceMesh one = mesh_model(model, alike(0.1), {}, RunContext({.threads = 1}));
  for (const int threads : {2, 7}) {
    const SurfaceMesh other = mesh_model(model, alike(0.1), {}, RunContext({.threads = threads}));
    EXPECT_EQ(one.mesh.points.raw(), other.mesh.points.raw());
    EXPECT_EQ(one.mesh.triangles.raw(), other.mesh.triangles.raw());
  }
}

TEST(PeriodicBorders, SidesThatAreNoImagesAreRefused) {
  const Model model = through_duct({bar()});
  expect_error(ErrorCode::bad_argument, "the model has no face \"tunnel_rigth\"",
               [&] { mesh_model(model, alike(0.2, "tunnel_left,tunnel_rigth"), {}, k_context); });
  expect_error(ErrorCode::bad_argument, "named twice", [&] { mesh_model(model, alike(0.2, "tunnel_left,tunnel_left"), {}, k_context); });
  expect_error(ErrorCode::bad_argument, "not a list of pairs", [&] { mesh_model(model, alike(0.2, "tunnel_left"), {}, k_context); });
  expect_error(ErrorCode::bad_argument, "have no image within", [&] { mesh_model(model, alike(0.2, "tunnel_left,tunnel_floor"), {}, k_context); });
  const Model slanted = through_duct({bar(0.2)});
  expect_error(ErrorCode::bad_argument, "the largest deviation is 0.2 m", [&] { mesh_model(slanted, alike(0.2), {}, k_context); });
}

TEST(PeriodicBorders, PairsAreReadAndWritten) {
  EXPECT_TRUE(side_pairs("").empty());
  const std::vector<PeriodicNames> pairs = side_pairs("left, right ;floor,ceiling");
  EXPECT_EQ(pairs, (std::vector<PeriodicNames>{{"left", "right"}, {"floor", "ceiling"}}));
  EXPECT_EQ(side_pairs(side_pairs_text(pairs)), pairs);
  for (const char* wrong : {"left", ",right", "left,", "a,b,c", "a,b;c"}) EXPECT_THROW(side_pairs(wrong), Error) << wrong;
  require_separable(pairs);
  for (const char* name : {"a,b", "a;b", " a", "a ", ""})
    expect_error(ErrorCode::bad_argument, "are separated by commas and semicolons", [&] { require_separable({{"left", name}}); });
}

}  // namespace
}  // namespace sterna::surfmesh
