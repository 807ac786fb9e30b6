#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <cstring>
#include <numbers>
#include <optional>

#include "geom/base/error.h"
#include "geom/math/intersect.h"
#include "geom/math/measures.h"
#include "geom/model/airfoil.h"
#include "geom/model/components.h"
#include "geom/model/shapes.h"
#include "geom/model/smx.h"
#include "io/file/cad_file.h"
#include "surfmesh/model/model_sizes.h"
#include "surfmesh/model/model_wall.h"
#include "surfmesh/model/surface_mesh.h"
#include "tests/support/data.h"
#include "tests/support/model_meshes.h"
#include "tests/support/test_constants.h"
#include "tests/support/test_shapes.h"
#include "tests/surfmesh/model/edges_of.h"

namespace sterna::surfmesh {
namespace {

using test::expect_sound;
using test::make_ball;

using std::numbers::pi;
using test::edges_of;
using test::k_context;
using test::k_degree;

double area_of(const TriMesh& mesh) {
  double area = 0.0;
  for (const TriangleVertices& v : mesh.triangles) area += triangle_area(mesh.points[v[0]], mesh.points[v[1]], mesh.points[v[2]]);
  return area;
}
using test::volume_of;

Model tube(double radius, double length, const EndCap& cap) {
  Body body{.name = "Tube"};
  for (const double x : {0.0, 0.3, 0.7, 1.0}) body.frames.push_back({.name = "x", .center = {x * length, 0.0, 0.0}, .height = 2 * radius, .width = 2 * radius});
  body.nose = body.tail = cap;
  return make_body(body, ComponentKind::body);
}

Model lens_wing(bool is_cubic, std::optional<double> trailing_edge = std::nullopt) {
  Wing wing{.name = "W", .is_symmetric = true, .is_cubic = is_cubic, .trailing_edge = trailing_edge};
  for (const double y : {4.0, 3.0, 1.5, 0.0}) {
    WingSection s{.name = "y", .leading_edge = {0.05 * y * y, y, 0.0}, .chord = 2.0 - 0.05 * y * y};
    for (int i = 0; i <= 200; ++i) s.points.push_back({0.5 + 0.5 * std::cos(2 * pi * i / 200), 0.1 * std::sin(2 * pi * i / 200)});
    wing.sections.push_back(s);
  }
  wing.right_tip = wing.left_tip = {CapShape::strip, 1.0};
  return make_wing(wing);
}

TEST(MeshModel, ABoxIsExact) {
  const Model model = make_box("box", {0, 0, 0}, {1, 2, 3});
  const SurfaceMesh mesh = mesh_model(model, edges_of(0.25), {}, k_context);
  expect_sound(model, mesh);
  EXPECT_NEAR(area_of(mesh.mesh), 22.0, 1e-12);
  EXPECT_NEAR(volume_of(mesh.mesh), 6.0, 1e-12);
  EXPECT_EQ(mesh.report.share_20_130, 1.0);
  EXPECT_GT(mesh.mesh.n_triangles(), 22.0 / (0.433 * 0.25 * 0.25) * 0.75);
}

TEST(MeshModel, AreaAndVolumeConvergeWithOrderTwo) {
  struct Case {
    const char* name;
    Model model;
    double size, area, volume;  ///< area 0: unknown
  };
  for (const Case& c :
       {Case{"sphere", make_ball(1.0), 0.25, 4 * pi, 4 * pi / 3}, Case{"cylinder", make_cylinder("c", {0, 0, 0}, {3, 0, 0}, 1.0), 0.25, 8 * pi, 3 * pi},
        Case{"bicubic wing", lens_wing(true), 0.4, 0.0, 0.0}}) {
    SCOPED_TRACE(c.name);
    std::vector<double> areas, volumes;
    for (const double factor : {1.0, 2.0, 4.0}) {
      SurfaceMeshOptions options = edges_of(c.size);
      options.sizes.refinement = factor;
      if (factor >= 4.0) options.crossings = "ignore";
      const SurfaceMesh mesh = mesh_model(c.model, options, {}, k_context);
      if (factor < 4.0) expect_sound(c.model, mesh);
      areas.push_back(area_of(mesh.mesh));
      volumes.push_back(volume_of(mesh.mesh));
    }
    // In theory, refinement reduces errors to a quarter; without a known result, differences are compared. The meshes are not similar.
    const double end_area = c.area > 0.0 ? c.area : areas[2], end_volume = c.area > 0.0 ? c.volume : volumes[2];
    const double limit = c.area > 0.0 ? 0.33 : 0.27;  // (1/4 - 1/16) / (1 - 1/16) = 1/5
    EXPECT_LT(end_area - areas[1], limit * (end_area - areas[0])) << areas[0] << " " << areas[1] << " " << areas[2];
    EXPECT_LT(end_volume - volumes[1], limit * (end_volume - volumes[0])) << volumes[0] << " " << volumes[1] << " " << volumes[2];
  }
}

TEST(MeshModel, ComponentsHaveDefaults) {
  for (const Model& model : {tube(0.8, 5.0, {CapShape::dome, 1.0}), tube(0.8, 5.0, {CapShape::dome, 0.0}), lens_wing(false), lens_wing(true)}) {
    const SurfaceMesh mesh = mesh_model(model, {}, {}, k_context);
    expect_sound(model, mesh);
    EXPECT_GT(mesh.report.share_20_130, 0.995) << to_text(mesh.report);
    EXPECT_GT(mesh.mesh.n_triangles(), 400u);
    EXPECT_LT(mesh.mesh.n_triangles(), 200000u);
  }
}

TEST(MeshModel, NearlySharpTrailingEdgesBecomeLines) {
  const auto mesh_of = [](double thickness) {
    const Model model = lens_wing(false, thickness);
    const SurfaceMesh mesh = mesh_model(model, edges_of(0.1), {}, k_context);
    expect_sound(model, mesh);
    std::int64_t n = 0;
    for (const FaceMeshSummary& face : mesh.report.faces)
      if (model.faces[face.face].role == FaceRole::trailing_edge) n += face.n_triangles;
    return std::pair(n, mesh.report);
  };
  // min_edge is 2 mm; a twentieth of min_edge is treated as zero.
  const auto [n_blunt, blunt] = mesh_of(0.004);
  EXPECT_GT(n_blunt, 1000);
  EXPECT_TRUE(blunt.absorbed.empty());
  const auto [n_sharp, sharp] = mesh_of(5e-5);
  EXPECT_EQ(n_sharp, 0);
  EXPECT_FALSE(sharp.absorbed.empty());
  EXPECT_LE(sharp.max_edge_distance, 1e-4);
  EXPECT_GT(sharp.share_20_130, 0.995) << to_text(sharp);
}

TEST(MeshModel, PatchesHaveSizesOfTheirOwnThatGrow) {
  const Model model = make_test_section({.length = 4.0, .width = 2.0, .height = 2.0});
  SurfaceMeshOptions options = edges_of(0.4);
  const SurfaceMesh coarse = mesh_model(model, options, {}, k_context);
  const std::vector<Rule> rules = {{.names = "in*", .options = {{"max_edge", 0.05}}}};
  const SurfaceMesh fine = mesh_model(model, options, rules, k_context);
  expect_sound(model, fine);
  EXPECT_GT(fine.mesh.n_triangles(), 4 * coarse.mesh.n_triangles());
  EXPECT_EQ(fine.report.share_20_130, 1.0);
  for (const FaceMeshSummary& face : fine.report.faces)
    if (face.name == "inflow") {
      EXPECT_GT(face.n_triangles, 3000);
    } else if (face.name == "outflow") {
      EXPECT_LT(face.n_triangles, 150);
    }
  const std::vector<Rule> wrong = {{.names = "wing*", .options = {{"max_edge", 0.05}}}};
  try {
    mesh_model(model, options, wrong, k_context);
    FAIL() << "no error";
  } catch (const Error& error) {
    EXPECT_EQ(error.code(), ErrorCode::bad_argument);
    EXPECT_THAT(error.what(), testing::AllOf(testing::HasSubstr("wing*"), testing::HasSubstr("inflow")));
  }
}

TEST(MeshModel, SameBytesForAnyThreads) {
  const Model model = lens_wing(true);
  SurfaceMesh first;
  for (const int threads : {1, 2, 7}) {
    const SurfaceMesh mesh = mesh_model(model, edges_of(0.2), {}, RunContext({.threads = threads}));
    if (threads == 1) {
      first = mesh;
      continue;
    }
    EXPECT_EQ(mesh.mesh.triangles.raw(), first.mesh.triangles.raw());
    ASSERT_EQ(mesh.mesh.n_vertices(), first.mesh.n_vertices());
    EXPECT_EQ(std::memcmp(mesh.mesh.points.raw().data(), first.mesh.points.raw().data(), first.mesh.n_vertices() * sizeof(Point)), 0);
  }
}

TEST(MeshModel, FaceWithTooManyTrianglesIsNamed) {
  SurfaceMeshOptions options = edges_of(0.01);
  options.sizes.max_triangles = 1000;
  try {
    mesh_model(make_box("crate", {0, 0, 0}, {1, 1, 1}), options, {}, k_context);
    FAIL() << "no error";
  } catch (const Error& error) {
    EXPECT_EQ(error.code(), ErrorCode::overflow);
    EXPECT_THAT(error.what(), testing::AllOf(testing::HasSubstr("crate"), testing::HasSubstr("max_triangles")));
  }
}

TEST(MeshModel, VeryNarrowRimNeedsNoMillionsOfTriangles) {
  for (const double width : {1e-6, 1e-9}) {
    const Model model = make_box("blade", {0, 0, 0}, {1, 0.01, width});
    try {
      const SurfaceMesh mesh = mesh_model(model, {}, {}, k_context);
      EXPECT_LT(mesh.mesh.n_triangles(), 200'000u) << width;
    } catch (const Error& error) {
      EXPECT_THAT(error.info().problem, testing::HasSubstr("removed")) << width;
    }
  }
}

TEST(MeshModel, CadFilesCloseAndKeepTheirVolume) {
  STERNA_NEEDS_SHARED_DATA();
  struct Case {
    const char* file;
    double max_edge;
  };
  for (const Case& c : {Case{"gmsh_parts_mambo_s34.step", 0.004}, Case{"netgen_parts_screw.step", 0.002}, Case{"tigl_simplewing_simplewing.brep", 0.1}}) {
    SCOPED_TRACE(c.file);
    const Model model = io::read_cad(test::shared_data() / "cad" / c.file, {}, k_context).model;
    const SurfaceMesh mesh = mesh_model(model, edges_of(c.max_edge, 12 * k_degree), {}, k_context);
    expect_sound(model, mesh);
    EXPECT_GT(volume_of(mesh.mesh), 0.0);
    EXPECT_GT(mesh.report.share_20_130, 0.98) << to_text(mesh.report);
  }
}

/// Returns the largest distance of triangle centroids from the model.
double chord_error_of(const Model& model, const SurfaceMesh& mesh) {
  const ModelWall wall(model, mesh);
  double most = 0.0;
  for (const TriangleId t : mesh.mesh.triangles.ids()) {
    const auto [a, b, c] = corners(mesh.mesh, t);
    const Point middle = (a + b + c) / 3.0;
    most = std::max(most, distance(middle, wall.nearest(middle, t, {1.0 / 3.0, 1.0 / 3.0, 1.0 / 3.0})));
  }
  return most;
}

TEST(MeshModel, ChordErrorHoldsOnPolesAndSharpEnds) {
  Wing wing{.name = "W", .is_symmetric = true};
  for (const double y : {4.0, 0.0}) {
    WingSection s{.name = "y", .leading_edge = {0.3 * y, y, 0.0}, .chord = 2.0 - 0.3 * y};
    for (int i = 0; i <= 80; ++i) {
      const double x = 0.5 + 0.5 * std::cos(2 * pi * i / 80);
      s.points.push_back(
          {x, (i <= 40 ? 1.0 : -1.0) * 0.6 * (0.2969 * std::sqrt(x) - 0.126 * x - 0.3516 * x * x + 0.2843 * x * x * x - 0.1036 * x * x * x * x)});
    }
    wing.sections.push_back(s);
  }
  for (const auto& [name, model] : {std::pair{"pointed body", tube(0.4, 5.0, {CapShape::dome, 1.5})},
                                    std::pair{"blunt body", tube(0.4, 5.0, {CapShape::strip, 0.3})}, std::pair{"wing", make_wing(wing)}})
    for (const double error : {0.01, 0.001}) {
      SurfaceMeshOptions options;
      options.sizes.chord_error = error;
      const SurfaceMesh mesh = mesh_model(model, options, {}, k_context);
      expect_sound(model, mesh);
      EXPECT_LE(chord_error_of(model, mesh), error) << name << ", " << mesh.mesh.n_triangles() << " triangles";
      EXPECT_LT(mesh.mesh.n_triangles(), 400'000u) << name;  // the predicted number used to be 1e20
    }
}

TEST(MeshModel, AChordErrorIsMetOnRealModels) {
  STERNA_NEEDS_SHARED_DATA();
  struct Case {
    std::string file;
    double error;  ///< m
  };
  for (const Case& c : {Case{"smx/delta.smx", 0.005}, Case{"cad/dealii_cad_wing.iges", 0.002}, Case{"cad/tigl_simplewing_simplewing.brep", 0.001}}) {
    const std::filesystem::path path = test::shared_data() / c.file;
    const Model model = path.extension() == ".smx" ? make_components(read_smx(path, k_context).aircraft, k_context) : io::read_cad(path, {}, k_context).model;
    SurfaceMeshOptions options;
    options.sizes.chord_error = c.error;
    options.crossings = "warn";  // parts are left as they are: only distances are tested
    const SurfaceMesh mesh = mesh_model(model, options, {}, k_context);
    const double most = chord_error_of(model, mesh);
    EXPECT_LE(most, c.error) << c.file << ", " << mesh.mesh.n_triangles() << " triangles";
  }
}

TEST(MeshModel, TheDefaultNacellesLipIsResolved) {
  for (const double refinement : {1.0, 1.5}) {
    NacelleOptions n;
    n.length = 4.0;
    n.diameter = 2.1;
    SurfaceMeshOptions options;
    options.sizes.refinement = refinement;
    const SurfaceMesh mesh = mesh_model(make_body(nacelle_body("engine", {}, n), ComponentKind::nacelle), options, {}, k_context);
    EXPECT_LT(mesh.report.max_smooth_angle, 45 * k_degree) << to_text(mesh.report);
  }
}

/// The lower size limit at a round tip's thin end is kept in coarse members, so edges that are smooth in member 1 are smooth in all members.
TEST(MeshModel, CoarseMembersKeepRoundTipsSmooth) {
  Wing wing{.name = "W", .is_symmetric = true, .trailing_edge = 0.0007};
  for (const double y : {1.2, 0.0})
    wing.sections.push_back({.name = "y", .leading_edge = {0.4 * y, y, 0.0}, .chord = 0.8 - 0.3 * y, .points = naca_airfoil("0010").points});
  wing.right_tip = wing.left_tip = {CapShape::strip, 1.0};
  const Model model = make_wing(wing);
  SurfaceMeshOptions options;
  options.sizes.max_edge = 0.045;
  for (const double refinement : {0.5, 0.7, 1.0}) {
    options.sizes.refinement = refinement;
    const SurfaceMesh mesh = mesh_model(model, options, {}, k_context);
    EXPECT_LT(mesh.report.max_smooth_angle, 55 * k_degree) << refinement << ": " << to_text(mesh.report);
  }
}

TEST(MeshModel, TooSmallChordErrorIsRefusedAtOnce) {
  SurfaceMeshOptions options;
  options.sizes.chord_error = 1e-9;
  try {
    mesh_model(make_ball(3.0), options, {}, k_context);
    FAIL();
  } catch (const Error& error) {
    EXPECT_EQ(error.code(), ErrorCode::overflow);
    // 36 pi m^2 by 3^(1/2) / 4 x 6 R (0.6 e): edges are up to a third longer than their target
    EXPECT_THAT(error.what(), testing::AllOf(testing::HasSubstr("chord_error = 1e-09 m requires about 2.4e+10 triangles"), testing::HasSubstr("min_edge")));
  }
  // If min_edge is given, it is the target.
  options.sizes.max_edge = 1.0;
  options.sizes.min_edge = 0.5;
  EXPECT_GT(mesh_model(make_ball(3.0), options, {}, k_context).mesh.n_triangles(), 100u);
}

TEST(BackgroundSizes, IsTheLeastOfItsSources) {
  std::vector<SizePoint> sources;
  for (int i = 0; i < 200; ++i)
    sources.push_back({{std::sin(12.9898 * i), std::sin(78.233 * i), std::sin(37.719 * i)}, 0.05 + 0.1 * std::abs(std::sin(4.1 * i))});
  const BackgroundSizes field(sources, 0.2, 1.0, k_context);
  for (int i = 0; i < 100; ++i) {
    const Point p{2 * std::sin(1.3 * i), 2 * std::sin(2.7 * i), 2 * std::sin(3.9 * i)};
    double exact = 0.3;
    for (const SizePoint& s : sources) exact = std::min(exact, s.size + 0.2 * distance(p, s.point));
    EXPECT_GE(field(p, 0.3), exact);
    // Sources of one cell are merged to the smallest one, which is at most the cell's diagonal away.
    EXPECT_LE(field(p, 0.3), 1.35 * exact);
  }
}

TEST(MatchesGlob, StarsAndQuestionMarks) {
  EXPECT_TRUE(matches_glob("wing", "wing"));
  EXPECT_TRUE(matches_glob("wingLeft", "wing*"));
  EXPECT_TRUE(matches_glob("LeftWingTip", "*Wing*"));
  EXPECT_TRUE(matches_glob("abcabd", "*ab?"));
  EXPECT_TRUE(matches_glob("", "*"));
  EXPECT_FALSE(matches_glob("wing", "win"));
  EXPECT_FALSE(matches_glob("body", "wing*"));
  EXPECT_FALSE(matches_glob("ab", "a?b"));
}

}  // namespace
}  // namespace sterna::surfmesh
