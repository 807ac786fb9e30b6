// Every class of docs/method/envelope.md, "Vertex classes", on a body that shows it, with the drawings of docs/classification.md; the default feature angle;
// visibility angles. STERNA_UPDATE_DOCS=1 writes the drawings anew.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <numbers>
#include <sstream>

#include "io/file/surface_file.h"
#include "surfmesh/stitch/stitch_surface.h"
#include "tests/support/class_bodies.h"
#include "tests/support/class_drawing.h"
#include "tests/support/constants.h"
#include "tests/support/data.h"
#include "tests/support/shapes.h"
#include "volmesh/envelope/classify.h"
#include "volmesh/envelope/feature_angle.h"
#include "volmesh/envelope/initial.h"
#include "volmesh/layer/visibility_report.h"

namespace sterna::volmesh {
namespace {

using test::k_context;
using test::k_degree;

EnvelopeOptions with_angle(double degrees) {
  EnvelopeOptions options;
  options.first_height = 1e-5;
  options.layers = 15;
  options.feature_angle = degrees * k_degree;
  return options;
}

struct Classified {
  LayerBase base;
  Classification classes;

  explicit Classified(const TriMesh& mesh, double degrees = 35.0) : base(mesh, k_context), classes(classify_vertices(base, with_angle(degrees), k_context)) {
    EXPECT_EQ(base.topology.n_boundary_halfedges(), 0u);
    double volume = 0.0;
    for (const TriangleId t : mesh.triangles.ids()) {
      const auto [a, b, c] = corners(mesh, t);
      volume += dot(a, cross(b, c)) / 6.0;
    }
    EXPECT_GT(volume, 0.0);
  }
  const VertexClass& at(const Point& p) const {
    for (const VertexId v : base.wall.points.ids())
      if (distance(base.wall.points[v], p) < 1e-9) return classes.vertex[v];
    ADD_FAILURE() << "no vertex at " << p.x << " " << p.y << " " << p.z;
    return classes.vertex[VertexId(0)];
  }
  /// The drawing of docs/, which has to be the one of today's code.
  void expect_drawn(const std::string& name, const Vec3& from) const {
    const std::string svg = test::draw_classes(base, classes, initial_envelope(base, with_angle(35.0), k_context), from);
    const std::filesystem::path path = test::corpus().parent_path().parent_path() / "docs/classes" / (name + ".svg");
    if (const char* update = std::getenv("STERNA_UPDATE_DOCS"); update && std::string_view(update) == "1") {
      std::filesystem::create_directories(path.parent_path());
      std::ofstream(path) << svg;
    }
    std::ifstream file(path);
    std::stringstream text;
    text << file.rdbuf();
    EXPECT_TRUE(text.str() == svg) << path << " is not what the code draws; STERNA_UPDATE_DOCS=1 writes it";
  }
};

TEST(Classes, CubeCornerAndConvexBluntRidge) {
  const TriMesh mesh = test::cube(4);
  const Classified cube(mesh);
  const VertexClass corner = cube.at({1, 1, 1}), ridge = cube.at({1, 1, 0.5}), face = cube.at({1, 0.5, 0.5});
  EXPECT_TRUE(corner.is_corner && corner.is_convex && corner.is_blunt && !corner.is_ridge && !corner.is_concave);
  EXPECT_TRUE(ridge.is_ridge && ridge.is_convex && ridge.is_blunt && !ridge.is_sharp);
  EXPECT_TRUE(face.is_smooth());
  cube.expect_drawn("cube_corner", {2, -3, 1.8});
}

TEST(Classes, SharpTrailingEdgeAndWingTip) {
  const TriMesh mesh = test::straight_wing(0.0);
  const Classified wing(mesh);
  const VertexClass trailing = wing.at({1, 0.5, 0});
  EXPECT_TRUE(trailing.is_ridge && trailing.is_convex && trailing.is_sharp && !trailing.is_blunt && !trailing.is_concave);
  const VertexClass tip = wing.at({1, 1, 0});
  EXPECT_TRUE(tip.is_corner && tip.is_convex && tip.is_sharp && tip.is_blunt);
  wing.expect_drawn("sharp_trailing_edge", {2, 1.4, 1.6});
}

TEST(Classes, BluntTrailingEdge) {
  const TriMesh mesh = test::straight_wing(0.04);
  const Classified wing(mesh);
  for (const double side : {-0.02, 0.02}) {
    const VertexClass trailing = wing.at({1, 0.5, side});
    EXPECT_TRUE(trailing.is_ridge && trailing.is_convex && trailing.is_blunt && !trailing.is_sharp);
    EXPECT_TRUE(wing.at({1, 1, side}).is_corner);
  }
  wing.expect_drawn("blunt_trailing_edge", {2, 1.4, 1.6});
}

TEST(Classes, WingTipRidge) {
  const TriMesh mesh = test::straight_wing(0.0);
  const Classified wing(mesh);
  // The rim of the flat end is a convex ridge along the section; where it bends around the nose it stays one, for the section is resolved there.
  std::size_t n_ridges = 0, n_rim = 0;
  for (const VertexId v : mesh.points.ids()) {
    if (mesh.points[v].y != 1.0 || mesh.points[v].x == 1.0) continue;
    ++n_rim;
    n_ridges += wing.classes.vertex[v].is_ridge && wing.classes.vertex[v].is_convex ? 1 : 0;
  }
  EXPECT_GE(n_ridges + 2, n_rim);  // the two bends beside the nose may exceed 60 degrees
  wing.expect_drawn("wing_tip", {-1.5, 2, 1});
}

TEST(Classes, WingBodyJunctionIsConcave) {
  const TriMesh mesh = test::wing_body();
  const Classified body(mesh);
  const VertexClass junction = body.at({4, 3, 2});
  EXPECT_TRUE(junction.is_ridge && junction.is_concave && !junction.is_convex && junction.is_blunt);
  const VertexClass root = body.at({2, 3, 2});  // two concave edges of the root and the convex edge of the wing
  EXPECT_TRUE(root.is_corner && root.is_concave && root.is_convex);
  body.expect_drawn("wing_body_junction", {2, 3, 2.2});
}

TEST(Classes, SaddleBetweenConvexAndConcaveCrease) {
  const TriMesh mesh = test::creased_disk();
  const Classified disk(mesh);
  const VertexClass saddle = disk.at({0, 0, 0}), convex = disk.at({-0.5, 0, 0}), concave = disk.at({0.5, 0, 0});
  EXPECT_TRUE(saddle.is_ridge && saddle.is_convex && saddle.is_concave);
  EXPECT_TRUE(convex.is_ridge && convex.is_convex && !convex.is_concave);
  EXPECT_TRUE(concave.is_ridge && concave.is_concave && !concave.is_convex);
  disk.expect_drawn("saddle", {1.5, -2.0, 2.5});
}

TEST(Classes, ConeTipIsACornerWhereItsFacesAreFewAndSeenFromItsAxisInAnyCase) {
  const double half = 15.0 * k_degree;
  const TriMesh coarse_mesh = test::cone(half, 7), fine_mesh = test::cone(half, 40);
  const Classified coarse(coarse_mesh), fine(fine_mesh);
  EXPECT_TRUE(coarse.at({0, 0, 1}).is_corner && coarse.at({0, 0, 1}).is_convex);
  EXPECT_TRUE(fine.at({0, 0, 1}).is_smooth());  // no edge bends; what shows the tip is its visibility angle
  const VertexId tip(0);
  EXPECT_LT(angle_between(fine.base.visible_direction[tip], {0, 0, 1}), 1e-6);
  EXPECT_NEAR(std::acos(fine.base.visibility[tip]), 90.0 * k_degree - half, 0.5 * k_degree);
  coarse.expect_drawn("cone_tip", {1, -2.5, 0.8});
}

double found_angle_deg(const TriMesh& mesh) { return feature_angle_of(LayerBase(mesh, k_context), {}, k_context) / k_degree; }

TEST(FeatureAngle, GapOfTheHistogram) {
  EXPECT_NEAR(found_angle_deg(test::cube(4)), 40.5, 1.0);    // nothing between 0 and 90
  EXPECT_NEAR(found_angle_deg(test::sphere(8)), 40.5, 1.0);  // nothing above 10
  const TriMesh blunt = test::straight_wing(0.02);           // the nose bends by 30 degrees at most, the trailing edge by 80 and more
  const double angle = found_angle_deg(blunt);
  EXPECT_GE(angle, 20.0);
  EXPECT_LE(angle, 60.0);
  EnvelopeOptions options;
  options.first_height = 1e-5;
  const LayerBase base(blunt, k_context);
  const Classification classes = classify_vertices(base, options, k_context);
  EXPECT_DOUBLE_EQ(classes.feature_angle, angle * k_degree);
  for (const VertexId v : blunt.points.ids()) {
    if (blunt.points[v].x == 1.0) {
      EXPECT_FALSE(classes.vertex[v].is_smooth());
    }
    if (blunt.points[v].x < 0.9 && blunt.points[v].y > 0.1 && blunt.points[v].y < 0.9) {
      EXPECT_TRUE(classes.vertex[v].is_smooth()) << blunt.points[v].x;
    }
  }
  options.feature_angle = 0.5;
  EXPECT_EQ(feature_angle_of(base, options, k_context), 0.5);  // the user's value wins
}

TEST(FeatureAngle, FollowsTheLargestSmoothTurnWhereItIsKnown) {
  const TriMesh mesh = test::cube(4);
  const LayerBase base(mesh, k_context);
  std::string log;
  const RunContext context({.log = [&](LogLevel, std::string_view line) { log += std::string(line) + "\n"; }});
  const auto decided = [&](double smooth, EnvelopeOptions options = {}) { return decide_feature_angle(base, options, smooth, context) / k_degree; };
  EXPECT_NEAR(decided(5.0 * k_degree), 20.0, 1e-9);   // flatter edges are no features on any coarse surface
  EXPECT_NEAR(decided(33.0 * k_degree), 34.0, 1e-9);  // a degree above
  EXPECT_NE(log.find("turns by up to 33.0 deg where the model is smooth"), std::string::npos) << log;
  EXPECT_NEAR(decided(75.0 * k_degree), 40.5, 1.0);  // no angle up to 60 is above it: the gap counts
  EXPECT_NEAR(decided(k_automatic), 40.5, 1.0);
  EnvelopeOptions options;
  options.feature_angle = 0.5;
  EXPECT_EQ(decided(33.0 * k_degree, options) * k_degree, 0.5);
}

TEST(FeatureAngle, RealSurfacesGiveSensibleAngles) {
  STERNA_NEEDS_SHARED_DATA();
  for (const char* name : {"pygeo_bwb.stl", "caturbs_wing_wing.stl", "wing_body_79k.stl", "pmp_fandisk.off", "flow360_airplane_airplaneGeometry.stl"}) {
    const SurfaceSoup soup = io::read_surface_file(test::shared_data() / "surfaces/clean" / name, k_context);
    const double angle = found_angle_deg(surfmesh::stitch_surface({soup}, {}, k_context).mesh);
    RecordProperty(name, std::to_string(angle));
    std::printf("%s: %.1f deg\n", name, angle);
    EXPECT_GE(angle, 20.0) << name;
    EXPECT_LE(angle, 60.5) << name;
  }
}

TEST(Visibility, ReportOfTheCube) {
  const TriMesh cube = test::cube(4);
  const LayerBase base(cube, k_context);
  const VisibilityReport report = report_visibility(base);
  EXPECT_NEAR(report.max_angle, std::acos(1.0 / std::sqrt(3.0)), 1e-9);  // 54.7 degrees at the corners, 45 along the edges
  const double n = static_cast<double>(cube.n_vertices());
  EXPECT_NEAR(report.share_above[0], (8 + 36) / n, 1e-12);
  EXPECT_NEAR(report.share_above[2], 0.0, 1e-12);
  ASSERT_EQ(report.hardest.size(), 10u);
  EXPECT_NE(report.hardest[0].what.find("55 degrees"), std::string::npos) << report.hardest[0].what;
  for (std::size_t i = 0; i < 8; ++i)
    for (std::size_t axis = 0; axis < 3; ++axis) {
      EXPECT_EQ(std::abs(report.hardest[i].position[axis] - 0.5), 0.5);
    }
}

}  // namespace
}  // namespace sterna::volmesh
