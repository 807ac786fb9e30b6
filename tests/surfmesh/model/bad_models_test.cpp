// Faulty or difficult models: each gives a sound mesh or an error with faces and locations.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <map>
#include <numbers>
#include <set>

#include "geom/base/error.h"
#include "geom/cad/unite.h"
#include "geom/math/intersect.h"
#include "geom/math/measures.h"
#include "geom/model/analytic_surfaces.h"
#include "geom/model/curves.h"
#include "geom/model/model_builder.h"
#include "geom/model/shapes.h"
#include "io/file/cad_file.h"
#include "surfmesh/model/surface_mesh.h"
#include "tests/support/data.h"
#include "tests/support/model_meshes.h"
#include "tests/support/test_constants.h"

namespace sterna::surfmesh {
namespace {

using test::expect_joined;

using testing::AllOf;
using testing::HasSubstr;
using testing::Not;

using test::k_context;

SurfaceMeshOptions edges_and_crossings(double size, const std::string& crossings = "error") {
  SurfaceMeshOptions options;
  options.sizes.max_edge = size;
  options.crossings = crossings;
  return options;
}

Model both(Model a, const Model& b) {
  append(a, b);
  return a;
}

ErrorInfo failure_of(const Model& model, const SurfaceMeshOptions& options) {
  try {
    mesh_model(model, options, {}, k_context);
  } catch (const Error& error) {
    return error.info();
  }
  ADD_FAILURE() << "no error";
  return {};
}

TEST(BadModels, UnmeshableFaceStaysAHole) {
  Model model = make_box("box", {0, 0, 0}, {1, 1, 1});
  Border& border = model.faces[FaceId(2)].borders.front();
  std::swap(border[0].parameter, border[2].parameter);  // the border crosses itself in the parameters
  SurfaceMeshOptions options = edges_and_crossings(0.5);
  EXPECT_THAT(failure_of(model, options).problem, HasSubstr("1 of 6 faces cannot be meshed"));
  EXPECT_THAT(failure_of(model, options).hint, HasSubstr("failed_faces"));
  options.failed_faces = "hole";
  const SurfaceMesh mesh = mesh_model(model, options, {}, k_context);
  EXPECT_GE(mesh.report.n_free_edges, 4);
  EXPECT_THAT(mesh.report.bands.notes, testing::Contains(AllOf(HasSubstr("face 2, \"box\""), HasSubstr("is left as a hole"))));
  double area = 0.0;
  for (const FaceMeshSummary& face : mesh.report.faces) area += face.area;
  EXPECT_NEAR(area, 5.0, 1e-12);
}

TEST(BadModels, OverlappingSolidsRequireUnion) {
  const Model a = make_box("left", {0, 0, 0}, {1, 1, 1}), b = make_box("right", {0.5, 0.3, 0.3}, {2, 0.7, 0.7});
  const Model model = both(a, b);
  const ErrorInfo info = failure_of(model, edges_and_crossings(0.2));
  EXPECT_EQ(info.code, ErrorCode::self_intersection);
  ASSERT_EQ(info.locations.size(), 4u);  // the four long sides of the bar through the side x = 1
  for (const ErrorLocation& location : info.locations) {
    EXPECT_NEAR(location.position.x, 1.0, 1e-12);
    EXPECT_THAT(location.what, AllOf(HasSubstr("\"left\""), HasSubstr("\"right\"")));
  }
  EXPECT_THAT(info.hint, AllOf(HasSubstr("union{"), HasSubstr("crossings = \"warn\""), Not(HasSubstr("repair the faces"))));
  EXPECT_FALSE(info.geometry.triangles.empty());
  // The same model with a warning, and then with the advised change.
  const SurfaceMesh kept = mesh_model(model, edges_and_crossings(0.2, "warn"), {}, k_context);
  EXPECT_GT(kept.report.n_crossings, 0);
  EXPECT_EQ(kept.report.crossings.size(), 4u);
  const std::vector<Model> parts{a, b};
  const SurfaceMesh united = mesh_model(cad::unite(parts, {}, k_context).model, edges_and_crossings(0.2), {}, k_context);
  EXPECT_EQ(united.report.n_crossings, 0);
  EXPECT_EQ(united.report.n_free_edges, 0);
}

TEST(BadModels, TouchingSolidsRequireUnionAtOnce) {
  // Finer triangles cannot separate coincident faces: one round only, also on curved faces.
  const Model boxes = both(make_box("left", {0, 0, 0}, {1, 1, 1}), make_box("right", {1, 0.1, 0.2}, {2, 0.9, 0.7}));
  const Model tubes = both(make_cylinder("outer", {0, 0, 0}, {3, 0, 0}, 0.5), make_cylinder("inner", {1, 0, 0}, {2, 0, 0}, 0.5));
  for (const Model* model : {&boxes, &tubes}) {
    EXPECT_EQ(failure_of(*model, edges_and_crossings(0.2)).code, ErrorCode::self_intersection);
    EXPECT_EQ(mesh_model(*model, edges_and_crossings(0.2, "warn"), {}, k_context).report.n_rounds, 1);
  }
}

TEST(BadModels, NearbySolidsAreSeparatedByFinerTriangles) {
  // A rod in a hole that is 4 mm wider: facets of 0.35 m would cross.
  SurfaceMeshOptions options = edges_and_crossings(0.35);
  options.sizes.curvature_angle = 0.7;
  const Model rod = make_cylinder("rod", {-1, 0, 0}, {1, 0, 0}, 0.5), ring = make_cylinder("pipe", {-0.9, 0, 0}, {0.9, 0, 0}, 0.504);
  // Only the lateral surfaces of both: the rod would cross the ends of the pipe.
  Model model = both(rod, ring);
  Column<FaceId, ModelFace> faces;
  for (const ModelFace& face : model.faces)
    if (face.surface->kind() != "plane") faces.push_back(face);
  model.faces = faces;
  model.solids.clear();
  const SurfaceMesh mesh = mesh_model(model, options, {}, k_context);
  EXPECT_GT(mesh.report.n_rounds, 1);
  EXPECT_EQ(mesh.report.n_crossings, 0);
  expect_joined(model, mesh);
}

TEST(BadModels, OpenPartInsideAnotherCannotBeUnited) {
  Model sheet = make_box("sheet", {-1, -1, 0.5}, {2, 2, 0.6});
  Column<FaceId, ModelFace> faces;
  faces.push_back(sheet.faces[FaceId(std::uint64_t{0})]);
  sheet.faces = faces;
  sheet.solids.clear();
  const ErrorInfo info = failure_of(both(make_box("box", {0, 0, 0}, {1, 1, 1}), sheet), edges_and_crossings(0.2));
  EXPECT_EQ(info.code, ErrorCode::self_intersection);
  EXPECT_THAT(info.hint, AllOf(HasSubstr("open"), Not(HasSubstr("union{"))));
}

TEST(BadModels, AbsurdSizesEndAtOnceWithTheirCount) {
  const ErrorInfo info = failure_of(make_box("crate", {0, 0, 0}, {1, 1, 1}), edges_and_crossings(1e-5));
  EXPECT_EQ(info.code, ErrorCode::overflow);
  // 6 m^2 of triangles of 0.433e-10 m^2.
  EXPECT_THAT(info.problem, AllOf(HasSubstr("1.4e+11"), HasSubstr("max_triangles")));
  EXPECT_THAT(info.locations.front().what, HasSubstr("crate"));
  EXPECT_THAT(info.hint, HasSubstr("units"));
}

TEST(BadModels, FacesThatAreALineAreAbsorbed) {
  // afem_f16 has sixteen such faces: their borders go along a line and back on the other side of a surface without width.
  ModelBuilder builder({.name = "thread"});
  const CornerId a = builder.corner({0, 0, 0}), b = builder.corner({1, 0, 0});
  const EdgeId edge = builder.straight_edge(a, b);
  Model model = make_box("box", {2, 0, 0}, {3, 1, 1});
  Model thread = builder.model();
  const auto surface = std::make_shared<CylinderSurface>(Frame{.origin = {0, 0, 0}, .x = {0, 1, 0}, .y = {0, 0, 1}, .z = {1, 0, 0}}, 1e-12,
                                                         ParameterBox{{0.0, 2.0 * std::numbers::pi}, {0.0, 1.0}});
  ModelFace face{.surface = surface, .name = "thread"};
  const auto line = [&](double u) { return std::make_shared<ParameterLine>(Uv{u, 0.0}, Uv{0.0, 1.0}, Interval{0.0, 1.0}); };
  face.borders.push_back({{edge, false, line(0.0)}, {edge, true, line(std::numbers::pi)}});
  thread.faces.push_back(face);
  append(model, thread);
  const SurfaceMesh mesh = mesh_model(model, edges_and_crossings(0.2), {}, k_context);
  expect_joined(model, mesh);
  ASSERT_EQ(mesh.report.absorbed.size(), 1u);
  EXPECT_THAT(mesh.report.absorbed.front().what, AllOf(HasSubstr("thread"), HasSubstr("line")));
}

/// Returns a closed tube about x whose lateral surface has two circles as borders and no seam; `n` edges in each circle.
Model tube_without_seam(int n) {
  const double pi = std::numbers::pi;
  const auto skin = std::make_shared<CylinderSurface>(Frame{.origin = {0, 0, 0}, .x = {0, 1, 0}, .y = {0, 0, 1}, .z = {1, 0, 0}}, 0.5,
                                                      ParameterBox{{0.0, 2 * pi}, {0.0, 3.0}});
  Model model;
  model.components.push_back({"tube", ComponentKind::body});
  ModelFace side{.surface = skin, .component = ComponentId(std::uint64_t{0}), .name = "side"};
  const auto at = [](int k) { return CornerId(static_cast<std::uint64_t>(k)); };
  for (int end = 0; end < 2; ++end) {
    const double x = 3.0 * end;
    ModelFace cap{
        .surface = std::make_shared<PlaneSurface>(Frame{.origin = {x, 0, 0}, .x = {0, 1, 0}, .y = {0, 0, 1}, .z = {1, 0, 0}}, ParameterBox{{-1, 1}, {-1, 1}}),
        .is_reversed = end == 0,
        .component = ComponentId(std::uint64_t{0}),
        .name = end == 0 ? "front" : "back"};
    const auto circle = std::make_shared<EllipseCurve>(Point{x, 0, 0}, Vec3{0, 0.5, 0}, Vec3{0, 0, 0.5}, Interval{0.0, 2 * pi});
    Border around, inside;
    for (int k = 0; k < n; ++k) {
      const Interval range{2 * pi * k / n, 2 * pi * (k + 1) / n};
      model.corners.push_back({circle->point(range.from), 1e-9});
      const EdgeId edge = model.edges.push_back({circle, range, at(end * n + k), at(end * n + (k + 1) % n), 1e-9, ""});
      // The front circle runs with u, the rear circle against u: the face lies on the left of both.
      around.push_back({edge, end == 1, std::make_shared<ParameterLine>(Uv{0.0, x}, Uv{1.0, 0.0}, range)});
      inside.push_back({edge, false, std::make_shared<ParameterArc>(Uv{0, 0}, Uv{0.5, 0}, Uv{0, 0.5}, range)});
    }
    if (end == 1) std::reverse(around.begin(), around.end());
    side.borders.push_back(around);
    cap.borders.push_back(inside);
    model.faces.push_back(cap);
  }
  model.faces.push_back(side);
  model.solids.push_back({"tube", {FaceId(std::uint64_t{0}), FaceId(std::uint64_t{1}), FaceId(std::uint64_t{2})}, true});
  return model;
}

TEST(BadModels, FacesAroundAPeriodNeedNoSeam) {
  for (const int n : {1, 3}) {
    SCOPED_TRACE(n);
    const Model model = tube_without_seam(n);
    SurfaceMeshOptions options = edges_and_crossings(0.2);
    options.sizes.curvature_angle = 0.3;
    const SurfaceMesh mesh = mesh_model(model, options, {}, k_context);
    expect_joined(model, mesh);
    EXPECT_EQ(mesh.report.n_free_edges, 0);
    EXPECT_EQ(mesh.report.share_20_130, 1.0) << to_text(mesh.report);
    double volume = 0.0;
    for (const TriangleVertices& v : mesh.mesh.triangles) volume += dot(mesh.mesh.points[v[0]], cross(mesh.mesh.points[v[1]], mesh.mesh.points[v[2]])) / 6.0;
    // A prism of 16 sides has 1 - sin(2 pi / 16) / (2 pi / 16) = 2.6 % less than the cylinder.
    EXPECT_NEAR(volume, std::numbers::pi * 0.25 * 3.0, 0.035 * 2.356);
    // The vertices on the seam belong to the face: they are on no edge, and on the surface.
    for (const VertexId v : mesh.mesh.points.ids())
      EXPECT_LT(distance(model.faces[mesh.locations[v].face].surface->point(mesh.locations[v].at), mesh.mesh.points[v]), 1e-12);
  }
}

TEST(BadModels, SphereCapNeedsNeitherSeamNorPole) {
  const auto surface = std::make_shared<SphereSurface>(Frame{}, 1.0);
  Model model;
  model.components.push_back({"cap", ComponentKind::body});
  for (const double v : {0.5, -0.3}) {
    model.corners.push_back({surface->point({0.0, v}), 1e-9});
    const CornerId corner(static_cast<std::uint64_t>(model.corners.size() - 1));
    const double r = std::cos(v);
    const EdgeId edge =
        model.edges.push_back({std::make_shared<EllipseCurve>(Point{0, 0, std::sin(v)}, Vec3{r, 0, 0}, Vec3{0, r, 0}, Interval{0.0, 2 * std::numbers::pi}),
                               {0.0, 2 * std::numbers::pi},
                               corner,
                               corner,
                               1e-9,
                               ""});
    // One face lies to the north of its circle, the other to the south.
    model.faces.push_back({.surface = surface,
                           .borders = {{{edge, v < 0.0, std::make_shared<ParameterLine>(Uv{0.0, v}, Uv{1.0, 0.0}, Interval{0.0, 2 * std::numbers::pi})}}},
                           .component = ComponentId(std::uint64_t{0}),
                           .name = v > 0.0 ? "north" : "south"});
  }
  SurfaceMeshOptions options = edges_and_crossings(0.15);
  options.sizes.curvature_angle = 0.3;
  const SurfaceMesh mesh = mesh_model(model, options, {}, k_context);
  expect_joined(model, mesh);
  EXPECT_GT(mesh.report.share_20_130, 0.99) << to_text(mesh.report);
  for (const FaceMeshSummary& face : mesh.report.faces) {
    // 2 pi (1 - sin v) for a sphere of radius one.
    EXPECT_NEAR(face.area, 2 * std::numbers::pi * (1.0 - (face.name == "north" ? std::sin(0.5) : std::sin(0.3))), 0.05) << face.name;
  }
}

TEST(BadModels, TipsOfHalvesDoNotShareClosingEdge) {
  // A pointed cone of two halves: the last triangles of both would have the same three corners (found on the core of simpletest-pylon-nacelle).
  const double pi = std::numbers::pi, slope = 0.4;  // used to fail at any size
  const auto surface = std::make_shared<ConeSurface>(Frame{}, slope, std::atan(slope), ParameterBox{{0.0, 2 * pi}, {-1.0 / std::cos(std::atan(slope)), 0.0}});
  ASSERT_LT(distance(surface->point({0.0, surface->domain().v.from}), {0, 0, -1}), 1e-12);
  ModelBuilder builder({.name = "cone", .kind = ComponentKind::body});
  const CornerId tip = builder.corner({0, 0, -1}), right = builder.corner({slope, 0, 0}), left = builder.corner({-slope, 0, 0});
  const EdgeId to_right = builder.straight_edge(tip, right), to_left = builder.straight_edge(tip, left);
  const auto circle = std::make_shared<EllipseCurve>(Point{}, Vec3{slope, 0, 0}, Vec3{0, slope, 0}, Interval{0.0, 2 * pi});
  const EdgeId front = builder.edge(circle, {0.0, pi}, right, left), back = builder.edge(circle, {pi, 2 * pi}, left, right);
  const Interval v = surface->domain().v;
  builder.patch(surface, {{0.0, pi}, v}, {builder.pole(tip), to_left, front, to_right}, FaceRole::skin, "front");
  builder.patch(surface, {{pi, 2 * pi}, v}, {builder.pole(tip), to_right, back, to_left}, FaceRole::skin, "back");
  builder.plane({front, back}, FaceRole::skin, "base");
  const Model model = builder.closed_solid("cone");
  const SurfaceMesh mesh = mesh_model(model, edges_and_crossings(0.1), {}, k_context);
  expect_joined(model, mesh);
  EXPECT_EQ(mesh.report.n_free_edges, 0);
  EXPECT_EQ(mesh.report.n_rounds, 1);
}

TEST(BadModels, EdgesOffTheirFacesAreNamed) {
  // A side of the box is moved from its edges by more than any tolerance.
  Model model = make_box("box", {0, 0, 0}, {1, 1, 1});
  EXPECT_TRUE(mesh_model(model, edges_and_crossings(0.25), {}, k_context).report.loose_edges.empty());
  const Model moved = make_box("box", {-1e-4, 0, 0}, {1.0001, 1, 1});
  for (const FaceId f : model.faces.ids())
    if (std::abs(model.faces[f].surface->derivatives({}).du.x) + std::abs(model.faces[f].surface->derivatives({}).dv.x) < 1e-12)
      model.faces[f].surface = moved.faces[f].surface;
  const SurfaceMesh mesh = mesh_model(model, edges_and_crossings(0.25), {}, k_context);
  ASSERT_EQ(mesh.report.loose_edges.size(), 8u);
  for (const LooseEdge& loose : mesh.report.loose_edges) {
    EXPECT_NEAR(loose.distance, 1e-4, 1e-6);
    EXPECT_LT(loose.tolerance, 1e-5);
  }
  EXPECT_THAT(to_text(mesh.report), HasSubstr("8 edges exceed their tolerance"));
}

TEST(BadModels, NormalsAreMeasuredAgainstTheCurvatureAngle) {
  const Model model = make_cylinder("c", {0, 0, 0}, {3, 0, 0}, 1.0);
  SurfaceMeshOptions options = edges_and_crossings(0.5);
  options.sizes.curvature_angle = 0.3;
  const SurfaceMesh fine = mesh_model(model, options, {}, k_context);
  EXPECT_EQ(fine.report.share_normals, 1.0);
  EXPECT_FALSE(fine.report.worst_normal_face.is_valid());
  // No edge may be shorter than 0.5 m, which spans 0.5 rad.
  options.sizes.curvature_angle = 0.05;
  options.sizes.min_edge = 0.5;
  const SurfaceMesh coarse = mesh_model(model, options, {}, k_context);
  EXPECT_LT(coarse.report.share_normals, 0.5);
  ASSERT_TRUE(coarse.report.worst_normal_face.is_valid());
  EXPECT_THAT(to_text(coarse.report), HasSubstr("normals within the curvature angle on"));
}

TEST(BadModels, HolesAtBordersAndLinesAsFaces) {
  STERNA_NEEDS_SHARED_DATA();
  // Two holes touch the end circle of a tube in one point each; sixteen faces of the F-16 degenerate to lines.
  for (const auto& [file, n_absorbed] : {std::pair{"gmsh_parts_PeriodicFaceWithLargeTolerance.brep", 0u}, std::pair{"afem_f16_F-16.stp", 16u}}) {
    SCOPED_TRACE(file);
    const Model model = io::read_cad(test::shared_data() / "cad" / file, {}, k_context).model;
    SurfaceMeshOptions options = edges_and_crossings(n_absorbed > 0 ? 0.3 : 1.0, "ignore");
    options.sizes.curvature_angle = 0.4;
    const SurfaceMesh mesh = mesh_model(model, options, {}, k_context);
    expect_joined(model, mesh);
    EXPECT_EQ(mesh.report.absorbed.size(), n_absorbed);
  }
}

/// Checks that every free edge of the model is a chain of mesh boundary edges through its vertices in order, and that no other boundary edges exist.
void expect_loops_of_free_edges(const Model& model, const SurfaceMesh& surface) {
  const TriMesh& mesh = surface.mesh;
  std::set<std::pair<VertexId, VertexId>> boundary;
  for (const TriangleVertices& v : mesh.triangles)
    for (std::size_t k = 0; k < 3; ++k)
      if (const auto at = boundary.find({v[(k + 1) % 3], v[k]}); at != boundary.end()) boundary.erase(at);
      else boundary.insert({v[k], v[(k + 1) % 3]});
  std::map<EdgeId, std::map<double, VertexId>> along;
  std::map<std::array<double, 3>, std::vector<VertexId>> corners;
  for (const VertexId v : mesh.points.ids()) {
    const EdgeLocation& location = surface.edge_locations[v];
    const Point& p = mesh.points[v];
    if (location.edge.is_valid()) along[location.edge][location.t] = v;
    else corners[{p.x, p.y, p.z}].push_back(v);
  }
  std::size_t n = 0;
  for (const EdgeId e : free_edges(model)) {
    const auto at = [&](CornerId c) {
      const Point& p = model.corners[c].point;
      return corners[{p.x, p.y, p.z}];
    };
    std::vector<std::vector<VertexId>> chain{at(model.edges[e].start)};
    for (const auto& [t, v] : along[e]) chain.push_back({v});
    chain.push_back(at(model.edges[e].end));
    for (std::size_t i = 0; i + 1 < chain.size(); ++i, ++n) {
      bool is_found = false;
      for (const VertexId a : chain[i])
        for (const VertexId b : chain[i + 1]) is_found = is_found || boundary.contains({a, b}) || boundary.contains({b, a});
      EXPECT_TRUE(is_found) << "edge " << e.value() << " segment " << i;
    }
  }
  EXPECT_EQ(n, boundary.size());
  EXPECT_EQ(static_cast<std::int64_t>(n), surface.report.n_free_edges);
}

TEST(BadModels, LoopsOfOpenModelsAreTheFreeEdges) {
  STERNA_NEEDS_SHARED_DATA();
  struct Case {
    const char* file;
    double max_edge;
  };
  for (const Case& c : {Case{"gmsh_parts_sewfaces.step", 0.002}, Case{"pythonocc_example_45_faces.iges", 0.004}, Case{"ucrm_igs_final_surface.igs", 0.1},
                        Case{"tigl_nacelle_nacelle.stp", 0.2}, Case{"gmsh_parts_PeriodicFaceWithLargeTolerance.brep", 1.0}}) {
    SCOPED_TRACE(c.file);
    const Model model = io::read_cad(test::shared_data() / "cad" / c.file, {}, k_context).model;
    SurfaceMeshOptions options = edges_and_crossings(c.max_edge, "ignore");
    options.sizes.curvature_angle = 0.5;
    const SurfaceMesh mesh = mesh_model(model, options, {}, k_context);
    ASSERT_TRUE(mesh.report.absorbed.empty());
    expect_joined(model, mesh);
    expect_loops_of_free_edges(model, mesh);
  }
}

TEST(BadModels, FoldedSurfaceIsNamedWithLocation) {
  STERNA_NEEDS_SHARED_DATA();
  // The lip of the nacelle: du and dv are parallel at y = -0.511, and the normal reverses.
  SurfaceMeshOptions options = edges_and_crossings(0.1);
  options.sizes.curvature_angle = 0.4;
  const ErrorInfo info = failure_of(io::read_cad(test::shared_data() / "cad" / "tigl_nacelle_nacelle.stp", {}, k_context).model, options);
  EXPECT_EQ(info.code, ErrorCode::self_intersection);
  EXPECT_NEAR(std::abs(info.locations.front().position.y), 0.511, 0.005);
  EXPECT_THAT(info.locations.front().what, HasSubstr("folds"));
  EXPECT_THAT(info.hint, AllOf(HasSubstr("repair the faces"), Not(HasSubstr("union{"))));
}

}  // namespace
}  // namespace sterna::surfmesh
