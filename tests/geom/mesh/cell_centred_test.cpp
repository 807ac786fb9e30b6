// OpenFOAM's measures against values calculated by hand; tests/io/volume/foam_quality_test.cpp compares the measures with checkMesh on real meshes.
#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

#include "geom/mesh/check.h"
#include "tests/support/hybrid_shapes.h"
#include "tests/support/test_constants.h"
#include "tests/support/test_shapes.h"

namespace sterna {
namespace {

constexpr double k_exact = 1e-14;  // rounding of a few operations on numbers of size 1
using test::k_degree;
const std::array<Measure, 7> k_measured = {Measure::non_orthogonality, Measure::skewness,          Measure::face_weight,  Measure::volume_ratio,
                                           Measure::face_flatness,     Measure::cell_aspect_ratio, Measure::cell_openness};

CheckReport report_of(const HybridMesh& mesh, int threads = 2) { return check(mesh, {.intersections = false}, RunContext({.threads = threads})); }
double worst(const CheckReport& report, Measure measure) { return report.gate(measure).worst; }

template <class Move>
HybridMesh moved(HybridMesh mesh, const Move& move) {
  for (Point& p : mesh.points) p = move(p);
  return mesh;
}

TEST(CellCentred, CubesAreIdeal) {
  const CheckReport report = report_of(test::hexahedra_block(3));
  EXPECT_NEAR(worst(report, Measure::non_orthogonality), 0.0, 1e-7);  // acos near 1
  EXPECT_NEAR(worst(report, Measure::skewness), 0.0, k_exact);
  EXPECT_NEAR(worst(report, Measure::face_weight), 0.5, k_exact);
  EXPECT_NEAR(worst(report, Measure::volume_ratio), 1.0, 1e-12);
  EXPECT_NEAR(worst(report, Measure::face_flatness), 1.0, k_exact);
  EXPECT_NEAR(worst(report, Measure::cell_aspect_ratio), 1.0, 1e-12);
  EXPECT_LT(worst(report, Measure::cell_openness), 1e-14);
  EXPECT_EQ(report.gate(Measure::non_orthogonality).total, 54.0);  // inner faces of 3^3 cells
  EXPECT_EQ(report.gate(Measure::skewness).total, 108.0);          // plus 54 boundary faces
}

TEST(CellCentred, ShearedCubesHaveTheAngleOfTheShear) {
  const double shear = std::tan(30.0 * k_degree);
  const CheckReport report = report_of(moved(test::hexahedra_block(2), [&](const Point& p) { return Point{p.x + shear * p.z, p.y, p.z}; }));
  EXPECT_NEAR(worst(report, Measure::non_orthogonality), 30.0 * k_degree, 1e-12);
  EXPECT_NEAR(worst(report, Measure::face_weight), 0.5, k_exact);
}

TEST(CellCentred, StretchedCubesHaveTheRatioOfTheirFaces) {
  const CheckReport report = report_of(moved(test::hexahedra_block(2), [](const Point& p) { return Point{p.x, p.y, 10.0 * p.z}; }));
  EXPECT_NEAR(worst(report, Measure::cell_aspect_ratio), 10.0, 1e-11);
}

/// A cube [0, 1]^3 with a pyramid of height 0.5: centres at z = 0.5 and 1.125. The middle of a side of the pyramid is (0.5, 1/6, 7/6). The side's normal from
/// the cell centre ends (0, 0.1458, 0.1458) away from this middle, and the side extends 0.4714 in this direction.
TEST(CellCentred, APyramidOnACube) {
  const CheckReport report = report_of(test::hexahedron_with_roof());
  EXPECT_NEAR(worst(report, Measure::non_orthogonality), 0.0, 1e-7);
  EXPECT_NEAR(worst(report, Measure::face_weight), 0.125 / 0.625, k_exact);
  EXPECT_NEAR(worst(report, Measure::volume_ratio), 1.0 / 6.0, k_exact);
  EXPECT_NEAR(worst(report, Measure::skewness), 0.4375, k_exact);
  EXPECT_EQ(report.gate(Measure::skewness).state, GateState::pass);
}

/// A twisted quadrilateral (0,0,0), (1,0,h), (1,1,0), (0,1,h) against a flat one: area 1 over four triangles of 0.25 sqrt(1 + h^2) around the middle.
TEST(CellCentred, FlatnessOfATwistedQuad) {
  constexpr double h = 0.5;
  const CheckReport report = report_of(moved(test::hexahedra_block(1), [](const Point& p) { return p.z > 0.5 && p.x != p.y ? Point{p.x, p.y, p.z + h} : p; }));
  const double lift = h / 2.0;
  EXPECT_NEAR(worst(report, Measure::face_flatness), 1.0 / std::sqrt(1.0 + 4.0 * lift * lift), 1e-12);
}

TEST(CellCentred, ColumnsAndExplicitCellsAndThreadsAgree) {
  for (const auto& [name, mesh] : {std::pair("shell", test::sphere_shell(2, {.collapsed = {0, 5, 7}})), std::pair("plate", test::plate_block(3)),
                                   std::pair("two", test::two_shells(1, 3, 5)), std::pair("steps", test::stepped_sphere_shell(3)),
                                   std::pair("open steps", test::stepped_plate_block(4))}) {
    SCOPED_TRACE(name);
    const CheckReport columns = report_of(mesh), cells = report_of(explicit_cells(mesh)), serial = report_of(mesh, 1), seven = report_of(mesh, 7);
    for (const Measure measure : k_measured) {
      SCOPED_TRACE(info_of(measure).name);
      EXPECT_NEAR(worst(columns, measure), worst(cells, measure), 1e-12 * std::abs(worst(cells, measure)));
      EXPECT_EQ(columns.gate(measure).total, cells.gate(measure).total);
      EXPECT_EQ(columns.gate(measure).histogram, serial.gate(measure).histogram);
      EXPECT_EQ(columns.gate(measure).histogram, seven.gate(measure).histogram);
      EXPECT_EQ(worst(columns, measure), worst(seven, measure));
    }
  }
}

TEST(CellCentred, TheWorstFaceIsWhereItIs) {
  HybridMesh mesh = test::hexahedra_block(3);
  for (Point& p : mesh.points)
    if (distance(p, {1.0 / 3.0, 1.0 / 3.0, 1.0 / 3.0}) < 1e-9) p = {0.5, 0.5, 0.5};
  const GateResult gate = check(mesh,
                                {.intersections = false,
                                 .limits =
                                     [] {
                                       GateTable limits;
                                       limits[Measure::non_orthogonality] = {10.0 * k_degree, 5.0 * k_degree, std::nan(""), 1.0};
                                       return limits;
                                     }()},
                                RunContext({.threads = 2}))
                              .gate(Measure::non_orthogonality);
  ASSERT_FALSE(gate.locations.empty());
  EXPECT_EQ(gate.state, GateState::fail);
  EXPECT_LT(distance(gate.locations.front().position, {0.42, 0.42, 0.42}), 0.35);
  EXPECT_NE(gate.locations.front().what.find("hexahedron"), std::string::npos) << gate.locations.front().what;
}

TEST(CellCentred, CanBeLeftOut) {
  const CheckReport report = check(test::hexahedra_block(1), {.intersections = false, .cell_centred = false}, RunContext({.threads = 2}));
  for (const Measure measure : k_measured) EXPECT_EQ(report.gate(measure).state, GateState::not_checked);
}

TEST(HistogramClasses, EdgesAndClassesAgree) {
  for (const MeasureInfo& info : measures()) {
    SCOPED_TRACE(info.name);
    const std::vector<double> edges = info.classes.edges();
    if (info.classes.n == 0) {
      EXPECT_TRUE(edges.empty());
      continue;
    }
    ASSERT_EQ(edges.size(), static_cast<std::size_t>(info.classes.n) + 1);
    EXPECT_DOUBLE_EQ(edges.front(), info.classes.from);
    EXPECT_NEAR(edges.back(), info.classes.to, 1e-12 * info.classes.to);
    for (int i = 0; i < info.classes.n; ++i) {
      ASSERT_LT(edges[static_cast<std::size_t>(i)], edges[static_cast<std::size_t>(i) + 1]);
      EXPECT_EQ(info.classes.of(0.5 * (edges[static_cast<std::size_t>(i)] + edges[static_cast<std::size_t>(i) + 1])), i);
    }
    EXPECT_EQ(info.classes.of(-1.0), 0);
    EXPECT_EQ(info.classes.of(std::nan("")), info.classes.n - 1);
    EXPECT_EQ(info.classes.of(INFINITY), info.classes.n - 1);
  }
}

}  // namespace
}  // namespace sterna
