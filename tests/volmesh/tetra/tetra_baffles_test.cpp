#include <gmock/gmock.h>

#include <cmath>

#include "geom/mesh/tri_mesh.h"
#include "tests/support/test_shapes.h"
#include "tests/volmesh/tetra/cases.h"
#include "volmesh/tetra/size_field.h"
#include "volmesh/tetra/tetra_baffles.h"

namespace sterna::volmesh {
namespace {

using test::Domain;
using test::domain_around;
using testing::HasSubstr;

/// Adds both sides of a flat baffle of n x n squares with the given corner and side vectors; the nodes of its border are shared.
void add_sheet(Domain& domain, const Vec3& corner, const Vec3& u, const Vec3& v, unsigned n) {
  std::vector<std::array<std::uint32_t, 2>> nodes;
  for (unsigned i = 0; i <= n; ++i)
    for (unsigned j = 0; j <= n; ++j) {
      const bool is_border = i == 0 || j == 0 || i == n || j == n;
      const Vec3 p = corner + (static_cast<double>(i) / n) * u + (static_cast<double>(j) / n) * v;
      const auto front = static_cast<std::uint32_t>(domain.points.size());
      domain.points.push_back(p);
      if (!is_border) domain.points.push_back(p);
      nodes.push_back({front, is_border ? front : front + 1});
    }
  std::vector<std::array<std::uint32_t, 3>> squares;
  for (unsigned i = 0; i < n; ++i)
    for (unsigned j = 0; j < n; ++j) {
      const unsigned a = i * (n + 1) + j, b = a + n + 1, c = b + 1, d = a + 1;
      // The diagonal goes through an inner node, so that no triangle has all corners on the rim.
      const bool is_other = (i == 0 && j == 0) || (i + 1 == n && j + 1 == n) ? false : (i == 0 && j + 1 == n) || (i + 1 == n && j == 0);
      if (is_other) squares.insert(squares.end(), {{a, b, d}, {b, c, d}});
      else squares.insert(squares.end(), {{a, b, c}, {a, c, d}});
    }
  // Corner squares: the diagonal from the outer corner goes to an inner node.
  for (const std::size_t side : {std::size_t{0}, std::size_t{1}})
    for (const auto& t : squares) {
      if (side == 0) domain.triangles.push_back({nodes[t[0]][0], nodes[t[1]][0], nodes[t[2]][0]});
      else domain.triangles.push_back({nodes[t[0]][1], nodes[t[2]][1], nodes[t[1]][1]});
    }
}

class FillSheetsWith : public testing::TestWithParam<std::string> {};
INSTANTIATE_TEST_SUITE_P(Engine, FillSheetsWith, testing::Values("tetgen", "hxt", "sterna"), [](const auto& test) { return test.param; });

TEST_P(FillSheetsWith, FillsBothSidesOfAFreeSheet) {
  for (const unsigned n : {2u, 3u, 8u}) {
    SCOPED_TRACE(n);
    Domain domain = domain_around(test::cube(3));
    add_sheet(domain, {1.4, -0.3, -0.4}, {0.1, 1.5, 0.0}, {0.2, 0.0, 1.6}, n);
    TetraBoundary boundary = domain.boundary();
    boundary.traits.has_baffles = true;
    const SizeField sizes = build_size_field(domain.boundary(), {}, {}, RunContext{});
    const TetraResult result = fill(boundary, GetParam() == "sterna" ? &sizes : nullptr, {.engine = GetParam(), .try_other_engine = false}, RunContext{});
    EXPECT_EQ(result.engine, GetParam());
    test::expect_tiling(domain, result);
  }
}

}  // namespace
}  // namespace sterna::volmesh
