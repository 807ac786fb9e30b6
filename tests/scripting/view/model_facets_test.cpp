// Triangles of models for pictures: near the surface, oriented outwards, without gaps, independent of the number of threads.
#include "surfmesh/model/model_facets.h"

#include <gtest/gtest.h>

#include <map>
#include <numbers>

#include "geom/model/aircraft.h"
#include "geom/model/model_measures.h"
#include "geom/model/shapes.h"
#include "scripting/values/models.h"
#include "tests/support/data.h"

namespace sterna {
namespace {

using surfmesh::facets_of;
using surfmesh::ModelFacets;

struct FacetMeasures {
  double area = 0.0, volume = 0.0;
  std::size_t n_open = 0;  ///< edges (identified by their coordinates) with a number of triangles other than two
};

FacetMeasures measures_of(const ModelFacets& facets) {
  FacetMeasures m;
  std::map<std::array<double, 6>, int> edges;
  for (const auto& t : facets.triangles) {
    const Point &a = facets.points[t[0]], &b = facets.points[t[1]], &c = facets.points[t[2]];
    m.area += 0.5 * norm(cross(b - a, c - a));
    m.volume += dot(a - Point{}, cross(b - Point{}, c - Point{})) / 6.0;
    for (int k = 0; k < 3; ++k) {
      const Point &p = facets.points[t[static_cast<std::size_t>(k)]], &q = facets.points[t[static_cast<std::size_t>((k + 1) % 3)]];
      const std::array<double, 3> from{p.x, p.y, p.z}, to{q.x, q.y, q.z};
      const auto& low = std::min(from, to);
      const auto& high = std::max(from, to);
      ++edges[{low[0], low[1], low[2], high[0], high[1], high[2]}];
    }
  }
  for (const auto& [locations, n] : edges) m.n_open += n != 2;
  return m;
}

TEST(ModelFacets, OfABoxAreItsSides) {
  const ModelFacets facets = facets_of(make_box("box", Point{1, 2, 3}, Point{2, 4, 6}), {}, RunContext());
  const FacetMeasures m = measures_of(facets);
  EXPECT_NEAR(m.area, 22.0, 1e-12);
  EXPECT_NEAR(m.volume, 6.0, 1e-12);
  EXPECT_EQ(m.n_open, 0u);
  EXPECT_EQ(facets.triangles.size(), 12u);
  EXPECT_TRUE(facets.untrimmed.empty());
}

TEST(ModelFacets, OfACylinderAreNearIt) {
  const ModelFacets facets = facets_of(make_cylinder("rod", Point{0, 0, 0}, Point{4, 0, 0}, 0.5), {.with_curvature = true}, RunContext());
  const FacetMeasures m = measures_of(facets);
  EXPECT_NEAR(m.volume, std::numbers::pi, 0.01);
  EXPECT_LT(m.volume, std::numbers::pi);
  EXPECT_EQ(m.n_open, 0u);
  ASSERT_EQ(facets.curvature.size(), facets.triangles.size());
  double largest = 0.0, least = 1e9;
  for (const double curvature : facets.curvature) {
    largest = std::max(largest, curvature);
    least = std::min(least, curvature);
  }
  EXPECT_NEAR(largest, 2.0, 1e-9);  // 1 / radius
  EXPECT_NEAR(least, 0.0, 1e-9);    // at its ends
}

TEST(ModelFacets, OfACpacsAircraftHaveItsArea) {
  STERNA_NEEDS_SHARED_DATA();
  for (const char* name : {"cpacs/d150.xml", "cpacs/simpletest.cpacs.xml", "cpacs/nacelles.xml"}) {
    const std::string file = (test::shared_data() / name).string();
    const scripting::ModelValue value = scripting::read_model({file, file}, {}, RunContext());
    const scripting::ModelReport report = scripting::measure_model(value, RunContext());
    const ModelFacets facets = facets_of(value.model, {}, RunContext());
    const FacetMeasures m = measures_of(facets);
    EXPECT_NEAR(m.area, report.total.area, 2e-3 * report.total.area) << name;
    EXPECT_LT(static_cast<double>(m.n_open), 0.01 * static_cast<double>(facets.triangles.size())) << name;
    EXPECT_TRUE(facets.untrimmed.empty()) << name;
    const ModelFacets again = facets_of(value.model, {}, RunContext({.threads = 1}));
    EXPECT_EQ(again.points, facets.points);
    EXPECT_EQ(again.triangles, facets.triangles);
  }
}

}  // namespace
}  // namespace sterna
