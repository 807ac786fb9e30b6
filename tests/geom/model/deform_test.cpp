#include "geom/model/deform.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <fstream>
#include <numbers>
#include <random>

#include "geom/base/error.h"
#include "geom/model/analytic_surfaces.h"
#include "geom/model/curves.h"
#include "geom/model/radial_map.h"
#include "geom/model/spline.h"
#include "geom/model/swept_surfaces.h"
#include "geom/model/transformed.h"
#include "tests/geom/model/evaluator_checks.h"
#include "tests/support/data.h"
#include "tests/support/error_of.h"
#include "tests/support/test_constants.h"

namespace sterna {
namespace {

using test::k_pi;
using test::message_of;

SurfacePtr bump() {
  PointGrid grid{7, 6, {}};
  for (int i = 0; i < 7; ++i)
    for (int j = 0; j < 6; ++j) grid.points.push_back({0.4 * i, 0.5 * j, 0.3 * std::sin(0.9 * i) * std::cos(0.7 * j)});
  return spline_surface(grid, {.tangents = SplineTangents::akima}, {});
}

CurvePtr wave() {
  std::vector<Point> points;
  for (int i = 0; i < 8; ++i) points.push_back({0.5 * i, std::sin(0.7 * i) + 3.0, 0.1 * i});
  return spline_curve(points, {});
}

std::vector<SurfacePtr> all_surfaces() {
  const Frame frame = frame_along({0.3, -0.2, 1.0}, {1.0, 2.0, 0.5}, {0.0, 0.0, 1.0});
  return {bump(),
          std::make_shared<PlaneSurface>(frame, ParameterBox{{-1, 2}, {0, 1}}),
          std::make_shared<CylinderSurface>(frame, 0.7, ParameterBox{k_full_turn, {-1, 2}}),
          std::make_shared<ConeSurface>(frame, 0.7, -0.2, ParameterBox{{0, 1}, {0, 1}}),
          std::make_shared<SphereSurface>(frame, 2.0),
          std::make_shared<TorusSurface>(frame, 2.0, 0.3),
          std::make_shared<RevolutionSurface>(wave(), Point{1, 0, 0}, Vec3{1, 0.1, 0}, Interval{0.1, 2.0}),
          std::make_shared<ExtrusionSurface>(wave(), Vec3{0, 0.3, 1}, Interval{-1, 1}),
          std::make_shared<RuledSurface>(wave(), segment({0, 0, 4}, {3, 0, 4})),
          exchanged(part_of(bump(), {{0.2, 0.7}, {0.1, 0.8}}))};
}

std::vector<Transform> all_transforms() {
  return {translation({1, 2, 3}),
          rotation({1, 0, 0}, {1, 1, 0.3}, 0.8),
          scaling({0, 1, 0}, 0.001),
          mirroring({0, 0.5, 0}, {0.1, 1, 0}),
          rotation({}, {0, 1, 0}, 1.0) * mirroring({}, {1, 0, 0}) * scaling({}, 3.0),
          Transform{{1, 0.2, 0}, {0, 2, 0.1}, {0.3, 0, 0.7}, {1, 1, 1}}};
}

TEST(Transformed, SurfacesAndCurvesAreImagesAtEqualParameters) {
  for (const SurfacePtr& s : all_surfaces()) {
    for (const Transform& t : all_transforms()) {
      const SurfacePtr image = transformed(s, t);
      EXPECT_EQ(image->kind(), s->kind());
      const ParameterBox box = s->domain();
      EXPECT_EQ(image->domain(), box);
      const double size = test::size_of(*image) + norm(t.shift);
      for (int k = 0; k < 40; ++k) {
        const Uv at{box.u.from + box.u.length() * (k % 7) / 6.0, box.v.from + box.v.length() * (k % 11) / 10.0};
        const SurfaceDerivatives a = image->derivatives(at), b = s->derivatives(at);
        EXPECT_LE(distance(a.point, t.point(b.point)), 1e-14 * size) << s->kind();
        EXPECT_LE(distance(a.duv, t.vector(b.duv)), 1e-11 * (size + norm(a.duv)));
        EXPECT_LE(distance(a.dvv, t.vector(b.dvv)), 1e-11 * (size + norm(a.dvv)));
      }
      test::expect_derivatives(*image, 5);
      EXPECT_EQ(image->exact_nurbs().has_value(), s->exact_nurbs().has_value()) << s->kind();
      if (image->exact_nurbs()) test::expect_exact_nurbs(*image);
      const SurfacePtr back = transformed(image, t.inverse());
      EXPECT_LE(distance(back->point({box.u.from, box.v.to}), s->point({box.u.from, box.v.to})), 1e-13 * 10);
    }
  }
  const CurvePtr arc = circle(frame_along({1, 1, 1}, {1, 2, 3}), 2.0, {0.3, 2.0});
  for (const CurvePtr& c : {wave(), arc, segment({0, 0, 0}, {1, 2, 3}), reversed(wave())})
    for (const Transform& t : all_transforms()) {
      const CurvePtr image = transformed(c, t);
      for (int k = 0; k <= 10; ++k) {
        const double s = c->domain().from + c->domain().length() * k / 10.0;
        EXPECT_LE(distance(image->point(s), t.point(c->point(s))), 1e-13);
      }
      test::expect_derivatives(*image, 5);
    }
  test::expect_error(ErrorCode::bad_argument, "flattens space (its determinant is 0)", [&] {
    (void)transformed(wave(), Transform{{1, 0, 0}, {0, 1, 0}, {1, 1, 0}, {}});
  });
}

/// A bending beam with known derivatives: z += a x^2 + b x y.
class Bend final : public SpaceMap {
 public:
  Point point(const Point& p) const override { return {p.x, p.y, p.z + 0.2 * p.x * p.x + 0.1 * p.x * p.y}; }
  SpaceMapDerivatives derivatives(const Point& p) const override {
    SpaceMapDerivatives d;
    d.point = point(p);
    d.dx = {1, 0, 0.4 * p.x + 0.1 * p.y};
    d.dy = {0, 1, 0.1 * p.x};
    d.dz = {0, 0, 1};
    d.dxx = {0, 0, 0.4};
    d.dxy = {0, 0, 0.1};
    return d;
  }
};

TEST(Deformed, DerivativesFollowTheChainRule) {
  const SpaceMapPtr bend = std::make_shared<Bend>();
  const SpaceMapPtr by_function = std::make_shared<FunctionMap>([](const Point& p) { return Point{p.x, p.y, p.z + 0.2 * p.x * p.x + 0.1 * p.x * p.y}; }, 1e-3);
  for (const SurfacePtr& s : all_surfaces()) {
    const DeformedSurface exact(s, bend), numerical(s, by_function);
    test::expect_derivatives(exact, 20);
    test::expect_batch(exact);
    const ParameterBox box = s->domain();
    for (int k = 0; k < 20; ++k) {
      const Uv at{box.u.from + box.u.length() * (k % 5 + 0.5) / 5.0, box.v.from + box.v.length() * (k % 4 + 0.5) / 4.0};
      const SurfaceDerivatives a = exact.derivatives(at), b = numerical.derivatives(at);
      EXPECT_LE(distance(a.point, b.point), 1e-14 * 10);
      EXPECT_LE(distance(a.du, b.du), 1e-10 * (1 + norm(s->derivatives(at).du)));
      EXPECT_LE(distance(a.duv, b.duv), 1e-7 * (1 + norm(a.duv) + norm2(s->derivatives(at).du) + norm2(s->derivatives(at).dv)));
    }
  }
  test::expect_derivatives(DeformedCurve(wave(), bend));
  test::expect_error(ErrorCode::bad_argument, "the step of its derivatives is 0 m, must be positive",
                     [&] { (void)FunctionMap([](const Point& p) { return p; }, 0.0); });
  try {
    FunctionMap([](const Point&) { return Point{NAN, 0, 0}; }, 1.0).point({1, 2, 3});
    FAIL();
  } catch (const Error& e) {
    EXPECT_THAT(e.what(), testing::AllOf(testing::HasSubstr("not finite"), testing::HasSubstr("(1, 2, 3)")));
  }
}

ScatteredDisplacements scattered(int n, const std::function<Vec3(const Point&)>& f, bool is_flat = false) {
  std::mt19937_64 random(5);
  std::uniform_real_distribution<double> unit(-1.0, 1.0);
  ScatteredDisplacements data;
  for (int i = 0; i < n; ++i) {
    const Point p{3.0 + 4.0 * unit(random), unit(random), is_flat ? 0.0 : 0.5 * unit(random)};
    data.at.push_back(p);
    data.shift.push_back(f(p));
  }
  return data;
}

TEST(RadialMap, InterpolatesAndReproducesLinearMaps) {
  const auto smooth = [](const Point& p) { return Vec3{0.01 * p.y, 0.0, 0.02 * p.x * p.x}; };
  const Transform turn = rotation({1, 0, 0}, {0, 1, 0.2}, 0.4);
  const auto rigid = [&](const Point& p) { return turn.point(p) - p; };
  for (const char* kernel : {"thin_plate", "wendland_c2"}) {
    for (const bool is_flat : {false, true}) {
      const ScatteredDisplacements data = scattered(120, smooth, is_flat);
      const RadialMap map(data, {.kernel = kernel});
      for (std::size_t i = 0; i < data.at.size(); ++i) EXPECT_LE(distance(map.point(data.at[i]), data.at[i] + data.shift[i]), 1e-9);
    }
    const RadialMap map(scattered(80, rigid), {.kernel = kernel});
    for (const Point p : {Point{10, 3, -2}, Point{0, 0, 0}, Point{3, 0.2, 0.1}}) {
      EXPECT_LE(distance(map.point(p), turn.point(p)), 1e-9);
      EXPECT_NEAR(map.derivatives(p).determinant(), 1.0, 1e-9);
    }
  }
  // Without the linear part, bumps end at their radius.
  const RadialMap local({{{0, 0, 0}}, {{0, 0, 1}}}, {.kernel = "wendland_c2", .radius = 0.5, .linear_part = false});
  EXPECT_LE(distance(local.point({0, 0, 0}), {0, 0, 1}), 1e-15);
  EXPECT_EQ(local.point({0.6, 0, 0}), (Point{0.6, 0, 0}));
  EXPECT_GT(local.point({0.1, 0, 0}).z, 0.1);
}

TEST(RadialMap, DerivativesAgainstDifferences) {
  for (const char* kernel : {"thin_plate", "wendland_c2"}) {
    const SpaceMapPtr map = std::make_shared<RadialMap>(scattered(60,
                                                                  [](const Point& p) {
                                                                    return Vec3{0.02 * std::sin(p.x), 0.03 * p.x * p.y, 0.05 * p.x * p.x};
                                                                  }),
                                                        RadialMapOptions{.kernel = kernel});
    const FunctionMap numerical([&](const Point& p) { return map->point(p); }, 2e-3);
    std::mt19937_64 random(9);
    std::uniform_real_distribution<double> unit(-1.0, 1.0);
    for (int k = 0; k < 30; ++k) {
      const Point p{3.0 + 4.0 * unit(random), unit(random), unit(random)};
      const SpaceMapDerivatives a = map->derivatives(p), b = numerical.derivatives(p);
      EXPECT_LE(distance(a.dx, b.dx) + distance(a.dy, b.dy) + distance(a.dz, b.dz), 1e-6);
      EXPECT_LE(
          distance(a.dxx, b.dxx) + distance(a.dyy, b.dyy) + distance(a.dzz, b.dzz) + distance(a.dxy, b.dxy) + distance(a.dxz, b.dxz) + distance(a.dyz, b.dyz),
          2e-3);
    }
  }
}

TEST(RadialMap, MistakesHaveTheirPlaceAndLine) {
  EXPECT_THAT(message_of([] {
                RadialMap({{{0, 0, 0}, {1, 0, 0}, {0, 0, 0}}, {{0, 0, 1}, {0, 0, 0}, {0, 0, 2}}});
              }),
              testing::AllOf(testing::HasSubstr("points 1 and 3"), testing::HasSubstr("(0, 0, 0)")));
  EXPECT_EQ(RadialMap({{{0, 0, 0}, {1, 0, 0}, {0, 0, 0}}, {{0, 0, 1}, {0, 0, 0}, {0, 0, 1}}}).n_points(), 2u);
  EXPECT_THAT(message_of([] { RadialMap(ScatteredDisplacements{}); }), testing::HasSubstr("no points"));
  const std::filesystem::path file = test::scratch() / "shift.txt";
  const auto read = [&](const char* text) {
    std::ofstream(file) << text;
    return message_of([&] { (void)read_displacements(file); });
  };
  EXPECT_EQ(read("# x y z dx dy dz\n1, 2, 3, 0, 0, 1e-3\n\n4;5;6;0;+1;2 # last\r\n"), "");
  EXPECT_EQ(read_displacements(file).at[1], (Point{4, 5, 6}));
  EXPECT_THAT(read("1 2 3 0 0 1\n1 2 3 4 5\n"), testing::AllOf(testing::HasSubstr("line 2"), testing::HasSubstr("5 numbers")));
  EXPECT_THAT(read("1 2 3 0 0 1 7\n"), testing::AllOf(testing::HasSubstr("line 1"), testing::HasSubstr("more than 6")));
  EXPECT_THAT(read("1 2 3 0 zero 1\n"), testing::HasSubstr("\"zero\" is not"));
  EXPECT_THAT(read("# nothing\n"), testing::HasSubstr("holds no points"));
  EXPECT_THAT(message_of([&] { (void)read_displacements(file.parent_path() / "absent.txt"); }), testing::HasSubstr("does not exist"));
}

/// Two patches of a bump that share the edge u = 0.5.
Model two_faces() {
  const SurfacePtr base = bump();
  Model model;
  const ComponentId wing = model.components.push_back({"wing left", ComponentKind::wing});
  const auto corner = [&](double u, double v) { return model.corners.push_back({base->point({u, v}), 1e-7}); };
  CornerId c[3][2];
  for (int i = 0; i < 3; ++i)
    for (int j = 0; j < 2; ++j) c[i][j] = corner(0.5 * i, j);
  const auto edge = [&](Uv a, Uv b, CornerId from, CornerId to) {
    std::vector<Point> points;
    for (int k = 0; k <= 30; ++k) points.push_back(base->point(a + (k / 30.0) * (b - a)));
    return model.edges.push_back({spline_curve(points, {.parameters = SplineParameters::uniform}), {0, 1}, from, to, 1e-5, ""});
  };
  EdgeId across[3], along[2][2];
  for (int i = 0; i < 3; ++i) across[i] = edge({0.5 * i, 0}, {0.5 * i, 1}, c[i][0], c[i][1]);
  for (int i = 0; i < 2; ++i)
    for (int j = 0; j < 2; ++j) along[i][j] = edge({0.5 * i, 1.0 * j}, {0.5 * (i + 1), 1.0 * j}, c[i][j], c[i + 1][j]);
  for (int i = 0; i < 2; ++i) {
    const double u0 = 0.5 * i, u1 = u0 + 0.5;
    ModelFace face;
    face.surface = base;
    face.component = wing;
    face.name = i == 0 ? "wing left upper" : "support";
    face.tolerance = 1e-6;
    face.borders = {{{along[i][0], false, parameter_segment({u0, 0}, {u1, 0})},
                     {across[i + 1], false, parameter_segment({u1, 0}, {u1, 1})},
                     {along[i][1], true, parameter_segment({u0, 1}, {u1, 1})},
                     {across[i], true, parameter_segment({u0, 0}, {u0, 1})}}};
    model.faces.push_back(face);
  }
  return model;
}

void expect_edges_on_faces(const Model& model) {
  for (const ModelFace& face : model.faces)
    for (const EdgeUse& use : face.borders[0]) {
      const ModelEdge& edge = model.edges[use.edge];
      for (int k = 0; k <= 10; ++k) EXPECT_LE(distance(edge.curve->point(k / 10.0), face.surface->point(use.parameter->point(k / 10.0))), edge.tolerance);
      EXPECT_LE(distance(edge.curve->point(0.0), model.corners[edge.start].point), model.corners[edge.start].tolerance);
      EXPECT_LE(distance(edge.curve->point(1.0), model.corners[edge.end].point), model.corners[edge.end].tolerance);
    }
}

TEST(DeformedModel, SharedStaysSharedAndEdgesStayOnFaces) {
  const RunContext context({.threads = 2});
  const Model model = two_faces();
  expect_edges_on_faces(model);
  const Model bent = deformed(model, std::make_shared<Bend>(), context);
  expect_edges_on_faces(bent);
  EXPECT_EQ(bent.faces.raw()[0].surface, bent.faces.raw()[1].surface);
  EXPECT_EQ(uses_of_edges(bent).raw()[1].size(), 2u);
  EXPECT_EQ(bent.faces.raw()[0].name, "wing left upper");
  EXPECT_LE(distance(bent.faces.raw()[0].surface->point({0.3, 0.4}), Bend().point(model.faces.raw()[0].surface->point({0.3, 0.4}))), 0.0);

  const Model image = mirrored(model, {0, 0, 0}, {0, 1, 0});
  expect_edges_on_faces(image);
  EXPECT_EQ(image.components.raw()[0].name, "wing right");
  EXPECT_EQ(image.faces.raw()[0].name, "wing right upper");
  EXPECT_EQ(image.faces.raw()[1].name, "support mirrored");
  EXPECT_TRUE(image.faces.raw()[0].is_reversed);
  // Outward normals are mirrored: a normal that points up still points up.
  const SurfaceDerivatives d = image.faces.raw()[0].surface->derivatives({0.2, 0.2});
  EXPECT_GT(-cross(d.du, d.dv).z, 0.0);
  EXPECT_EQ(mirrored_name("WingLeft"), "WingRight");
  EXPECT_EQ(mirrored_name("Starboard fin"), "Port fin");

  const Model small = transformed(model, scaling({}, 0.001));
  expect_edges_on_faces(small);
  EXPECT_NEAR(small.edges.raw()[0].tolerance, 1e-8, 1e-20);
}

TEST(DeformedModel, FoldOverIsAnErrorWithItsPlace) {
  const RunContext context({.threads = 2});
  const SpaceMapPtr fold = std::make_shared<FunctionMap>(
      [](const Point& p) {
        return Point{p.x - 1.5 * std::exp(-4.0 * (p.x - 1.0) * (p.x - 1.0)) * (p.x - 1.0), p.y, p.z};
      },
      1e-3);
  try {
    (void)deformed(two_faces(), fold, context);
    FAIL() << "folded space was accepted";
  } catch (const Error& e) {
    EXPECT_EQ(e.code(), ErrorCode::self_intersection);
    EXPECT_THAT(e.what(), testing::AllOf(testing::HasSubstr("folds space"), testing::HasSubstr("face ")));
    ASSERT_FALSE(e.info().locations.empty());
    EXPECT_NEAR(e.info().locations[0].position.x, 1.0, 0.2);
  }
}

}  // namespace
}  // namespace sterna
