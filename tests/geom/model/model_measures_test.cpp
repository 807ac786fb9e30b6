// Areas and volumes against formulas: holes, seams, parameters beyond a period, borders whose curves continue beyond their edges.
#include "geom/model/model_measures.h"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

#include "geom/model/analytic_surfaces.h"
#include "geom/model/curves.h"
#include "geom/model/deform.h"
#include "geom/model/space_map.h"
#include "tests/geom/cad/cylinder.h"
#include "tests/support/test_constants.h"

namespace sterna {
namespace {

using test::k_pi;

/// Returns one face over a polygon of parameters; the curves of its edges continue by `beyond` at both ends.
Model patch(SurfacePtr surface, const std::vector<Uv>& outline, double beyond = 0.0) {
  Model model;
  ModelFace face{.surface = surface, .borders = {{}}, .component = model.components.push_back({"patch"}), .name = "patch"};
  std::vector<CornerId> corners;
  for (const Uv& at : outline) corners.push_back(model.corners.push_back({surface->point(at)}));
  for (std::size_t i = 0; i < outline.size(); ++i) {
    const Uv a = outline[i], b = outline[(i + 1) % outline.size()];
    const EdgeId edge = model.edges.push_back(
        {.curve = segment(surface->point(a), surface->point(b)), .range = {0.0, 1.0}, .start = corners[i], .end = corners[(i + 1) % outline.size()]});
    face.borders[0].push_back({edge, false, std::make_shared<ParameterLine>(a, b - a, Interval{-beyond, 1.0 + beyond})});
  }
  model.faces.push_back(face);
  return model;
}

TEST(ModelMeasures, PlaneWithRoundHole) {
  const Frame frame{{0, 0, 2}, {1, 0, 0}, {0, 1, 0}, {0, 0, 1}};
  Model model = patch(std::make_shared<PlaneSurface>(frame, ParameterBox{{0, 4}, {0, 3}}), {{0, 0}, {4, 0}, {4, 3}, {0, 3}});
  const CornerId corner = model.corners.push_back({{2.5, 1.5, 2}});
  const EdgeId hole = model.edges.push_back(
      {.curve = circle({{2, 1.5, 2}, {1, 0, 0}, {0, 1, 0}, {0, 0, 1}}, 0.5, k_full_turn), .range = k_full_turn, .start = corner, .end = corner});
  model.faces[FaceId(0)].borders.push_back({{hole, true, std::make_shared<ParameterArc>(Uv{2, 1.5}, Uv{0.5, 0}, Uv{0, 0.5}, k_full_turn)}});
  const FaceMeasures m = face_measures(model, FaceId(0));
  const double area = 12.0 - k_pi * 0.25;
  EXPECT_NEAR(m.area, area, 1e-10);
  EXPECT_NEAR(m.volume, 2.0 * area / 3.0, 1e-10);
  EXPECT_NEAR(m.projected_z, 0.5 * area, 1e-10);
  EXPECT_NEAR(distance(m.area_moment, area * Vec3{2, 1.5, 2}), 0.0, 1e-9);
  EXPECT_NEAR(distance(m.box.min, {0, 0, 2}) + distance(m.box.max, {4, 3, 2}), 0.0, 1e-12);
}

TEST(ModelMeasures, CurvesBeyondEdgesAndParametersBeyondPeriod) {
  const Frame frame{{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {0, 0, 1}};
  const auto round = std::make_shared<CylinderSurface>(frame, 0.5, ParameterBox{k_full_turn, {0, 2}});
  for (const double start : {0.0, 5.5, -7.0}) {
    const FaceMeasures m = face_measures(patch(round, {{start, 0.2}, {start + 1.5, 0.2}, {start + 1.5, 1.7}, {start, 1.7}}, 0.7), FaceId(0));
    EXPECT_NEAR(m.area, 0.5 * 1.5 * 1.5, 1e-12) << start;
    EXPECT_NEAR(m.volume, m.area * 0.5 / 3.0, 1e-12);
  }
  // Slanted borders on a sphere: area of a spherical triangle between two meridians and a straight line in (u, v), by an integral of its own.
  const auto sphere = std::make_shared<SphereSurface>(frame, 1.0);
  const FaceMeasures m = face_measures(patch(sphere, {{0.0, 0.0}, {1.0, 0.0}, {1.0, 1.0}}, 0.3), FaceId(0));
  EXPECT_NEAR(m.area, 1.0 - std::cos(1.0), 1e-11);  // integral of sin u over 0 .. 1
  EXPECT_NEAR(m.volume, m.area / 3.0, 1e-11);
}

TEST(ModelMeasures, SolidsHaveVolumeCentreAndBox) {
  const Model can = test::cylinder(0.3, 2.0, {10, -4, 7});
  const ModelMeasures m = model_measures(can, RunContext());
  EXPECT_NEAR(m.total.volume, k_pi * 0.09 * 2.0, 1e-11);
  EXPECT_NEAR(m.total.area, 2.0 * k_pi * 0.3 * 2.3, 1e-10);
  EXPECT_NEAR(distance(m.total.centre, {10, -4, 8}), 0.0, 1e-10);
  EXPECT_NEAR(m.total.box.max.z - m.total.box.min.z, 2.0, 1e-12);
  EXPECT_NEAR(m.total.box.max.x, 10.3, 2e-3);
  EXPECT_TRUE(m.total.has_volume);
  ASSERT_EQ(m.solids.size(), 1u);
  EXPECT_EQ(m.solids[0].n_faces, 3u);
  // The image under a map of constant determinant, by the same quadrature: bending shears layers, so the volume stays constant.
  const auto bend = std::make_shared<FunctionMap>([](const Point& p) { return Point{p.x + 0.05 * (p.z - 7) * (p.z - 7), p.y, p.z}; }, 1e-3);
  EXPECT_NEAR(model_measures(deformed(can, bend, RunContext()), RunContext()).total.volume, m.total.volume, 1e-9 * m.total.volume);
}

TEST(ModelMeasures, AnOpenSolidHasNoVolume) {
  Model can = test::cylinder(1.0, 1.0);
  can.solids[SolidId(0)].is_closed = false;
  const ModelMeasures m = model_measures(can, RunContext());
  EXPECT_FALSE(m.total.has_volume);
  EXPECT_EQ(m.total.volume, 0.0);
  EXPECT_NEAR(m.total.area, 4.0 * k_pi, 1e-9);
}

}  // namespace
}  // namespace sterna
