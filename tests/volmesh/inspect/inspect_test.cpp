// Surfaces with one known defect each: inspection finds it at its location and nothing else; clean shapes have no findings.
#include "volmesh/inspect/inspect.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <numbers>
#include <set>

#include "tests/support/class_bodies.h"
#include "tests/support/test_constants.h"
#include "tests/support/test_shapes.h"
#include "tests/support/voxels.h"
#include "volmesh/flow/boundary_layer.h"

namespace sterna::volmesh {
namespace {

using testing::UnorderedElementsAre;
using Kind = FindingKind;

using test::k_degree;

InspectRequest request_of(int layers, double first_height) {
  InspectRequest request;
  request.volume.envelope.layers = layers;
  request.volume.envelope.max_growth = 1.4;  // so that the heights of these layers match the tetrahedra
  request.volume.envelope.growth = "local";
  request.volume.envelope.first_height = first_height;
  return request;
}

InspectReport inspect(const TriMesh& mesh, const InspectRequest& request = {}, int threads = 2) {
  return inspect_wall(mesh, request, RunContext({.threads = threads}));
}

std::set<Kind> kinds(const InspectReport& report) {
  std::set<Kind> set;
  for (const Finding& finding : report.findings) {
    set.insert(finding.kind);
    EXPECT_TRUE(finding.kind == Kind::refused || !finding.advice.empty()) << to_string(finding.kind) << " has no advice";
    EXPECT_EQ(finding.advice.find('\n'), std::string::npos) << "one line";
  }
  return set;
}

TriMesh moved(TriMesh mesh, const Vec3& by, const Vec3& scale = {1.0, 1.0, 1.0}) {
  for (Point& p : mesh.points) p = Point{scale.x * p.x, scale.y * p.y, scale.z * p.z} + by;
  return mesh;
}

TriMesh joined(TriMesh a, const TriMesh& b) {
  append(a, b);
  return a;
}

TriMesh turned_over(TriMesh mesh) {
  for (TriangleVertices& t : mesh.triangles) std::swap(t[1], t[2]);
  return mesh;
}

VertexId nearest_vertex(const TriMesh& mesh, const Point& p) {
  VertexId best(0);
  for (const VertexId v : mesh.points.ids())
    if (distance(mesh.points[v], p) < distance(mesh.points[best], p)) best = v;
  return best;
}

const TriMeshField& field(const InspectReport& report, const std::string& name) {
  for (const TriMeshField& f : report.fields)
    if (f.name == name) return f;
  throw std::runtime_error("no field " + name);
}

/// Returns the finding of this kind, which must exist.
const Finding& the(const InspectReport& report, Kind kind) {
  const Finding* finding = report.find(kind);
  if (!finding) throw std::runtime_error("no finding " + std::string(to_string(kind)));
  return *finding;
}

/// Returns the centres of the triangles that the picture marks.
std::vector<Point> marked(const InspectReport& report, Kind kind) {
  std::vector<Point> locations;
  for (const TriangleId t : report.mesh.triangles.ids()) {
    if (field(report, "finding").values[t.index()] != static_cast<float>(kind)) continue;
    const auto [a, b, c] = corners(report.mesh, t);
    locations.push_back((a + b + c) / 3.0);
  }
  return locations;
}

// ---- Clean shapes ---------------------------------------------------------------------------------------------------------------------------

TEST(Inspect, SaysNothingOfCleanShapes) {
  for (const TriMesh& mesh : {test::cube(16), test::sphere(10, 0.5)}) {
    const InspectReport report = inspect(mesh, request_of(20, 1e-4));
    EXPECT_THAT(kinds(report), UnorderedElementsAre(Kind::wake)) << (report.findings.empty() ? "" : report.findings.front().text);
    EXPECT_TRUE(report.is_ok() && report.is_closed && report.layer.is_known);
    EXPECT_EQ(report.n_bodies, 1);
    EXPECT_NEAR(report.length, 1.0, 0.05);
    EXPECT_GT(report.layer.coverage, 0.999);
    EXPECT_EQ(report.layer.collapsed, 0.0);
    ASSERT_EQ(report.layer.patches.size(), 1u);
    EXPECT_EQ(report.layer.patches[0].name, mesh.patches[PatchId(0)].name);
  }
}

TEST(Inspect, ReportsOmittedChecksWithoutFirstHeight) {
  const InspectReport report = inspect(test::cube(16));
  EXPECT_THAT(kinds(report), UnorderedElementsAre(Kind::not_looked_at));
  EXPECT_FALSE(report.layer.is_known);
  EXPECT_NE(report.findings[0].text.find("no first_height was given"), std::string::npos);
}

TEST(Inspect, FieldsFitTheSurface) {
  const InspectReport report = inspect(test::cube(6), request_of(20, 1e-3));
  std::set<std::string> names;
  for (const TriMeshField& f : report.fields) {
    EXPECT_EQ(f.values.size(), f.is_at_vertices ? report.mesh.n_vertices() : report.mesh.n_triangles()) << f.name;
    EXPECT_FALSE(f.title.empty());
    EXPECT_TRUE(names.insert(f.name).second);
  }
  EXPECT_THAT(names, testing::IsSupersetOf({"finding", "smallest_angle", "visibility_angle", "height_share", "gap", "top_ratio"}));
  // At the corners of the cube the best direction is at acos(1/sqrt 3) to the three face normals, at its edges at 45 degrees.
  const VertexId corner = nearest_vertex(report.mesh, {1, 1, 1}), edge = nearest_vertex(report.mesh, {1, 1, 0.5}),
                 face = nearest_vertex(report.mesh, {0.5, 0.5, 1});
  EXPECT_NEAR(field(report, "visibility_angle").values[corner.index()], std::acos(1.0 / std::sqrt(3.0)) / k_degree, 1e-3);
  EXPECT_NEAR(field(report, "visibility_angle").values[edge.index()], 45.0, 1e-3);
  EXPECT_NEAR(field(report, "visibility_angle").values[face.index()], 0.0, 1e-3);
}

// ---- The surface ----------------------------------------------------------------------------------------------------------------------------

TEST(Inspect, FindsANeedle) {
  TriMesh mesh = test::cube(8);
  const VertexId v = nearest_vertex(mesh, {0.5, 0.5, 1.0});
  mesh.points[v] = {0.5, 0.6249, 1.0};  // 1e-4 from its neighbour
  const InspectReport report = inspect(mesh);
  EXPECT_THAT(kinds(report), UnorderedElementsAre(Kind::needle, Kind::not_looked_at));
  const Finding& needle = the(report, Kind::needle);
  EXPECT_EQ(needle.count, 2);  // the triangles at the short edge
  EXPECT_EQ(needle.unit, "deg");
  EXPECT_LT(needle.value, 0.06);  // atan(1e-4 / 0.125)
  ASSERT_FALSE(needle.locations.empty());
  EXPECT_LT(distance(needle.locations[0].position, {0.5, 0.625, 1.0}), 0.125);
  EXPECT_EQ(needle.locations[0].patch, "cube");
  EXPECT_EQ(marked(report, Kind::needle).size(), 2u);
}

TEST(Inspect, FindsATriangleMuchSmallerThanItsNeighbours) {
  TriMesh mesh = test::cube(8);
  const TriangleId t(0);
  const TriangleVertices v = mesh.triangles[t];
  const auto [a, b, c] = corners(mesh, t);
  const Point middle = (a + b + c) / 3.0;
  std::array<VertexId, 3> w;  // a triangle within the other, a thirtieth of its size
  for (std::size_t k = 0; k < 3; ++k) w[k] = mesh.points.push_back(middle + 0.03 * (mesh.points[v[k]] - middle));
  mesh.triangles[t] = {w[0], w[1], w[2]};
  for (std::size_t k = 0; k < 3; ++k) {
    const std::size_t next = (k + 1) % 3;
    mesh.triangles.push_back({v[k], v[next], w[next]});
    mesh.triangles.push_back({v[k], w[next], w[k]});
    for (int n = 0; n < 2; ++n) mesh.triangle_patch.push_back(PatchId(0));
  }
  const InspectReport report = inspect(mesh);
  EXPECT_THAT(kinds(report), UnorderedElementsAre(Kind::size_jump, Kind::not_looked_at));
  EXPECT_EQ(the(report, Kind::size_jump).count, 3);
  EXPECT_LT(distance(the(report, Kind::size_jump).locations.at(0).position, middle), 0.02);
}

TEST(Inspect, FindsAShortEdge) {
  TriMesh mesh = test::cube(8);
  mesh.points[nearest_vertex(mesh, {0.5, 0.5, 1.0})] = {0.5, 0.625 - 1e-9, 1.0};
  const InspectReport report = inspect(mesh);
  EXPECT_THAT(kinds(report), UnorderedElementsAre(Kind::needle, Kind::short_edge, Kind::not_looked_at));
  const Finding& edge = the(report, Kind::short_edge);
  EXPECT_EQ(edge.count, 1);
  EXPECT_NEAR(edge.value, 1e-9, 1e-12);
  EXPECT_LT(distance(edge.locations.at(0).position, {0.5, 0.625, 1.0}), 1e-6);
  EXPECT_NE(edge.advice.find("weld_tolerance"), std::string::npos);
}

/// A wedge of n strips in x and y with its edge along y at x = 0.
TriMesh wedge(double angle, int n) {
  TriMesh mesh;
  mesh.patches.push_back({"wedge", PatchKind::wall});
  const double slope = std::tan(0.5 * angle);
  std::vector<std::array<std::vector<VertexId>, 2>> side(static_cast<std::size_t>(n) + 1);
  for (int j = 0; j <= n; ++j) {
    for (int i = 0; i <= n; ++i) {
      const double x = static_cast<double>(i) / n, y = static_cast<double>(j) / n;
      const VertexId above = mesh.points.push_back({x, y, slope * x});
      side[static_cast<std::size_t>(j)][0].push_back(above);
      side[static_cast<std::size_t>(j)][1].push_back(i == 0 ? above : mesh.points.push_back({x, y, -slope * x}));
    }
  }
  const auto add = [&](VertexId a, VertexId b, VertexId c) {
    if (a == b || b == c || c == a) return;
    mesh.triangles.push_back({a, b, c});
    mesh.triangle_patch.push_back(PatchId(0));
  };
  const auto at = [&](int i, int j, std::size_t s) { return side[static_cast<std::size_t>(j)][s][static_cast<std::size_t>(i)]; };
  for (int j = 0; j < n; ++j) {
    for (int i = 0; i < n; ++i) {
      add(at(i, j, 0), at(i + 1, j, 0), at(i + 1, j + 1, 0));
      add(at(i, j, 0), at(i + 1, j + 1, 0), at(i, j + 1, 0));
      add(at(i, j, 1), at(i + 1, j + 1, 1), at(i + 1, j, 1));
      add(at(i, j, 1), at(i, j + 1, 1), at(i + 1, j + 1, 1));
    }
    add(at(n, j, 0), at(n, j, 1), at(n, j + 1, 0));
    add(at(n, j, 1), at(n, j + 1, 1), at(n, j + 1, 0));
  }
  for (int i = 0; i < n; ++i) {  // ends
    add(at(i, 0, 0), at(i, 0, 1), at(i + 1, 0, 1));
    add(at(i, 0, 0), at(i + 1, 0, 1), at(i + 1, 0, 0));
    add(at(i, n, 0), at(i + 1, n, 1), at(i, n, 1));
    add(at(i, n, 0), at(i + 1, n, 0), at(i + 1, n, 1));
  }
  return mesh;
}

TEST(Inspect, FindsFoldAndVisibilityOfItsEdge) {
  InspectRequest request;
  request.limits.fold_angle = 10.0 * k_degree;
  const InspectReport report = inspect(wedge(8.0 * k_degree, 7), request);
  EXPECT_THAT(kinds(report), UnorderedElementsAre(Kind::fold, Kind::visibility, Kind::not_looked_at));
  const Finding& fold = the(report, Kind::fold);
  EXPECT_EQ(fold.count, 7);
  EXPECT_NEAR(fold.value, 8.0, 1e-6);
  EXPECT_EQ(fold.locations.size(), 5u);  // max_places
  for (const FindingLocation& location : fold.locations) EXPECT_EQ(location.position.x, 0.0);
  EXPECT_NE(fold.text.find("(0 of them with fluid in between)"), std::string::npos);
  // Two facets that turn by 172 degrees have a visibility angle of half of that.
  const Finding& edge = the(report, Kind::visibility);
  EXPECT_NEAR(edge.value, 86.0, 0.5);  // slightly more at the ends
  EXPECT_EQ(edge.locations.at(0).position.x, 0.0);
  EXPECT_THAT(kinds(inspect(wedge(8.0 * k_degree, 7))), UnorderedElementsAre(Kind::visibility, Kind::not_looked_at)) << "8 degrees are no fold by default";
}

TEST(Inspect, FindsAVertexThatNoDirectionServes) {
  const TriMesh mesh = test::chain_of_cubes(4);
  for (const InspectRequest& request : {InspectRequest{}, request_of(15, 1e-3)}) {
    const InspectReport report = inspect(mesh, request);
    const Finding& hidden = the(report, Kind::hidden);
    EXPECT_EQ(hidden.count, 1);
    EXPECT_GE(hidden.value, 90.0 - 1e-6);
    EXPECT_LT(distance(hidden.locations.at(0).position, {1, 1, 1}), 1e-9);
    if (!report.layer.is_known) continue;
    EXPECT_GT(report.layer.collapsed, 0.0);
    ASSERT_TRUE(report.find(Kind::collapsed));
    EXPECT_LT(distance(the(report, Kind::collapsed).locations.at(0).position, {1, 1, 1}), 1e-9);
  }
  EXPECT_THAT(kinds(inspect(mesh)), UnorderedElementsAre(Kind::hidden, Kind::not_looked_at));
}

TEST(Inspect, FindsCrossingsWithTheirPairs) {
  const InspectReport report = inspect(joined(test::cube(4), moved(test::cube(4), {0.6, 0.55, 0.52})), request_of(20, 1e-4));
  EXPECT_THAT(kinds(report), UnorderedElementsAre(Kind::crossing, Kind::bodies, Kind::not_looked_at));
  EXPECT_FALSE(report.is_ok());
  const Finding& crossing = the(report, Kind::crossing);
  EXPECT_EQ(crossing.severity, Severity::error);
  EXPECT_GT(crossing.count, 10);
  Box overlap;  // of the two cubes, extended by one triangle
  overlap.add(Vec3{0.6, 0.55, 0.52} - Vec3{0.25, 0.25, 0.25});
  overlap.add(Vec3{1.25, 1.25, 1.25});
  for (const FindingLocation& location : crossing.locations) {
    for (std::size_t axis = 0; axis < 3; ++axis) EXPECT_TRUE(location.position[axis] >= overlap.min[axis] && location.position[axis] <= overlap.max[axis]);
    EXPECT_NE(location.what.find(" and "), std::string::npos);
  }
  EXPECT_FALSE(marked(report, Kind::crossing).empty());
  EXPECT_FALSE(report.layer.is_known);
}

TEST(Inspect, FindsAHole) {
  TriMesh mesh;
  const TriMesh whole = test::cube(8);
  mesh.points = whole.points;
  mesh.patches = whole.patches;
  Point hole;
  for (const TriangleId t : whole.triangles.ids()) {
    const auto [a, b, c] = corners(whole, t);
    if (t.value() == 100) hole = (a + b + c) / 3.0;
    if (t.value() == 100) continue;
    mesh.triangles.push_back(whole.triangles[t]);
    mesh.triangle_patch.push_back(PatchId(0));
  }
  const InspectReport report = inspect(mesh, request_of(20, 1e-4));
  EXPECT_FALSE(report.is_ok());
  EXPECT_FALSE(report.is_closed);
  EXPECT_THAT(kinds(report), UnorderedElementsAre(Kind::open, Kind::not_looked_at));
  EXPECT_EQ(the(report, Kind::open).count, 3);
  EXPECT_LT(distance(the(report, Kind::open).locations.at(0).position, hole), 0.125);
  for (const Point& p : marked(report, Kind::open)) EXPECT_LT(distance(p, hole), 0.2);
  EXPECT_EQ(marked(report, Kind::open).size(), 3u);
}

TEST(Inspect, DoubtsTheUnit) {
  const InspectReport report = inspect(test::sphere(6, 2000.0));
  EXPECT_THAT(kinds(report), UnorderedElementsAre(Kind::unit, Kind::not_looked_at));
  EXPECT_NE(the(report, Kind::unit).advice.find("unit = mm"), std::string::npos);
  EXPECT_THAT(kinds(inspect(test::sphere(6, 1e-4))), UnorderedElementsAre(Kind::unit, Kind::not_looked_at));
}

TEST(Inspect, FindsABodyInABody) {
  const InspectReport report = inspect(joined(test::sphere(6, 1.0), turned_over(test::sphere(6, 0.3))));
  EXPECT_THAT(kinds(report), UnorderedElementsAre(Kind::cavity, Kind::bodies, Kind::not_looked_at));
  EXPECT_EQ(the(report, Kind::cavity).count, 1);
  EXPECT_LT(norm(the(report, Kind::cavity).locations.at(0).position), 0.01);
  EXPECT_EQ(report.n_bodies, 2);
}

TEST(Inspect, FindsBodiesThatNearlyTouch) {
  constexpr double apart = 1e-4;
  const InspectReport report = inspect(joined(test::cube(4), moved(test::cube(4), {1.0 + apart, 0.0, 0.0})));
  EXPECT_THAT(kinds(report), UnorderedElementsAre(Kind::contact, Kind::bodies, Kind::not_looked_at));
  const Finding& contact = the(report, Kind::contact);
  EXPECT_EQ(contact.count, 2 * 25);  // all vertices of both faces
  EXPECT_GT(contact.value, apart / 0.5);
  EXPECT_LT(contact.value, apart / 0.2);
  EXPECT_NEAR(contact.locations.at(0).position.x, 1.0, 1e-3);
  // Opposite sides of a solid are not a contact: a thinner plate, seen from outside.
  InspectRequest request;
  EXPECT_FALSE(inspect(moved(test::cube(4), {}, {1.0, 1.0, 1e-3}), request).find(Kind::contact));
}

TEST(Inspect, FindsACoarseCurve) {
  const TriMesh icosahedron = test::sphere(1);
  InspectRequest request;
  request.volume.envelope.feature_angle = 60.0 * k_degree;
  const InspectReport report = inspect(icosahedron, request);
  EXPECT_THAT(kinds(report), UnorderedElementsAre(Kind::coarse, Kind::not_looked_at));
  EXPECT_EQ(the(report, Kind::coarse).count, 30);
  EXPECT_NEAR(the(report, Kind::coarse).value, 180.0 - 138.1897, 1e-3);  // its dihedral angle
  request.volume.envelope.feature_angle = 25.0 * k_degree;
  EXPECT_THAT(kinds(inspect(icosahedron, request)), UnorderedElementsAre(Kind::not_looked_at)) << "edges that are meant";
}

// ---- The layer ------------------------------------------------------------------------------------------------------------------------------

TEST(Inspect, MeasuresAGapAgainstTheLayers) {
  constexpr double gap = 0.03;
  const TriMesh plates = joined(moved(test::cube(16), {}, {1.0, 1.0, 0.2}), moved(test::cube(16), {0.0, 0.0, 0.2 + gap}, {1.0, 1.0, 0.2}));
  const InspectReport report = inspect(plates, request_of(20, 1e-4));
  EXPECT_THAT(kinds(report), UnorderedElementsAre(Kind::bodies, Kind::lowered, Kind::wake));
  const Finding& lowered = the(report, Kind::lowered);
  EXPECT_EQ(lowered.severity, Severity::warn);
  EXPECT_GT(lowered.count, 2 * 15 * 15);
  EXPECT_LT(lowered.value, 0.2);
  EXPECT_NE(lowered.advice.find("max_thickness"), std::string::npos);
  for (const FindingLocation& location : lowered.locations) EXPECT_NEAR(location.position.z, 0.2 + 0.5 * gap, 0.51 * gap);
  EXPECT_NEAR(1.0 - report.layer.coverage, lowered.share, 1e-9);
  int n = 0;
  for (const VertexId v : report.mesh.points.ids()) {
    const float value = field(report, "gap").values[v.index()];
    const Point p = report.mesh.points[v];
    const bool is_inside = p.x > 0.2 && p.x < 0.8 && p.y > 0.2 && p.y < 0.8 && std::abs(p.z - 0.2 - 0.5 * gap) < 0.51 * gap;
    if (!is_inside) continue;
    EXPECT_NEAR(value, gap, 1e-6);
    ++n;
  }
  EXPECT_GE(n, 2 * 9 * 9);
  // Thin layers have none of these findings.
  EXPECT_THAT(kinds(inspect(plates, request_of(8, 1e-4))), testing::Not(testing::Contains(Kind::lowered)));
}

TEST(Inspect, TellsOfCompressedAndCollapsedLayers) {
  const TriMesh plates = joined(moved(test::cube(16), {}, {1.0, 1.0, 0.2}), moved(test::cube(16), {0.0, 0.0, 0.203}, {1.0, 1.0, 0.2}));
  const InspectReport compressed = inspect(plates, request_of(20, 1e-4));  // the first cells need 2 mm, about 0.75 mm are available on each side
  ASSERT_TRUE(compressed.find(Kind::compressed));
  EXPECT_GT(compressed.layer.compressed, 0.2);
  EXPECT_NE(the(compressed, Kind::compressed).advice.find("layers = "), std::string::npos);
  const InspectReport collapsed = inspect(plates, request_of(20, 1e-3));  // a fifth of the first cells is 4 mm
  ASSERT_TRUE(collapsed.find(Kind::collapsed));
  EXPECT_GT(collapsed.layer.collapsed, 0.2);
  EXPECT_TRUE(collapsed.is_ok()) << "it can be meshed";
}

TEST(Inspect, ComparesFirstAndLastCellsWithTheEdges) {
  const TriMesh cube = test::cube(16);
  EXPECT_THAT(kinds(inspect(cube, request_of(8, 1e-5))), UnorderedElementsAre(Kind::thin_top, Kind::wake));
  InspectRequest one = request_of(8, 1e-5);
  one.volume.envelope.max_thickness = 1.0;  // m, large enough to have no effect
  const InspectReport few = inspect(cube, one);
  // From a first height of 1e-5, with growth 1.4, to a last height of 0.816 edges of about 0.07: 27 layers.
  const std::string advice = the(few, Kind::thin_top).advice;
  ASSERT_EQ(advice.find("layers = 2"), 0u) << advice;
  InspectRequest enough = request_of(std::stoi(advice.substr(9)), 1e-5);
  enough.volume.envelope.max_thickness = 1.0;
  EXPECT_FALSE(inspect(cube, enough).find(Kind::thin_top)) << "the advice helps";
  // Below the usual limit of a tenth of the length, other numbers of layers match; if none does, shorter edges are advised.
  const std::string capped = the(inspect(test::cube(12), request_of(12, 1e-4)), Kind::thin_top).advice;
  ASSERT_EQ(capped.find("layers = "), 0u) << capped;
  EXPECT_FALSE(inspect(test::cube(12), request_of(std::stoi(capped.substr(9)), 1e-4)).find(Kind::thin_top)) << capped;
  InspectRequest low = request_of(8, 1e-5);
  low.volume.envelope.max_thickness = 0.01;
  const std::string never = the(inspect(cube, low), Kind::thin_top).advice;
  EXPECT_EQ(never.find("use shorter edges"), 0u) << never;
  const InspectReport tall = inspect(cube, request_of(5, 0.2));
  EXPECT_TRUE(tall.find(Kind::tall_first));
}

TEST(Inspect, ComparesTheFirstHeightWithTheFlow) {
  InspectRequest request = request_of(20, 1e-4);
  request.flow = flow_state({.length = 1.0, .reynolds = 1e6});
  const InspectReport report = inspect(test::cube(16), request);
  EXPECT_THAT(kinds(report), UnorderedElementsAre(Kind::y_plus, Kind::wake));
  const double expected = first_height({.y_plus = 1.0}, *request.flow).height;
  EXPECT_NEAR(the(report, Kind::y_plus).value, 1e-4 / expected, 1e-9);
  request.limits.wanted_y_plus = 1e-4 / expected;
  EXPECT_THAT(kinds(inspect(test::cube(16), request)), UnorderedElementsAre(Kind::wake));
}

TEST(Inspect, RulesOfPatchesCount) {
  TriMesh plates = joined(moved(test::cube(16), {}, {1.0, 1.0, 0.2}), moved(test::cube(16), {0.0, 0.0, 0.23}, {1.0, 1.0, 0.2}));
  plates.patches.push_back({"upper", PatchKind::wall});
  for (const TriangleId t : plates.triangles.ids())
    if (t.index() >= plates.n_triangles() / 2) plates.triangle_patch[t] = PatchId(1);
  InspectRequest request = request_of(20, 1e-4);
  request.volume.patches.push_back({.names = "*", .options = {{"max_thickness", 5e-3}}});
  EXPECT_FALSE(inspect(plates, request).find(Kind::lowered));
  request.volume.patches = {{.names = "nothing", .options = {{"max_thickness", 5e-3}}}};
  const InspectReport wrong = inspect(plates, request);
  ASSERT_TRUE(wrong.find(Kind::refused));
  EXPECT_NE(the(wrong, Kind::refused).text.find("nothing"), std::string::npos);
}

// ---- All findings ---------------------------------------------------------------------------------------------------------------------------

TEST(Inspect, IsTheSameForAnyNumberOfThreads) {
  const TriMesh plates = joined(test::sphere(20, 0.5), moved(test::sphere(20, 0.5), {1.01, 0.0, 0.0}));
  const InspectReport one = inspect(plates, request_of(25, 1e-5), 1);
  for (const int threads : {2, 7}) {
    const InspectReport other = inspect(plates, request_of(25, 1e-5), threads);
    ASSERT_EQ(one.findings.size(), other.findings.size());
    for (std::size_t i = 0; i < one.findings.size(); ++i) {
      EXPECT_EQ(one.findings[i].text, other.findings[i].text);
      EXPECT_EQ(one.findings[i].advice, other.findings[i].advice);
      ASSERT_EQ(one.findings[i].locations.size(), other.findings[i].locations.size());
      for (std::size_t k = 0; k < one.findings[i].locations.size(); ++k) EXPECT_EQ(one.findings[i].locations[k].what, other.findings[i].locations[k].what);
    }
    EXPECT_EQ(one.layer.coverage, other.layer.coverage);
    ASSERT_EQ(one.fields.size(), other.fields.size());
    for (std::size_t i = 0; i < one.fields.size(); ++i)
      for (std::size_t k = 0; k < one.fields[i].values.size(); ++k) {
        const float a = one.fields[i].values[k], b = other.fields[i].values[k];
        ASSERT_TRUE(a == b || (std::isnan(a) && std::isnan(b))) << one.fields[i].name;
      }
  }
}

TEST(Inspect, LengthScalesDoNotMatter) {
  const TriMesh plates = joined(moved(test::cube(12), {}, {1.0, 1.0, 0.2}), moved(test::cube(12), {0.0, 0.0, 0.225}, {1.0, 1.0, 0.2}));
  const InspectReport one = inspect(plates, request_of(20, 1e-4));
  constexpr double scale = 64.0;  // exact
  const InspectReport large = inspect(moved(plates, {}, {scale, scale, scale}), request_of(20, scale * 1e-4));
  EXPECT_EQ(kinds(one), kinds(large));
  EXPECT_NEAR(one.layer.coverage, large.layer.coverage, 1e-3);
}

TEST(Inspect, UnjoinableTrianglesAreInspectedOneByOne) {
  TriMesh mesh = test::cube(2);
  mesh.points[VertexId(0)] = {std::nan(""), 0.0, 0.0};
  const InspectReport report = inspect_triangles(mesh, {}, RunContext({.threads = 1}));
  EXPECT_TRUE(report.find(Kind::not_looked_at));
  EXPECT_TRUE(report.find(Kind::needle)) << "a triangle without a place has no angle";
}

/// A layer of about 80 mm on a base 1 mm thick, and on a base 40 mm thick; sharp edges and slabs with separate side patches are not bases.
TEST(Inspect, FindsABaseTooThinForItsLayer) {
  InspectRequest request = request_of(20, 1e-4);
  request.volume.envelope.total_height = 0.08;
  const InspectReport report = inspect(test::straight_wing(0.001), request);
  const Finding& base = the(report, Kind::thin_base);
  EXPECT_EQ(base.severity, Severity::warn);
  EXPECT_NEAR(base.value, 80.0, 1.0);
  EXPECT_EQ(base.count % 2, 0) << "both edges of the base";
  ASSERT_FALSE(base.locations.empty());
  for (const FindingLocation& location : base.locations) EXPECT_NEAR(location.position.x, 1.0, 1e-9);
  EXPECT_NE(base.locations.front().what.find("0.001 m thick under a layer of 0.08 m"), std::string::npos) << base.locations.front().what;
  for (const double thickness : {0.0, 0.04}) EXPECT_FALSE(inspect(test::straight_wing(thickness), request).find(Kind::thin_base)) << thickness;
  EXPECT_FALSE(inspect(test::cube(8), request).find(Kind::thin_base));
  request.limits.base_ratio = 100.0;
  EXPECT_FALSE(inspect(test::straight_wing(0.001), request).find(Kind::thin_base));
}

TEST(Inspect, HintsAtAWakeThatNothingRefines) {
  InspectRequest request = request_of(20, 1e-4);
  EXPECT_EQ(the(inspect(test::cube(8), request), Kind::wake).severity, Severity::note);
  request.volume.sources.push_back({.kind = SourceKind::point, .size = 0.1});
  EXPECT_FALSE(inspect(test::cube(8), request).find(Kind::wake));
  request = request_of(20, 1e-4);
  TriMesh engine = test::cube(8);
  engine.patches.push_back({"fan", PatchKind::outflow});
  EXPECT_FALSE(inspect(engine, request).find(Kind::wake));
}

}  // namespace
}  // namespace sterna::volmesh
