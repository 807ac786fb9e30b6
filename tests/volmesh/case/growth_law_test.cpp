#include "volmesh/case/growth_law.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <vector>

#include "geom/math/constants.h"

namespace sterna::volmesh {
namespace {

TEST(GrowthLaw, HeightIsTheGeometricSum) {
  EXPECT_DOUBLE_EQ(layer_height(1.0, 2.0, 4), 15.0);
  EXPECT_DOUBLE_EQ(layer_height(1e-3, 1.0, 10), 1e-2);
  EXPECT_NEAR(layer_height(1.0, 1.0 + 1e-12, 50), 50.0, 1e-8);  // the limit r -> 1
}

TEST(GrowthLaw, RatioInvertsTheHeight) {
  for (const int n : {2, 5, 30, 100}) {
    for (const double r : {1.0001, 1.01, 1.2, 1.4, 2.0}) {
      const double h = layer_height(1e-6, r, n);
      EXPECT_NEAR(growth_for_height(1e-6, h, n), r, 1e-10 * r) << n << " layers";
    }
  }
  EXPECT_EQ(growth_for_height(1e-3, 0.02, 30), 1.0);  // compressed
}

TEST(GrowthLaw, RatioOfEquationOneIsClamped) {
  EXPECT_NEAR(growth_for_edge(1e-6, 1e-6 * std::pow(1.3, 29), 1.4, 30), 1.3, 1e-12);
  EXPECT_EQ(growth_for_edge(1e-6, 1.0, 1.2, 10), 1.2);
  EXPECT_EQ(growth_for_edge(1e-3, 1e-4, 1.4, 10), 1.0);
}

TEST(GrowthLaw, LayerParametersRunFromFirstHeightToOne) {
  std::vector<double> t(31);
  layer_parameters(1e-6, 0.01, 30, t.data());
  EXPECT_EQ(t[0], 0.0);
  EXPECT_EQ(t[30], 1.0);
  EXPECT_NEAR(t[1] * 0.01, 1e-6, 1e-18);
  const double r = growth_for_height(1e-6, 0.01, 30);
  for (std::size_t j = 2; j <= 30; ++j) EXPECT_NEAR((t[j] - t[j - 1]) / (t[j - 1] - t[j - 2]), r, 1e-6 * r) << j;
  layer_parameters(1e-3, 3e-3, 30, t.data());  // below n h0: equal spacing
  for (std::size_t j = 1; j <= 30; ++j) EXPECT_NEAR(t[j] - t[j - 1], 1.0 / 30, 1e-12);
}

/// For any total height of the growth line, flat cells grow by the common ratio, no cell is lower than the cell below it, and the last parameter is the whole
/// height.
TEST(GrowthLaw, FlatCellsOfLineGrowByCommonRatio) {
  const double h0 = 1e-6, g = 1.3;
  for (const int n : {2, 12, 30, 45}) {
    for (const double edge : {1e-4, 1e-2, 1.0}) {
      for (const double share : {0.2, 0.5, 0.8, 0.97, 1.0, 1.3}) {
        const double requested = layer_height(h0, growth_for_edge(h0, edge, g, n), n), height = share * requested;
        const LineGrowth line{.h0 = h0, .common = g, .edge = edge, .target = requested};
        std::vector<double> t(static_cast<std::size_t>(n) + 1);
        layer_parameters(line, height, n, t.data());
        std::vector<double> full(t.size());  // of a neighbour with the full target height
        layer_parameters(line, requested, n, full.data());
        SCOPED_TRACE(testing::Message() << n << " layers, edge " << edge << ", share " << share);
        EXPECT_EQ(t.front(), 0.0);
        EXPECT_EQ(t.back(), 1.0);
        // Growth lines that are too low for the largest bend have lower first cells.
        const double room = height_for_first_cell(line, n);
        EXPECT_GE(room, n * h0 * (1.0 - 1e-12));
        if (height >= room) EXPECT_NEAR(t[1] * height, h0, 1e-12 * h0);
        else EXPECT_LE(t[1] * height, h0 * height / room * (1.0 + 1e-12));
        double above = 0.0;
        for (std::size_t j = 2; j < t.size(); ++j) {
          const double before = t[j - 1] - t[j - 2], ratio = (t[j] - t[j - 1]) / before;
          EXPECT_GE(ratio, 1.0 - 1e-9) << j;
          above = std::max(above, ratio);
          // The face between two prisms leans by atan(s e / 4 h) if the ratios at its corners differ by s.
          if (share >= 0.97 && share <= 1.0 && last_height(line, height, n) > edge / 20.0) {
            const double beside = (full[j] - full[j - 1]) / (full[j - 1] - full[j - 2]);
            EXPECT_LT(std::atan(std::abs(ratio / beside - 1.0) * edge / (4.0 * before * height)), 40.0 * k_degree) << j;
          }
        }
        EXPECT_LE(above, largest_growth(line, height, n) * (1.0 + 1e-9));
        EXPECT_NEAR((t[t.size() - 1] - t[t.size() - 2]) * height, last_height(line, height, n), 1e-9 * height);
      }
    }
  }
}

/// A growth line of a hundredth of the height beside a line of full height: flat cells keep their proportions, so that faces between them do not lean.
TEST(GrowthLaw, FlatCellsKeepProportionsOnVeryLowLines) {
  const double h0 = 1e-6, g = 1.25, edge = 0.1;
  const int n = 45;
  const double full = layer_height(h0, growth_for_edge(h0, edge, g, n), n);
  const LineGrowth line{.h0 = h0, .common = g, .edge = edge, .target = full};
  std::vector<double> tall(n + 1), low(n + 1), lower(n + 1);
  layer_parameters(line, full, n, tall.data());
  for (const double share : {0.1, 0.01, 0.001}) {
    layer_parameters(line, share * full, n, low.data());
    EXPECT_LT(low[1] * share * full, h0);
    layer_parameters(line, 0.5 * share * full, n, lower.data());
    EXPECT_NEAR(lower[2] / lower[1], low[2] / low[1], 1e-9);
    double change = 0.0;  // radians, the lean of faces between the two growth lines
    for (std::size_t j = 2; j <= n; ++j) {
      const double h = (tall[j - 1] - tall[j - 2]) * full;
      const double tall_ratio = (tall[j] - tall[j - 1]) / (tall[j - 1] - tall[j - 2]), low_ratio = (low[j] - low[j - 1]) / (low[j - 1] - low[j - 2]);
      change = std::max(change, std::atan(std::abs(low_ratio / tall_ratio - 1.0) * edge / (4.0 * h)));
    }
    EXPECT_LT(change, 70.0 * k_degree);
  }
}

/// Beside vertices without a layer, two growth lines may have a thousandth of their full height, on edges of different length. Flatness must be judged by the
/// cells made, not by those of a line of full height; otherwise lines bend while their cells are 1e4 times wider than tall (found on bjet and D150: faces at
/// 89.97 degrees).
TEST(GrowthLaw, VeryLowLinesKeepProportionsForAnyEdges) {
  const double h0 = 7e-6, g = 1.25;
  const int n = 50;
  const LineGrowth near{.h0 = h0, .common = g, .edge = 0.1, .target = 0.08}, beside{.h0 = h0, .common = g, .edge = 0.15, .target = 0.1};
  std::vector<double> a(n + 1), b(n + 1);
  for (const double height : {3e-4, 3e-3, 3e-2}) {
    layer_parameters(near, height, n, a.data());
    layer_parameters(beside, 1.7 * height, n, b.data());
    EXPECT_LE(a[1] * height, h0);
    for (std::size_t j = 2; j <= n; ++j) {
      const double h = (a[j - 1] - a[j - 2]) * height;
      const double ratio = (a[j] - a[j - 1]) / (a[j - 1] - a[j - 2]), other = (b[j] - b[j - 1]) / (b[j - 1] - b[j - 2]);
      EXPECT_LT(std::atan(std::abs(ratio / other - 1.0) * near.edge / (4.0 * h)), 80.0 * k_degree) << height << ", cell " << j;
    }
    EXPECT_NEAR(last_height(near, height, n), (a[n] - a[n - 1]) * height, 1e-9 * height);
  }
}

/// If cells are not flat, or on request, the law is that of eq. (11).
TEST(GrowthLaw, WithoutFlatCellsALineHasOneRatio) {
  std::vector<double> common(13), local(13);
  layer_parameters({.h0 = 1e-3, .common = 1.3, .edge = 5e-3, .target = 0.03}, 0.03, 12, common.data());
  layer_parameters(1e-3, 0.03, 12, local.data());
  for (std::size_t j = 0; j <= 12; ++j) EXPECT_NEAR(common[j], local[j], 1e-12) << j;
  layer_parameters({.h0 = 1e-6, .common = 0.0, .edge = 0.1}, 0.03, 12, common.data());
  layer_parameters(1e-6, 0.03, 12, local.data());
  for (std::size_t j = 0; j <= 12; ++j) EXPECT_EQ(common[j], local[j]) << j;
}

}  // namespace
}  // namespace sterna::volmesh
