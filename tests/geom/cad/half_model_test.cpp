#include "geom/cad/half_model.h"

#include <cmath>
#include <numbers>
#include <set>

#include <gtest/gtest.h>

#include "cylinder.h"
#include "geom/cad/read_cad.h"
#include "geom/model/components.h"
#include "geom/model/deform.h"
#include "geom/model/model_builder.h"
#include "geom/model/model_measures.h"
#include "geom/model/shapes.h"
#include "tests/support/error_of.h"

namespace sterna {
namespace {

using std::numbers::pi;

double area_of(const Model& model) {
  double area = 0.0;
  for (const FaceId f : model.faces.ids()) area += face_measures(model, f).area;
  return area;
}

/// Checks that free edges exist and lie exactly in the plane with their end points, and that all other points are on one side.
void expect_half(const Model& model, std::size_t axis = 1, double at = 0.0) {
  const std::vector<EdgeId> border = free_edges(model);
  EXPECT_FALSE(border.empty());
  for (const EdgeId e : border) {
    const ModelEdge& edge = model.edges[e];
    for (int i = 0; i <= 10; ++i) {
      const double y = edge.curve->point(edge.range.from + edge.range.length() * i / 10)[axis];
      EXPECT_EQ(y, at);
      EXPECT_FALSE(std::signbit(y) && at == 0.0);
    }
    for (const CornerId c : {edge.start, edge.end}) EXPECT_EQ(model.corners[c].point[axis], at);
  }
}

TEST(HalfModel, ABodyAcrossThePlaneIsCut) {
  const Model rod = make_cylinder("rod", {0, -1, 0.5}, {0, 2, 0.5}, 0.25);  // its lateral surface crosses y = 0
  const HalfModel half = cad::half_model(rod, {}, RunContext());
  expect_half(half.model);
  EXPECT_EQ(half.report.n_faces_cut, 2u);
  EXPECT_FALSE(half.report.was_half);
  EXPECT_NEAR(half.report.border_length, 2.0 * pi * 0.25, 5e-3);
  EXPECT_NEAR(area_of(half.model), pi * 0.0625 + 2.0 * pi * 0.25 * 2.0, 1e-5);
  for (const ModelFace& face : half.model.faces) EXPECT_EQ(face.name, "rod");
  const HalfModel other = cad::half_model(rod, {.keep = "-"}, RunContext());
  EXPECT_NEAR(area_of(other.model), pi * 0.0625 + 2.0 * pi * 0.25 * 1.0, 1e-5);
}

TEST(HalfModel, AlongOtherPlanes) {
  const Model rod = make_cylinder("rod", {0.3, 0, 0}, {0.3, 0, 3}, 0.25);
  const HalfModel top = cad::half_model(rod, {.axis = "z", .at = 0.7}, RunContext());
  expect_half(top.model, 2, 0.7);
  EXPECT_NEAR(area_of(top.model), pi * 0.0625 + 2.0 * pi * 0.25 * 2.3, 1e-5);
  const HalfModel side = cad::half_model(rod, {.axis = "x", .at = 0.3}, RunContext());  // through the axis
  expect_half(side.model, 0, 0.3);
  EXPECT_NEAR(area_of(side.model), pi * 0.0625 + pi * 0.25 * 3.0, 1e-5);
}

TEST(HalfModel, EdgesInThePlaneNeedNoCut) {
  const Model ball = test::cylinder(0.5, 2.0, {0, 0, 0}, "post");
  const Model box = make_box("box", {0, 0, 0}, {1, 1, 1});
  // Two boxes that share the symmetry plane, as symmetric components do.
  const std::vector<Model> halves = {box, transformed(box, translation({0, -1, 0}))};
  Model both = halves[0];
  append(both, halves[1]);
  const HalfModel half = cad::half_model(both, {}, RunContext());
  expect_half(half.model);
  EXPECT_EQ(half.report.n_solids_left_out, 1u);
  EXPECT_EQ(half.report.n_flat_faces, 1u);
  EXPECT_EQ(half.report.n_faces_cut, 0u);
  EXPECT_NEAR(area_of(half.model), 5.0, 1e-9);
}

TEST(HalfModel, AHalfModelIsTakenAsItIs) {
  Model box = make_box("box", {0, 0, 0}, {1, 1, 1});
  const HalfModel closed = cad::half_model(box, {}, RunContext());  // closed by a face in the plane
  EXPECT_TRUE(closed.report.was_half);
  expect_half(closed.model);
  const HalfModel open = cad::half_model(closed.model, {}, RunContext());
  EXPECT_TRUE(open.report.was_half);
  expect_half(open.model);
  EXPECT_EQ(open.model.faces.size(), closed.model.faces.size());
  // A closing face slightly off the plane is moved into the plane.
  const HalfModel near = cad::half_model(transformed(closed.model, translation({0, 5e-7, 0})), {}, RunContext());
  expect_half(near.model);
  EXPECT_NEAR(near.report.largest_shift, 5e-7, 1e-12);
}

TEST(HalfModel, WhatIsNoHalfIsRefusedWithPlaces) {
  const Error apart = test::error_of([] { cad::half_model(make_box("box", {0, 1, 0}, {1, 2, 1}), {}, RunContext()); });
  EXPECT_EQ(apart.code(), ErrorCode::bad_argument);
  EXPECT_NE(std::string(apart.what()).find("does not reach the plane y = 0"), std::string::npos) << apart.what();
  const Error beyond = test::error_of([] { cad::half_model(make_box("box", {0, -2, 0}, {1, -1, 1}), {}, RunContext()); });
  EXPECT_NE(std::string(beyond.what()).find("keep = \"-\""), std::string::npos) << beyond.what();
  Model open = cad::half_model(make_box("box", {0, -1, 0}, {1, 1, 1}), {}, RunContext()).model;
  const Error elsewhere = test::error_of([&] { cad::half_model(transformed(open, translation({0, 0.1, 0})), {}, RunContext()); });
  EXPECT_EQ(elsewhere.code(), ErrorCode::open_surface);
  EXPECT_EQ(elsewhere.n_locations(), 4);
  const Error across = test::error_of([&] { cad::half_model(transformed(open, translation({0, -0.1, 0})), {}, RunContext()); });
  EXPECT_EQ(across.code(), ErrorCode::open_surface);
}

}  // namespace
}  // namespace sterna
