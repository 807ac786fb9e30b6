#include "surfmesh/model/size_graph.h"

#include <algorithm>
#include <cmath>
#include <queue>

namespace sterna::surfmesh {
namespace {

/// Sine of the angle between a straight path and the surface at its end. Paths with a larger sine do not count as paths along the surface. An arc with this
/// angle at both ends is 0.7 % longer than its chord.
constexpr double k_plain_sine = 0.2;
/// A path may deviate by 60 degrees from its straight line at a node. Less would suffice, because the grid has a neighbour within 35 degrees of every
/// direction.
constexpr double k_forward_cosine = 0.5;
/// Relative to a size: smaller gains do not justify another round.
constexpr double k_least_gain = 1e-9;

/// Location from which the size of a node comes.
struct Origin {
  Point point;
  double size = 0.0;
};

struct Carrier {
  SizeGraph& graph;
  double growth;
  std::vector<Origin> origins;
  std::vector<std::uint32_t> node_ends, node_cells;  ///< cells that contain each node

  Carrier(SizeGraph& g, double change) : graph(g), growth(change) {
    for (std::size_t i = 0; i < g.points.size(); ++i) origins.push_back({g.points[i], g.sizes[i]});
    node_ends.assign(g.points.size(), 0);
    for (const std::uint32_t n : g.cell_nodes) ++node_ends[n];
    std::uint32_t sum = 0;
    for (std::uint32_t& end : node_ends) end = sum += end;
    node_cells.resize(sum);
    // The list is filled from the back, so that the ends become starts. They are moved back afterwards.
    for (std::size_t c = g.cell_ends.size(); c-- > 0;)
      for (std::uint32_t k = g.cell_ends[c]; k-- > begin_of(c);) node_cells[--node_ends[g.cell_nodes[k]]] = static_cast<std::uint32_t>(c);
  }
  std::uint32_t begin_of(std::size_t cell) const { return cell == 0 ? 0 : graph.cell_ends[cell - 1]; }

  /// \pre node_ends holds the starts.
  template <class Visit>
  void for_neighbours(std::uint32_t node, const Visit& visit) const {
    const std::uint32_t end = node + 1 < node_ends.size() ? node_ends[node + 1] : static_cast<std::uint32_t>(node_cells.size());
    for (std::uint32_t i = node_ends[node]; i < end; ++i)
      for (std::uint32_t k = begin_of(node_cells[i]); k < graph.cell_ends[node_cells[i]]; ++k)
        if (graph.cell_nodes[k] != node) visit(graph.cell_nodes[k]);
  }

  bool is_straight(std::uint32_t from, std::uint32_t to, const Vec3& ray, double length) const {
    const auto& [a, b] = graph.normals[to];
    if (std::min(std::abs(dot(ray, a)), std::abs(dot(ray, b))) > k_plain_sine * length) return false;
    const Vec3 step = graph.points[to] - graph.points[from], back = graph.points[from] - origins[from].point;
    const double step2 = norm2(step), back2 = norm2(back);
    if (back2 <= step2) return true;
    const double forward = dot(step, back);
    return forward > 0.0 && forward * forward >= k_forward_cosine * k_forward_cosine * step2 * back2;
  }
  /// Propagates the size of `from`; returns true if the size of `to` is reduced.
  bool relax(std::uint32_t from, std::uint32_t to) {
    // The straight step cannot gain more than this, so longer paths from here are not tested.
    const double most = graph.sizes[to] * (1.0 - k_least_gain);
    if (graph.sizes[from] >= most) return false;
    const Vec3 ray = graph.points[to] - origins[from].point;
    const double length = norm(ray);
    double size = origins[from].size + growth * length;
    if (size >= most) return false;
    if (is_straight(from, to, ray, length)) {
      origins[to] = origins[from];
    } else {
      size = graph.sizes[from] + growth * distance(graph.points[from], graph.points[to]);
      if (size >= most) return false;
      origins[to] = {graph.points[from], graph.sizes[from]};
    }
    graph.sizes[to] = size;
    return true;
  }

  void run() {
    struct Entry {
      double size;
      std::uint32_t node;
      bool operator>(const Entry& o) const { return size != o.size ? size > o.size : node > o.node; }
    };
    std::vector<Entry> first;
    for (std::uint32_t n = 0; n < graph.points.size(); ++n) {
      if (graph.is_passing[n] == 0) continue;
      bool has_gain = false;
      for_neighbours(n, [&](std::uint32_t m) {
        has_gain = has_gain || graph.sizes[n] + growth * distance(graph.points[n], graph.points[m]) < graph.sizes[m] * (1.0 - k_least_gain);
      });
      if (has_gain) first.push_back({graph.sizes[n], n});
    }
    std::priority_queue<Entry, std::vector<Entry>, std::greater<>> queue(std::greater<>{}, std::move(first));
    while (!queue.empty()) {
      const Entry entry = queue.top();
      queue.pop();
      if (entry.size != graph.sizes[entry.node]) continue;
      for_neighbours(entry.node, [&](std::uint32_t m) {
        if (relax(entry.node, m) && graph.is_passing[m] != 0) queue.push({graph.sizes[m], m});
      });
    }
  }
};

}  // namespace

std::uint32_t SizeGraph::add_node(const Point& point, const std::array<Vec3, 2>& sides, double size, bool passes) {
  points.push_back(point);
  normals.push_back(sides);
  sizes.push_back(size);
  is_passing.push_back(passes ? 1 : 0);
  return static_cast<std::uint32_t>(points.size() - 1);
}

void carry_sizes(SizeGraph& graph, double growth) { Carrier(graph, growth).run(); }

}  // namespace sterna::surfmesh
