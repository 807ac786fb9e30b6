// Model data stored with a surface mesh: where points on its triangles belong, and the largest turn at smooth locations.
#include <gtest/gtest.h>

#include <cmath>
#include <numbers>
#include <optional>
#include <string>
#include <utility>

#include "geom/base/error.h"
#include "geom/math/measures.h"
#include "geom/mesh/topology.h"
#include "geom/model/airfoil.h"
#include "geom/model/components.h"
#include "geom/model/shapes.h"
#include "surfmesh/model/model_wall.h"
#include "tests/support/test_constants.h"
#include "tests/surfmesh/model/edges_of.h"

namespace sterna::surfmesh {
namespace {

using test::edges_of;
using test::k_context;
using test::k_degree;

TEST(ModelWall, PointsMoveToSurfaceOrToRim) {
  const Model model = make_cylinder("can", {0, 0, 0}, {2, 0, 0}, 1.0);
  const SurfaceMesh surface = mesh_model(model, edges_of(0.5, 0.5), {}, k_context);
  const ModelWall wall(model, surface);
  const auto distance_to_can = [](const Point& p) {
    const double radial = std::hypot(p.y, p.z) - 1.0, axial = std::min(std::abs(p.x), std::abs(p.x - 2.0));
    return std::min(std::abs(radial), axial);
  };
  const auto is_on_border = [](const Point& p) { return std::abs(std::hypot(p.y, p.z) - 1.0) < 1e-9 && std::min(std::abs(p.x), std::abs(p.x - 2.0)) < 1e-9; };
  int n_border = 0;
  for (const TriangleId t : surface.mesh.triangles.ids()) {
    const auto p = corners(surface.mesh, t);
    const std::array<double, 3> inner{0.5, 0.3, 0.2};
    const Point in_face = 0.5 * p[0] + 0.3 * p[1] + 0.2 * p[2];
    const Point moved = wall.nearest(in_face, t, inner);
    EXPECT_LT(distance_to_can(moved), 1e-12);
    EXPECT_LT(distance(moved, in_face), 0.1);
    for (std::size_t k = 0; k < 3; ++k) {
      const std::size_t a = (k + 1) % 3, b = (k + 2) % 3;
      std::array<double, 3> weights{};
      weights[a] = 0.25;
      weights[b] = 0.75;
      const Point on_edge = wall.nearest(0.25 * p[a] + 0.75 * p[b], t, weights);
      EXPECT_LT(distance_to_can(on_edge), 1e-12);
      // A triangle's edge on the end circle is an arc of less than 60 degrees; other edges between points of the circle run across the cap.
      if (!is_on_border(p[a]) || !is_on_border(p[b]) || p[a].x != p[b].x || distance(p[a], p[b]) > 0.6) continue;
      EXPECT_TRUE(is_on_border(on_edge)) << format_point(on_edge);
      ++n_border;
    }
  }
  EXPECT_GT(n_border, 40);  // each of the two circles from both sides
}

TEST(SmoothAngle, IsAngleOfSkinNotOfRim) {
  const Model can = make_cylinder("can", {0, 0, 0}, {2, 0, 0}, 1.0);
  // Edges of a regular polygon turn by its angle, which the curvature angle bounds. The end circles turn by 90 degrees.
  for (const double angle : {10.0 * k_degree, 20.0 * k_degree}) {
    const SurfaceMeshReport report = mesh_model(can, edges_of(1.0, angle), {}, k_context).report;
    EXPECT_GT(report.max_smooth_angle, 0.5 * angle);
    EXPECT_LT(report.max_smooth_angle, 1.5 * angle);
    EXPECT_NEAR(std::hypot(report.smooth_angle_location.y, report.smooth_angle_location.z), 1.0, 0.05);
  }
  const SurfaceMeshReport box = mesh_model(make_box("box", {0, 0, 0}, {1, 1, 1}), edges_of(0.3, 0.2), {}, k_context).report;
  EXPECT_LT(box.max_smooth_angle, 1e-7);  // acos of rounded values
}

TEST(SmoothAngle, CountsAcrossEdgesWhereFacesJoinSmoothly) {
  Body body{.name = "Pod"};
  for (const double x : {0.0, 0.7, 2.0}) body.frames.push_back({.name = "x", .center = {x, 0.0, 0.0}, .height = 1.0, .width = 1.0});
  body.nose = body.tail = {CapShape::dome, 1.0};
  const Model pod = make_body(body, ComponentKind::body);
  ASSERT_GT(pod.faces.size(), 2u);
  const SurfaceMesh surface = mesh_model(pod, edges_of(0.2, 15.0 * k_degree), {}, k_context);
  // The surface has no crease, so the largest turn of all edges is the largest smooth turn.
  const Topology topology(surface.mesh, k_context);
  const auto normal = [&](HalfedgeId h) {
    const auto p = corners(surface.mesh, triangle_of(h));
    return cross(p[1] - p[0], p[2] - p[0]);
  };
  double largest = 0.0;
  for (std::size_t i = 0; i < topology.n_halfedges(); ++i)
    largest = std::max(largest, angle_between(normal(HalfedgeId(i)), normal(topology.twin(HalfedgeId(i)))));
  EXPECT_NEAR(surface.report.max_smooth_angle, largest, 1e-9);
  EXPECT_LT(largest, 40.0 * k_degree);
}

/// Returns the warnings about sharp turns from meshing.
std::string turn_warnings(const Model& model, const SurfaceMeshOptions& options = {}) {
  std::string warnings;
  const RunContext context({.threads = 2, .log = [&](LogLevel level, std::string_view line) {
                              if (level == LogLevel::warning && line.find("where the model is smooth") != std::string_view::npos)
                                warnings += std::string(line) + "\n";
                            }});
  (void)mesh_model(model, options, {}, context);
  return warnings;
}

Wing tapered_wing(const char* airfoil, std::optional<double> trailing_edge, double tip_chord) {
  Wing wing{.name = "W", .is_symmetric = true, .trailing_edge = trailing_edge};
  wing.sections.push_back({.name = "tip", .leading_edge = {1.0, 3.0, 0.1}, .chord = tip_chord, .points = naca_airfoil(airfoil).points});
  wing.sections.push_back({.name = "root", .leading_edge = {0.0, 0.0, 0.0}, .chord = 1.0, .points = naca_airfoil(airfoil).points});
  return wing;
}

/// The round tip of a wing ends in a point at a sharp trailing edge, and in an arc of millimetres at a blunt one.
TEST(SmoothAngle, RoundTipsGiveNoWarning) {
  for (const std::optional<double> trailing_edge : {std::optional(0.001), std::optional<double>()})
    for (const char* airfoil : {"0012", "23014"})
      for (const double tip_chord : {0.3, 0.9}) {
        Wing wing = tapered_wing(airfoil, trailing_edge, tip_chord);
        wing.right_tip = wing.left_tip = {CapShape::strip, 1.0};
        EXPECT_EQ(turn_warnings(make_wing(wing)), "") << airfoil << ", trailing edge " << trailing_edge.value_or(-1.0) << ", tip chord " << tip_chord;
      }
}

/// The nose of a thin tapered wing has a radius of 3 mm at the tip, while the mean chord gives a size of at least 12 mm.
TEST(SmoothAngle, NosesOfThinTaperedWingsAreResolved) {
  Wing wing = tapered_wing("0004", std::nullopt, 1.5);
  wing.sections.front().leading_edge = {7.0, 4.9, 0.0};
  wing.sections.back().chord = 9.0;
  wing.right_tip = wing.left_tip = {CapShape::strip, 0.0};
  EXPECT_EQ(turn_warnings(make_wing(wing)), "");
}

/// A rod with edges longer than its radius is a prism of few sides over its whole length, so the sharp turn is not local.
TEST(SmoothAngle, LongPlacesThatTurnSharplyGiveAWarning) {
  SurfaceMeshOptions options = edges_of(0.2, 90.0 * k_degree);
  options.sizes.min_edge = 0.2;
  EXPECT_NE(turn_warnings(make_cylinder("rod", {0, 0, 0}, {9, 0, 0}, 0.1), options), "");
}

}  // namespace
}  // namespace sterna::surfmesh
