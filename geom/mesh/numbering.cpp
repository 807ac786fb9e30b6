// Steps of renumbered(): the graph of lines and free nodes (nodes of a line are one vertex), its order, numbers of nodes, everything sorted by them.
#include "geom/mesh/numbering.h"

#include <algorithm>
#include <array>
#include <limits>
#include <numeric>
#include <span>
#include <string>
#include <utility>

#include "geom/base/error.h"
#include "geom/base/parallel.h"

namespace sterna {
namespace {

constexpr std::uint32_t k_not_yet = std::numeric_limits<std::uint32_t>::max();
constexpr int k_most_restarts = 8;  ///< of the search for an end; it ends by itself after 2 to 4

/// Calls f(nodes) for every explicit cell.
template <class F>
void for_each_explicit_cell(const HybridMesh& mesh, const F& f) {
  const auto block = [&](const auto& cells) {
    for (const auto& nodes : cells) f(std::span<const NodeId>(nodes));
  };
  block(mesh.prisms);
  block(mesh.pyramids);
  block(mesh.hexahedra);
  block(mesh.tetrahedra);
}

/// The graph of the vertices that share one of the groups f is called with: add(span of vertices).
template <class ForEachGroup>
NeighbourGraph graph_of_groups(std::size_t n_vertices, const ForEachGroup& for_each_group, const RunContext& context) {
  // Groups of each vertex, then its neighbours out of them.
  std::vector<std::uint64_t> first_group = {0};
  std::vector<std::uint32_t> members;
  std::vector<std::uint64_t> end_of(n_vertices + 1, 0);
  for_each_group([&](std::span<const std::uint32_t> group) {
    members.insert(members.end(), group.begin(), group.end());
    first_group.push_back(members.size());
    for (const std::uint32_t v : group) ++end_of[v + 1];
  });
  for (std::size_t v = 0; v < n_vertices; ++v) end_of[v + 1] += end_of[v];
  std::vector<std::uint32_t> groups(members.size());
  for (std::size_t g = 0; g + 1 < first_group.size(); ++g)
    for (std::uint64_t i = first_group[g]; i < first_group[g + 1]; ++i) groups[end_of[members[i]]++] = static_cast<std::uint32_t>(g);
  NeighbourGraph graph;
  graph.first.assign(n_vertices + 1, 0);
  const auto gather = [&](std::size_t v, std::vector<std::uint32_t>& found) {
    found.clear();
    for (std::uint64_t i = v == 0 ? 0 : end_of[v - 1]; i < end_of[v]; ++i)
      for (std::uint64_t k = first_group[groups[i]]; k < first_group[groups[i] + 1]; ++k)
        if (members[k] != v) found.push_back(members[k]);
    std::sort(found.begin(), found.end());
    found.erase(std::unique(found.begin(), found.end()), found.end());
  };
  parallel_chunks(context, n_vertices, k_default_chunk, [&](std::size_t begin, std::size_t end) {
    std::vector<std::uint32_t> found;
    for (std::size_t v = begin; v < end; ++v) {
      gather(v, found);
      graph.first[v + 1] = found.size();
    }
  });
  for (std::size_t v = 0; v < n_vertices; ++v) graph.first[v + 1] += graph.first[v];
  graph.neighbours.resize(graph.first.back());
  parallel_chunks(context, n_vertices, k_default_chunk, [&](std::size_t begin, std::size_t end) {
    std::vector<std::uint32_t> found;
    for (std::size_t v = begin; v < end; ++v) {
      gather(v, found);
      std::copy(found.begin(), found.end(), graph.neighbours.begin() + static_cast<std::ptrdiff_t>(graph.first[v]));
    }
  });
  return graph;
}

class LevelOrder {
 public:
  explicit LevelOrder(const NeighbourGraph& graph) : graph_(graph), level_(graph.size(), k_not_yet) { order_.reserve(graph.size()); }

  std::vector<std::uint32_t> run() {
    std::vector<std::uint32_t> by_degree(graph_.size());
    std::iota(by_degree.begin(), by_degree.end(), 0u);
    std::ranges::stable_sort(by_degree, {}, [&](std::uint32_t v) { return degree(v); });
    for (const std::uint32_t start : by_degree)
      if (level_[start] == k_not_yet) add_component(start);
    std::ranges::reverse(order_);
    return std::move(order_);
  }

 private:
  std::uint64_t degree(std::uint32_t v) const { return graph_.first[v + 1] - graph_.first[v]; }

  /// Orders what can be reached from `start`, behind what is ordered already. \returns the number of levels
  std::uint32_t visit(std::uint32_t start) {
    std::vector<std::uint32_t> fresh;
    const std::size_t begin = order_.size();
    level_[start] = 0;
    order_.push_back(start);
    for (std::size_t i = begin; i < order_.size(); ++i) {
      const std::uint32_t v = order_[i];
      fresh.clear();
      for (std::uint64_t k = graph_.first[v]; k < graph_.first[v + 1]; ++k) {
        const std::uint32_t other = graph_.neighbours[k];
        if (level_[other] != k_not_yet) continue;
        level_[other] = level_[v] + 1;
        fresh.push_back(other);
      }
      std::sort(fresh.begin(), fresh.end(), [&](std::uint32_t a, std::uint32_t b) { return degree(a) != degree(b) ? degree(a) < degree(b) : a < b; });
      order_.insert(order_.end(), fresh.begin(), fresh.end());
    }
    return level_[order_.back()] + 1;
  }

  void forget_from(std::size_t begin) {
    for (std::size_t i = begin; i < order_.size(); ++i) level_[order_[i]] = k_not_yet;
    order_.resize(begin);
  }

  void add_component(std::uint32_t start) {
    const std::size_t begin = order_.size();
    std::uint32_t n_levels = visit(start);
    for (int i = 0; i < k_most_restarts; ++i) {
      // The vertex of the last level with the fewest neighbours is nearer to an end.
      const std::uint32_t last = level_[order_.back()];
      std::uint32_t next = order_.back();
      for (std::size_t k = order_.size(); k-- > begin && level_[order_[k]] == last;)
        if (std::pair(degree(order_[k]), order_[k]) < std::pair(degree(next), next)) next = order_[k];
      forget_from(begin);
      const std::uint32_t n = visit(next);
      if (n <= n_levels) return;
      n_levels = n;
    }
  }

  const NeighbourGraph& graph_;
  std::vector<std::uint32_t> level_, order_;
};

/// Lines and the nodes that belong to none, as vertices of one graph: lines first.
struct LineVertices {
  std::vector<std::uint32_t> of_node;
  std::vector<std::uint32_t> free_nodes;
  std::size_t n_lines = 0;

  explicit LineVertices(const HybridMesh& mesh) : of_node(mesh.points.size(), k_not_yet), n_lines(mesh.layers.n_lines()) {
    for (std::uint32_t line = 0; line < n_lines; ++line)
      for (int j = 0; j <= mesh.layers.n_steps(line); ++j) of_node[mesh.layers.first_node[line] + static_cast<std::uint32_t>(j)] = line;
    for (std::uint32_t node = 0; node < of_node.size(); ++node) {
      if (of_node[node] != k_not_yet) continue;
      of_node[node] = static_cast<std::uint32_t>(n_lines + free_nodes.size());
      free_nodes.push_back(node);
    }
  }
  std::size_t size() const { return n_lines + free_nodes.size(); }
};

NeighbourGraph line_graph(const HybridMesh& mesh, const LineVertices& vertices, const RunContext& context) {
  return graph_of_groups(
      vertices.size(),
      [&](const auto& add) {
        for (const auto& base : mesh.layers.base) add(std::span<const std::uint32_t>(base));
        std::vector<std::uint32_t> group;
        for_each_explicit_cell(mesh, [&](std::span<const NodeId> nodes) {
          group.clear();
          for (const NodeId node : nodes) group.push_back(vertices.of_node[node.index()]);
          add(std::span<const std::uint32_t>(group));
        });
      },
      context);
}

/// The items with their nodes renumbered, sorted by their nodes, the lowest first.
template <class Items, class NodesOf>
void renumber_and_sort(Items& items, const std::vector<std::uint32_t>& new_number, const NodesOf& nodes_of) {
  struct Keyed {
    std::array<std::uint32_t, 8> key;
    std::uint32_t item;
    bool operator<(const Keyed& other) const { return key != other.key ? key < other.key : item < other.item; }
  };
  std::vector<Keyed> keys(items.size());
  for (std::size_t i = 0; i < items.size(); ++i) {
    std::array<std::uint32_t, 8> key;
    key.fill(k_not_yet);
    std::size_t n = 0;
    for (NodeId& node : nodes_of(items[i])) {
      node = NodeId(new_number[node.index()]);
      key[n++] = node.value();
    }
    std::sort(key.begin(), key.begin() + static_cast<std::ptrdiff_t>(n));
    keys[i] = {key, static_cast<std::uint32_t>(i)};
  }
  std::sort(keys.begin(), keys.end());
  Items sorted;
  sorted.reserve(items.size());
  for (const Keyed& k : keys) sorted.push_back(items[k.item]);
  items = std::move(sorted);
}

template <class T>
std::vector<T> permuted(const std::vector<T>& values, const std::vector<std::uint32_t>& old_of_new) {
  std::vector<T> result;
  if (values.empty()) return result;
  result.reserve(old_of_new.size());
  for (const std::uint32_t old : old_of_new) result.push_back(values[old]);
  return result;
}

void reorder_layers(HybridMesh& mesh, const std::vector<std::uint32_t>& old_lines, const std::vector<std::uint32_t>& new_number) {
  LayerBlock& layers = mesh.layers;
  std::vector<std::uint32_t> new_line(old_lines.size());
  for (std::uint32_t i = 0; i < old_lines.size(); ++i) new_line[old_lines[i]] = i;
  layers.first_node = permuted(layers.first_node, old_lines);
  for (std::uint32_t& node : layers.first_node) node = new_number[node];
  layers.line_layers = permuted(layers.line_layers, old_lines);
  layers.is_collapsed = permuted(layers.is_collapsed, old_lines);
  std::apply([&](auto&... columns) { ((columns = permuted(columns, old_lines)), ...); }, columns_of(mesh.request));
  for (auto& base : layers.base)
    for (std::uint32_t& line : base) line = new_line[line];
  std::ranges::stable_sort(layers.base, {}, [](const std::array<std::uint32_t, 3>& base) {
    std::array<std::uint32_t, 3> key = base;
    std::ranges::sort(key);
    return key;
  });
}

}  // namespace

Numbering numbering_of(std::string_view name) {
  if (name == "lines") return Numbering::lines;
  if (name == "bandwidth") return Numbering::bandwidth;
  if (name == "both") return Numbering::both;
  throw Error({.code = ErrorCode::bad_argument, .attempted = "numbering", .problem = "there is no \"" + std::string(name) + "\": lines, bandwidth or both"});
}

std::vector<std::uint32_t> bandwidth_order(const NeighbourGraph& graph) { return LevelOrder(graph).run(); }

NumberingMeasure measure_numbering(const NeighbourGraph& graph, const std::vector<std::uint32_t>& new_number) {
  NumberingMeasure measure;
  double profile = 0.0;
  const auto number = [&](std::uint32_t v) { return new_number.empty() ? v : new_number[v]; };
  for (std::uint32_t v = 0; v < graph.size(); ++v) {
    std::uint32_t lowest = number(v);
    for (std::uint64_t k = graph.first[v]; k < graph.first[v + 1]; ++k) lowest = std::min(lowest, number(graph.neighbours[k]));
    measure.bandwidth = std::max<std::uint64_t>(measure.bandwidth, number(v) - lowest);
    profile += number(v) - lowest;
  }
  if (graph.size() > 0) measure.mean_profile = profile / static_cast<double>(graph.size());
  return measure;
}

NeighbourGraph node_graph(const HybridMesh& mesh, const RunContext& context) {
  return graph_of_groups(
      mesh.points.size(),
      [&](const auto& add) {
        const LayerBlock& layers = mesh.layers;
        std::array<std::uint32_t, 3> group;
        for (const auto& base : layers.base) {
          for (int j = 0; j <= layers.n_layers; ++j) {
            std::size_t n = 0;
            for (const std::uint32_t line : base)
              if (j <= layers.n_steps(line)) group[n++] = layers.node(line, j).value();
            add(std::span<const std::uint32_t>(group.data(), n));
          }
        }
        for (std::uint32_t line = 0; line < layers.n_lines(); ++line)
          for (int j = 0; j < layers.n_steps(line); ++j)
            add(std::span<const std::uint32_t>(std::array<std::uint32_t, 2>{layers.node(line, j).value(), layers.node(line, j + 1).value()}));
        std::vector<std::uint32_t> cell;
        for_each_explicit_cell(mesh, [&](std::span<const NodeId> nodes) {
          cell.clear();
          for (const NodeId node : nodes) cell.push_back(node.value());
          add(std::span<const std::uint32_t>(cell));
        });
      },
      context);
}

HybridMesh renumbered(const HybridMesh& mesh, Numbering numbering, const RunContext& context) {
  if (numbering == Numbering::lines) return mesh;
  HybridMesh result = numbering == Numbering::bandwidth ? explicit_cells(mesh) : mesh;
  const LineVertices vertices(result);
  const std::vector<std::uint32_t> order = bandwidth_order(line_graph(result, vertices, context));
  std::vector<std::uint32_t> new_number(result.points.size()), old_lines;
  std::uint32_t next = 0;
  for (const std::uint32_t v : order) {
    if (v < vertices.n_lines) {
      old_lines.push_back(v);
      for (int j = 0; j <= result.layers.n_steps(v); ++j) new_number[result.layers.first_node[v] + static_cast<std::uint32_t>(j)] = next++;
    } else {
      new_number[vertices.free_nodes[v - vertices.n_lines]] = next++;
    }
  }
  Column<NodeId, Point> points(result.points.size());
  for (std::size_t i = 0; i < new_number.size(); ++i) points[NodeId(new_number[i])] = result.points.raw()[i];
  result.points = std::move(points);
  reorder_layers(result, old_lines, new_number);
  const auto itself = [](auto& nodes) -> auto& { return nodes; };
  const auto of_face = [](auto& face) -> auto& { return face.nodes; };
  renumber_and_sort(result.prisms, new_number, itself);
  renumber_and_sort(result.pyramids, new_number, itself);
  renumber_and_sort(result.hexahedra, new_number, itself);
  renumber_and_sort(result.tetrahedra, new_number, itself);
  renumber_and_sort(result.boundary_triangles, new_number, of_face);
  renumber_and_sort(result.boundary_quads, new_number, of_face);
  return result;
}

}  // namespace sterna
