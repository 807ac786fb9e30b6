#include "volmesh/case/growth_law.h"

#include <gtest/gtest.h>

#include <cmath>

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

TEST(GrowthLaw, LayerParametersEndAtOneAndStartWithTheFirstHeight) {
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

}  // namespace
}  // namespace sterna::volmesh
