// Node numbering: growth lines stay consecutive, neighbours get close numbers, the mesh is unchanged.
#include "geom/mesh/numbering.h"

#include <gmock/gmock.h>

#include <algorithm>
#include <numeric>

#include "geom/mesh/check.h"
#include "tests/support/error_of.h"
#include "tests/support/hybrid_shapes.h"

namespace sterna {
namespace {

/// Returns a chain whose numbers jump.
NeighbourGraph shuffled_chain(std::uint32_t n) {
  std::vector<std::uint32_t> location(n);
  for (std::uint32_t i = 0; i < n; ++i) location[i] = (i * 37) % n;  // 37 and n have no common divisor
  std::vector<std::vector<std::uint32_t>> of(n);
  for (std::uint32_t i = 0; i + 1 < n; ++i) {
    of[location[i]].push_back(location[i + 1]);
    of[location[i + 1]].push_back(location[i]);
  }
  NeighbourGraph graph;
  for (auto& neighbours : of) {
    std::ranges::sort(neighbours);
    graph.neighbours.insert(graph.neighbours.end(), neighbours.begin(), neighbours.end());
    graph.first.push_back(graph.neighbours.size());
  }
  return graph;
}

TEST(Numbering, AChainGetsABandwidthOfOne) {
  const NeighbourGraph graph = shuffled_chain(100);
  EXPECT_GT(measure_numbering(graph).bandwidth, 30u);
  const std::vector<std::uint32_t> order = bandwidth_order(graph);
  std::vector<std::uint32_t> new_number(order.size());
  for (std::uint32_t i = 0; i < order.size(); ++i) new_number[order[i]] = i;
  EXPECT_EQ(measure_numbering(graph, new_number).bandwidth, 1u);
  EXPECT_NEAR(measure_numbering(graph, new_number).mean_profile, 0.99, 1e-12);
  EXPECT_TRUE(bandwidth_order(NeighbourGraph{}).empty());
}

/// Requirement of line-implicit solvers: the nodes of a growth line are consecutive in the file, starting at the wall, in any order of the growth lines.
TEST(Numbering, LinesStayConsecutiveAndNeighboursComeNear) {
  const HybridMesh mesh = test::sphere_shell(6, {.n_layers = 5, .collapsed = {3, 50, 51}});
  const RunContext context({.threads = 2});
  const HybridMesh both = renumbered(mesh, Numbering::both, context), plain = renumbered(mesh, Numbering::bandwidth, context);
  ASSERT_EQ(both.layers.n_lines(), mesh.layers.n_lines());
  EXPECT_TRUE(std::ranges::is_sorted(both.layers.first_node));
  std::vector<std::uint8_t> is_met(both.points.size(), 0);
  for (std::uint32_t line = 0; line < both.layers.n_lines(); ++line)
    for (int j = 0; j <= both.layers.n_steps(line); ++j) {
      EXPECT_EQ(both.layers.node(line, j).value(), both.layers.first_node[line] + static_cast<std::uint32_t>(j));
      EXPECT_EQ(is_met[both.layers.node(line, j).index()]++, 0);
    }
  // The points along each growth line are those of a growth line of the input mesh, in the same order.
  const auto lines_of = [](const HybridMesh& m) {
    std::vector<std::vector<std::array<double, 3>>> all;
    for (std::uint32_t line = 0; line < m.layers.n_lines(); ++line) {
      std::vector<std::array<double, 3>> points;
      for (int j = 0; j <= m.layers.n_steps(line); ++j) {
        const Point& p = m.points[m.layers.node(line, j)];
        points.push_back({p.x, p.y, p.z});
      }
      all.push_back(points);
    }
    std::ranges::sort(all);
    return all;
  };
  EXPECT_EQ(lines_of(both), lines_of(mesh));
  for (const HybridMesh* m : {&both, &plain}) {
    EXPECT_TRUE(check(*m, {}, context).is_valid());
    EXPECT_EQ(count_cells(*m).total(), count_cells(mesh).total());
  }
  EXPECT_EQ(plain.layers.n_columns(), 0u);
  const NumberingMeasure before = measure_numbering(node_graph(mesh, context)), with_lines = measure_numbering(node_graph(both, context)),
                         without = measure_numbering(node_graph(plain, context));
  EXPECT_LT(with_lines.bandwidth, before.bandwidth);
  EXPECT_LT(with_lines.mean_profile, before.mean_profile);
  EXPECT_LT(without.mean_profile, before.mean_profile);
}

TEST(Numbering, ThreadsChangeNothing) {
  const HybridMesh mesh = test::stepped_sphere_shell(6, {.n_layers = 5, .collapsed = {3, 50, 51}});
  const HybridMesh one = renumbered(mesh, Numbering::both, RunContext({.threads = 1}));
  for (const int threads : {2, 7}) {
    const HybridMesh many = renumbered(mesh, Numbering::both, RunContext({.threads = threads}));
    EXPECT_EQ(many.points, one.points);
    EXPECT_EQ(many.layers.base, one.layers.base);
    EXPECT_EQ(many.tetrahedra, one.tetrahedra);
  }
  EXPECT_EQ(renumbered(mesh, Numbering::lines, RunContext()).points, mesh.points);
  test::expect_error(ErrorCode::bad_argument, "lines, bandwidth or both", [] { (void)numbering_of("random"); });
}

}  // namespace
}  // namespace sterna
