// Bands of stretched triangles along leading and trailing edges, and strips of cells on blunt trailing edges: their guarantees, measured on the triangles
// themselves.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <numbers>
#include <set>

#include "geom/base/error.h"
#include "geom/cad/unite.h"
#include "geom/math/measures.h"
#include "geom/model/airfoil.h"
#include "geom/model/components.h"
#include "geom/model/cpacs.h"
#include "geom/model/shapes.h"
#include "surfmesh/model/surface_mesh.h"
#include "tests/support/data.h"
#include "tests/support/test_constants.h"

namespace sterna::surfmesh {
namespace {

using testing::HasSubstr;

using test::k_context;

/// Returns a swept and tapered wing, kinked at 0 and 1.5 m, with round tips.
Model swept_wing(double trailing_edge) {
  Wing wing{.name = "W", .is_symmetric = true, .trailing_edge = trailing_edge};
  for (const double y : {4.0, 1.5, 0.0}) {
    WingSection s{.name = "y", .leading_edge = {0.5 * y, y, 0.0}, .chord = 2.0 - 0.3 * y};
    s.points = naca_airfoil("2412").points;
    wing.sections.push_back(s);
  }
  wing.right_tip = wing.left_tip = {CapShape::strip, 1.0};
  return make_wing(wing);
}

Model fuselage() {
  Body body{.name = "B"};
  for (const double x : {-2.0, -0.6, 0.8, 3.6, 5.0}) body.frames.push_back({.name = "x", .center = {x, 0.0, 0.0}, .height = 1.0, .width = 1.0});
  body.nose = body.tail = {CapShape::dome, 1.5};
  return make_body(body, ComponentKind::body);
}

SurfaceMeshOptions banded(double chordwise, double stretch) {
  SurfaceMeshOptions options;
  options.sizes.leading_edge_chordwise = options.sizes.trailing_edge_chordwise = chordwise;
  options.sizes.leading_edge_stretch = options.sizes.trailing_edge_stretch = stretch;
  return options;
}

void expect_closed(const SurfaceMesh& surface) {
  std::map<std::pair<VertexId, VertexId>, int> edges;
  for (const TriangleVertices& v : surface.mesh.triangles)
    for (std::size_t k = 0; k < 3; ++k) ++edges[{v[k], v[(k + 1) % 3]}];
  for (const auto& [edge, n] : edges) {
    EXPECT_EQ(n, 1);
    EXPECT_TRUE(edges.contains({edge.second, edge.first}));
  }
  EXPECT_EQ(surface.report.n_free_edges, 0);
  EXPECT_EQ(surface.report.n_crossings, 0);
}

void expect_on_surfaces(const Model& model, const SurfaceMesh& surface) {
  for (const VertexId v : surface.mesh.points.ids()) {
    if (surface.edge_locations[v].edge.is_valid()) continue;
    const VertexLocation& location = surface.locations[v];
    EXPECT_LE(distance(model.faces[location.face].surface->point(location.at), surface.mesh.points[v]), std::max(1e-9, surface.report.max_edge_distance));
  }
}

bool is_side(FaceRole role) { return role == FaceRole::upper || role == FaceRole::lower; }

/// Edges between an upper and a lower side that face forward, or the edges at their other end.
enum class Which { leading, trailing };
std::set<EdgeId> edges_of(const Model& model, Which which) {
  std::set<EdgeId> result;
  const auto uses = uses_of_edges(model);
  for (const EdgeId e : model.edges.ids()) {
    if (uses[e].size() != 2 || model.edges[e].is_degenerate()) continue;
    const ModelFace &a = model.faces[uses[e][0].face], &b = model.faces[uses[e][1].face];
    const bool is_between = (is_side(a.role) && is_side(b.role) && a.role != b.role) || (is_side(a.role) && b.role == FaceRole::trailing_edge) ||
                            (is_side(b.role) && a.role == FaceRole::trailing_edge);
    const Point from = model.edges[e].curve->point(model.edges[e].range.from), to = model.edges[e].curve->point(model.edges[e].range.to),
                middle = model.edges[e].curve->point(0.5 * (model.edges[e].range.from + model.edges[e].range.to));
    if (!is_between || std::abs(to.y - from.y) < 0.1) continue;
    const double leading_edge = 0.5 * std::abs(middle.y);
    if ((middle.x < leading_edge + 0.3) == (which == Which::leading)) result.insert(e);
  }
  return result;
}

/// Returns the heights of the triangles on the edges, for triangles in rows.
std::vector<double> first_heights(const SurfaceMesh& surface, const std::set<EdgeId>& edges, const Model& model, std::size_t* n_isotropic = nullptr) {
  std::vector<double> result;
  const auto is_on = [&](VertexId v) { return surface.edge_locations[v].edge.is_valid() && edges.contains(surface.edge_locations[v].edge); };
  for (const TriangleId t : surface.mesh.triangles.ids()) {
    if (!is_side(model.faces[surface.triangle_face[t]].role)) continue;
    const auto& v = surface.mesh.triangles[t];
    for (std::size_t k = 0; k < 3; ++k) {
      if (!is_on(v[k]) || !is_on(v[(k + 1) % 3]) || is_on(v[(k + 2) % 3])) continue;
      if (surface.is_band[t] == 0) {
        if (n_isotropic) ++*n_isotropic;
        continue;
      }
      const Point &a = surface.mesh.points[v[k]], &b = surface.mesh.points[v[(k + 1) % 3]], &c = surface.mesh.points[v[(k + 2) % 3]];
      result.push_back(2.0 * triangle_area(a, b, c) / distance(a, b));
    }
  }
  return result;
}

/// Returns the segment lengths of the edge that ends nearest to `end`, starting there.
std::vector<double> segments_from(const Model& model, const SurfaceMesh& surface, const std::set<EdgeId>& all, Point end) {
  Point nearest{1e300, 0.0, 0.0};
  std::set<EdgeId> edges;
  for (const EdgeId e : all)
    for (const CornerId c : {model.edges[e].start, model.edges[e].end})
      if (distance(model.corners[c].point, end) < distance(nearest, end)) {
        nearest = model.corners[c].point;
        edges = {e};
      }
  end = nearest;
  std::vector<Point> points;
  for (const VertexId v : surface.mesh.points.ids())
    if (surface.edge_locations[v].edge.is_valid() && edges.contains(surface.edge_locations[v].edge)) points.push_back(surface.mesh.points[v]);
  std::sort(points.begin(), points.end(), [&](const Point& a, const Point& b) { return distance(a, end) < distance(b, end); });
  std::vector<double> result{distance(points.front(), end)};
  for (std::size_t i = 1; i < points.size(); ++i) result.push_back(distance(points[i - 1], points[i]));
  return result;
}

void expect_bands(const Model& model, const SurfaceMesh& surface, double chordwise, double stretch) {
  expect_closed(surface);
  expect_on_surfaces(model, surface);
  const BandSummary& bands = surface.report.bands;
  EXPECT_THAT(bands.notes, testing::IsEmpty());
  // Rows are inclined by up to 2 degrees near inclined borders, which makes cells there higher than the row distance by up to this factor.
  constexpr double k_growth_tolerance = 1.02;
  EXPECT_LE(bands.max_growth, 1.2 * k_growth_tolerance);
  EXPECT_GE(bands.max_growth, 1.19);
  // Whole numbers of segments reduce the stretch slightly; rows that spread around a nose increase it slightly.
  EXPECT_GE(bands.max_stretch, 0.9 * stretch);
  EXPECT_LE(bands.max_stretch, 1.1 * stretch);
  for (const Which which : {Which::leading, Which::trailing}) {
    std::size_t n_isotropic = 0;
    const std::vector<double> heights = first_heights(surface, edges_of(model, which), model, &n_isotropic);
    ASSERT_GT(heights.size(), 100u);
    for (const double h : heights) EXPECT_NEAR(h, chordwise, 0.02 * chordwise);
    EXPECT_LT(n_isotropic, heights.size() / 8);
  }
  EXPECT_EQ(std::count(surface.is_band.begin(), surface.is_band.end(), 1), bands.n_triangles);
  EXPECT_GT(surface.report.share_20_130, 0.998);  // the triangles outside the range are at the tips' sharp ends
}

TEST(WingBands, StretchedRowsAlongBothSweptWingEdges) {
  const Model model = swept_wing(0.0);
  for (const auto& [chordwise, stretch] : {std::pair(0.003, 8.0), std::pair(0.002, 20.0), std::pair(0.001, 50.0)}) {
    SCOPED_TRACE(stretch);
    expect_bands(model, mesh_model(model, banded(chordwise, stretch), {}, k_context), chordwise, stretch);
  }
}

TEST(WingBands, StretchFadesTowardsTheTips) {
  const Model model = swept_wing(0.0);
  const SurfaceMesh surface = mesh_model(model, banded(0.001, 50.0), {}, k_context);
  for (const Which which : {Which::leading, Which::trailing}) {
    const Point end = which == Which::leading ? Point{2.0, 4.0, 0.0} : Point{2.8, 4.0, 0.0};
    const std::vector<double> lengths = segments_from(model, surface, edges_of(model, which), end);
    EXPECT_LT(lengths.front(), 1.5 * 0.001);
    for (std::size_t i = 1; i < lengths.size() / 2; ++i) EXPECT_LT(lengths[i] / lengths[i - 1], 1.3) << i;
    EXPECT_GT(*std::max_element(lengths.begin(), lengths.end()), 0.9 * 0.05);
  }
}

TEST(WingBands, BluntTrailingEdgesHaveTheirNumberOfCells) {
  const Model model = swept_wing(0.004);
  for (const double cells : {4.0, 8.0, 12.0}) {
    SurfaceMeshOptions options = cells == 4.0 ? SurfaceMeshOptions() : banded(0.002, 20.0);
    options.trailing_edge_cells = cells;
    const SurfaceMesh surface = mesh_model(model, options, {}, k_context);
    if (cells == 4.0) expect_closed(surface);
    else expect_bands(model, surface, 0.002, 20.0);
    EXPECT_EQ(surface.report.bands.n_strips, 4);
    EXPECT_LE(surface.report.bands.max_strip_stretch, 50.5);
    const auto uses = uses_of_edges(model);
    std::map<EdgeId, int> n_vertices;
    for (const EdgeLocation& location : surface.edge_locations) ++n_vertices[location.edge];
    int n_short = 0;
    for (const EdgeId e : model.edges.ids()) {
      const auto is_base = [&](const EdgeUseLocation& use) {
        return model.faces[use.face].role == FaceRole::trailing_edge && model.faces[use.face].borders[0].size() == 4;
      };
      const bool is_short = !model.edges[e].is_degenerate() && std::any_of(uses[e].begin(), uses[e].end(), is_base) &&
                            distance(model.edges[e].curve->point(model.edges[e].range.from), model.edges[e].curve->point(model.edges[e].range.to)) < 0.01;
      if (!is_short) continue;
      ++n_short;
      EXPECT_EQ(n_vertices[e], static_cast<int>(cells) - 1);
    }
    EXPECT_EQ(n_short, 5);
    for (const FaceMeshSummary& face : surface.report.faces)
      if (const ModelFace& base = model.faces[face.face]; base.role == FaceRole::trailing_edge && base.borders[0].size() == 4) {
        EXPECT_EQ(face.n_band, face.n_triangles);
        EXPECT_EQ(face.n_band % (2 * static_cast<int>(cells)), 0);
      }
  }
}

TEST(WingBands, EndAtTheFuselage) {
  const Model model = cad::unite(std::vector<Model>{fuselage(), swept_wing(0.0)}, {}, k_context).model;
  const SurfaceMesh surface = mesh_model(model, banded(0.003, 8.0), {}, k_context);
  expect_bands(model, surface, 0.003, 8.0);
  // Near the leading edge sizes are small in both directions.
  const std::vector<double> lengths = segments_from(model, surface, edges_of(model, Which::leading), {0.25, 0.5, 0.0});
  EXPECT_LT(*std::min_element(lengths.begin(), lengths.begin() + 5), 2.0 * 0.003);
}

TEST(WingBands, RealWing) {
  STERNA_NEEDS_SHARED_DATA();
  const Model model = make_components(read_cpacs(test::shared_data() / "cpacs/onera_m6.xml", k_context).aircraft, k_context);
  SurfaceMeshOptions options = banded(0.001, 20.0);
  options.trailing_edge_cells = 4;
  const SurfaceMesh surface = mesh_model(model, options, {}, k_context);
  expect_closed(surface);
  EXPECT_THAT(surface.report.bands.notes, testing::IsEmpty());
  EXPECT_EQ(surface.report.bands.n_strips, 2);
  EXPECT_EQ(surface.report.bands.n_edges, 6);
  EXPECT_GT(surface.report.bands.max_stretch, 18.0);
  EXPECT_LE(surface.report.bands.max_growth, 1.2 * 1.02);
  EXPECT_GT(surface.report.share_20_130, 0.999);
}

TEST(WingBands, TheSameForAnyNumberOfThreads) {
  const Model model = swept_wing(0.004);
  SurfaceMeshOptions options = banded(0.004, 10.0);
  options.trailing_edge_cells = 8;
  const SurfaceMesh one = mesh_model(model, options, {}, RunContext({.threads = 1}));
  for (const int threads : {2, 7}) {
    const SurfaceMesh other = mesh_model(model, options, {}, RunContext({.threads = threads}));
    EXPECT_EQ(one.mesh.points, other.mesh.points);
    EXPECT_EQ(one.mesh.triangles, other.mesh.triangles);
  }
}

TEST(WingBands, WishesThatCannotBeMetAreTold) {
  const Model box = make_box("crate", {0, 0, 0}, {1, 1, 1});
  const Rule rule{.names = "cra*", .options = {{"leading_edge_chordwise", 0.01}, {"trailing_edge_stretch", 8.0}}};
  const SurfaceMesh surface = mesh_model(box, {}, std::vector{rule}, k_context);
  ASSERT_EQ(surface.report.bands.notes.size(), 2u);
  EXPECT_THAT(surface.report.bands.notes[0], HasSubstr("no edge of"));
  EXPECT_THAT(surface.report.bands.notes[0], HasSubstr("leading edge"));
  EXPECT_THAT(surface.report.bands.notes[1], HasSubstr("trailing edge"));
  EXPECT_EQ(surface.report.bands.n_triangles, 0);
}

TEST(WingBands, RulesForPatchesReachTheirFacesOnly) {
  const Model model = swept_wing(0.0);
  const Rule rule{.names = "W", .options = {{"leading_edge_chordwise", 0.004}, {"leading_edge_stretch", 8.0}}};
  const SurfaceMesh surface = mesh_model(model, {}, std::vector{rule}, k_context);
  expect_closed(surface);
  EXPECT_EQ(surface.report.bands.n_edges, 4);
  EXPECT_TRUE(first_heights(surface, edges_of(model, Which::trailing), model).empty());
  for (const double h : first_heights(surface, edges_of(model, Which::leading), model)) EXPECT_NEAR(h, 0.004, 0.02 * 0.004);
}

}  // namespace
}  // namespace sterna::surfmesh
