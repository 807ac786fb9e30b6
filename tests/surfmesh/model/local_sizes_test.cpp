// Local size limits: user sources, gaps, thin parts, wing factors, strips at tips, intersections.
#include <gtest/gtest.h>

#include <cmath>
#include <functional>
#include <limits>
#include <numbers>

#include "geom/base/error.h"
#include "geom/model/components.h"
#include "geom/model/model_builder.h"
#include "geom/model/shapes.h"
#include "surfmesh/model/surface_mesh.h"
#include "tests/support/error_of.h"
#include "tests/support/test_constants.h"

namespace sterna::surfmesh {
namespace {

using std::numbers::pi;
using test::k_context;

SurfaceMeshOptions plain_edges(double size) {
  SurfaceMeshOptions options;
  options.sizes.max_edge = size;
  options.sizes.min_edge = 1e-3 * size;
  options.sizes.curvature_angle = 0.5;
  options.sizes.narrow = 100.0;
  options.leading_edge_factor = options.trailing_edge_factor = options.intersection_factor = 1.0;
  options.tip_strips = false;
  return options;
}

/// Returns the mean edge length of triangles whose centroid is within the given region.
double mean_edge(const SurfaceMesh& mesh, const std::function<bool(const Point&)>& is_within) {
  double sum = 0.0, n = 0.0;
  for (const TriangleId t : mesh.mesh.triangles.ids()) {
    const TriangleVertices& v = mesh.mesh.triangles[t];
    const Point &a = mesh.mesh.points[v[0]], &b = mesh.mesh.points[v[1]], &c = mesh.mesh.points[v[2]];
    if (!is_within((a + b + c) / 3.0)) continue;
    sum += distance(a, b) + distance(b, c) + distance(c, a);
    n += 3.0;
  }
  return n > 0.0 ? sum / n : std::numeric_limits<double>::infinity();
}

SurfaceMesh meshed(const Model& model, const SurfaceMeshOptions& options, const SpaceSizes& requested = {}, const RunContext& context = k_context) {
  return mesh_model(model, options, {}, requested, context);
}

/// Returns a plate with 10 m sides.
Model slab(double low, double high) { return make_box("slab", {0, 0, low}, {10, 10, high}); }

TEST(LocalSizes, SourcesOfTheUserAreMetAndGrow) {
  SpaceSizes requested;
  requested.regions = [](const Point& p, double slope) { return 0.05 + slope * std::max(0.0, distance(p, {5, 5, 1}) - 0.5); };
  SurfaceMeshOptions options = plain_edges(1.0);
  const Model model = slab(0, 1);
  const SurfaceMesh mesh = meshed(model, options, requested);
  const auto at = [](double from, double to) {
    return [=](const Point& p) { return p.z > 0.99 && distance(p, {5, 5, 1}) > from && distance(p, {5, 5, 1}) < to; };
  };
  EXPECT_NEAR(mean_edge(mesh, at(0.0, 0.4)), 0.05, 0.01);
  EXPECT_NEAR(mean_edge(mesh, at(1.9, 2.1)), 0.05 + 0.2 * 1.5, 0.07);
  EXPECT_GT(mean_edge(mesh, [](const Point& p) { return p.z < 0.01 && distance(p, {0, 0, 0}) < 2.0; }), 0.75);
  // The next finer mesh has half the lengths at this location, too.
  options.sizes.refinement = 2.0;
  EXPECT_NEAR(mean_edge(meshed(model, options, requested), at(0.0, 0.4)), 0.025, 0.005);
}

TEST(LocalSizes, FunctionsMayJumpAndSamplesCount) {
  SpaceSizes requested;
  requested.function = [](const Point& p) { return p.x < 3.0 ? 0.1 : 5.0; };
  requested.samples = {{{9.0, 9.0, 1.0}, 0.02}};
  const Model model = slab(0, 1);
  const SurfaceMesh mesh = meshed(model, plain_edges(1.0), requested);
  EXPECT_NEAR(mean_edge(mesh, [](const Point& p) { return p.z > 0.99 && p.x < 2.5; }), 0.1, 0.02);
  EXPECT_NEAR(mean_edge(mesh, [](const Point& p) { return p.z > 0.99 && distance(p, {5.0, 5.0, 1.0}) < 0.5; }), 0.5, 0.1);
  EXPECT_LT(mean_edge(mesh, [](const Point& p) { return distance(p, {9.0, 9.0, 1.0}) < 0.05; }), 0.035);
  requested.function = [](const Point&) { return -1.0; };
  test::expect_error(ErrorCode::bad_argument, "the size function returns -1.000000 m", [&] { (void)meshed(model, plain_edges(1.0), requested); });
}

TEST(LocalSizes, GapsHaveTheirCells) {
  Model model = slab(0, 1);
  append(model, slab(1.3, 2.3));
  SurfaceMeshOptions options = plain_edges(1.0);
  const auto in_gap = [](const Point& p) { return p.z > 0.99 && p.z < 1.31 && p.x > 1 && p.x < 9 && p.y > 1 && p.y < 9; };
  EXPECT_GT(mean_edge(meshed(model, options), in_gap), 0.7);
  options.sizes.gap_cells = 2.0;
  const SurfaceMesh mesh = meshed(model, options);
  EXPECT_NEAR(mean_edge(mesh, in_gap), 0.15, 0.03);
  // Near the outer edges sizes grow again, and inside the plates no gap is detected.
  EXPECT_GT(mean_edge(mesh, [](const Point& p) { return (p.z < 0.01 || p.z > 2.29) && p.x > 3 && p.x < 7 && p.y > 3 && p.y < 7; }), 0.7);
}

TEST(LocalSizes, ThinPartsHaveShortEdges) {
  const Model model = slab(0, 0.2);
  SurfaceMeshOptions options = plain_edges(1.0);
  const auto inner = [](const Point& p) { return p.x > 1 && p.x < 9 && p.y > 1 && p.y < 9; };
  EXPECT_GT(mean_edge(meshed(model, options), inner), 0.6);
  options.sizes.thickness_factor = 1.5;
  EXPECT_NEAR(mean_edge(meshed(model, options), inner), 0.3, 0.06);
  options.sizes.min_edge = 0.5;  // a lower limit for the sizes from thin parts
  EXPECT_GT(mean_edge(meshed(model, options), inner), 0.4);
}

Model lens_section_wing(bool is_blunt) {
  Wing wing{.name = "W", .is_symmetric = false, .is_cubic = false, .trailing_edge = is_blunt ? std::optional(0.02) : std::nullopt};
  for (const double y : {10.0, 0.0}) {
    WingSection s{.name = "y", .leading_edge = {0.0, y, 0.0}, .chord = 2.0};
    for (int i = 0; i <= 100; ++i) {
      // Two arcs that meet at 20 degrees at both ends.
      const double along = std::cos(2 * pi * i / 100), side = i <= 50 ? 1.0 : -1.0;
      s.points.push_back({0.5 + 0.5 * along, side * 0.05 * (1.0 - along * along)});
    }
    wing.sections.push_back(s);
  }
  return make_wing(wing);
}

TEST(LocalSizes, WingsAreFinerAtTheirEdgesAndTips) {
  for (const bool is_blunt : {true, false}) {
    SCOPED_TRACE(is_blunt);
    const Model model = lens_section_wing(is_blunt);
    SurfaceMeshOptions options = plain_edges(0.2);
    options.sizes.min_edge = 0.15;
    const auto strip = [](double from, double to) {
      return [=](const Point& p) { return p.x > from && p.x < to && p.y > 3 && p.y < 7 && std::abs(p.z) > 0.02; };
    };
    const double plain = mean_edge(meshed(model, options), strip(1.8, 1.9));
    EXPECT_GT(plain, 0.14);
    options.trailing_edge_factor = 0.4;
    const SurfaceMesh trailing = meshed(model, options);
    EXPECT_LT(mean_edge(trailing, strip(1.8, 1.9)), 0.7 * plain);
    EXPECT_GT(mean_edge(trailing, strip(0.9, 1.1)), 0.8 * plain);
    options.trailing_edge_factor = 1.0;
    // The nose has a radius of millimetres and therefore short edges in any case; the effect of the option is visible behind the nose.
    const double behind_nose = mean_edge(meshed(model, options), strip(0.3, 0.4));
    options.leading_edge_factor = 0.2;
    const SurfaceMesh leading = meshed(model, options);
    EXPECT_LT(mean_edge(leading, strip(0.3, 0.4)), 0.75 * behind_nose);
    EXPECT_GT(mean_edge(leading, strip(1.8, 1.9)), 0.8 * plain);
    // Rules for patches override the general options.
    const std::vector<Rule> rules = {{.names = "W*", .options = {{"leading_edge_factor", 1.0}}}};
    EXPECT_NEAR(mean_edge(mesh_model(model, options, rules, k_context), strip(0.3, 0.4)), behind_nose, 0.02 * behind_nose);
    options.leading_edge_factor = 1.0;
    options.tip_strips = true;
    const SurfaceMesh tips = meshed(model, options);
    const auto along = [](double from, double to) { return [=](const Point& p) { return p.y > from && p.y < to && p.x > 0.5 && p.x < 1.5; }; };
    EXPECT_LT(mean_edge(tips, along(9.75, 9.99)), 0.6 * 0.2);
    EXPECT_GT(mean_edge(tips, along(4.0, 6.0)), 0.8 * plain);
  }
}

TEST(LocalSizes, ComponentsMeetInShorterEdges) {
  // A box of two components: its faces at x = 0 belong to the second component.
  Model model = make_box("body", {0, 0, 0}, {4, 4, 4});
  const ComponentId other = model.components.push_back({.name = "other", .kind = ComponentKind::unknown});
  for (const FaceId f : model.faces.ids())
    if (model.faces[f].surface->point({0.0, 0.0}).x < 1e-9 &&
        distance(model.faces[f].surface->point({0.1, 0.1}), model.faces[f].surface->point({0.0, 0.0})) > 0.0 &&
        std::abs(model.faces[f].surface->point({0.1, 0.1}).x) < 1e-9)
      model.faces[f].component = other;
  SurfaceMeshOptions options = plain_edges(0.5);
  const auto border = [](const Point& p) { return p.x > 0.0 && p.x < 0.3 && p.y > 1.0 && p.y < 3.0; };
  const double plain = mean_edge(meshed(model, options), border);
  options.intersection_factor = 0.4;
  EXPECT_LT(mean_edge(meshed(model, options), border), 0.65 * plain);
}

TEST(LocalSizes, SameForAnyThreads) {
  Model model = lens_section_wing(true);
  append(model, make_box("slab", {0, 3, 0.3}, {2, 7, 0.5}));
  SurfaceMeshOptions options;
  options.sizes.max_edge = 0.2;
  options.sizes.gap_cells = 2.0;
  options.sizes.thickness_factor = 2.0;
  SpaceSizes requested;
  requested.regions = [](const Point& p, double slope) { return 0.02 + slope * distance(p, {1, 5, 0.1}); };
  std::vector<Point> first;
  for (const int threads : {1, 2, 7}) {
    const SurfaceMesh mesh = meshed(model, options, requested, RunContext({.threads = threads}));
    if (first.empty()) first = mesh.mesh.points.raw();
    EXPECT_EQ(first, mesh.mesh.points.raw());
  }
}

}  // namespace
}  // namespace sterna::surfmesh
