// Steps of renumbered(): build the graph of lines and free nodes (the nodes of a line are one vertex), order it, number the nodes, and sort all items by the
// numbers of their nodes.
#include <algorithm>
#include <array>
#include <limits>
#include <span>
#include <tuple>
#include <utility>

#include "geom/base/parallel.h"
#include "geom/mesh/layer_lines.h"
#include "geom/mesh/numbering.h"

namespace sterna {
namespace {

constexpr std::uint32_t k_no_number = std::numeric_limits<std::uint32_t>::max();

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

/// Returns the graph of vertices that share a group; for_each_group calls add(span of vertices) for each group.
template <class ForEachGroup>
NeighbourGraph graph_of_groups(std::size_t n_vertices, const ForEachGroup& for_each_group, const RunContext& context) {
  // Collects the groups of each vertex, then its neighbours from these groups.
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

/// Wall-normal growth lines, each as its nodes from the wall up. They are the lines of the columns, or in a mesh without columns those of the stacks of prisms
/// on its walls. No node is on two lines.
struct NodeLines {
  std::vector<std::uint32_t> first = {0};
  std::vector<std::uint32_t> nodes;
  std::size_t size() const { return first.size() - 1; }
  std::span<const std::uint32_t> of(std::size_t line) const { return std::span(nodes).subspan(first[line], first[line + 1] - first[line]); }

  NodeLines() = default;
  NodeLines(const HybridMesh& mesh, const RunContext& context) {
    if (mesh.layers.n_lines() > 0) {
      for (std::uint32_t line = 0; line < mesh.layers.n_lines(); ++line) {
        for (int j = 0; j <= mesh.layers.n_steps(line); ++j) nodes.push_back(mesh.layers.node(line, j).value());
        first.push_back(static_cast<std::uint32_t>(nodes.size()));
      }
    } else if (!mesh.prisms.empty()) {
      find_stacks(mesh, context);
    }
  }

 private:
  void find_stacks(const HybridMesh& mesh, const RunContext& context) {
    const check_parts::CellNumbers cells(mesh);
    const check_parts::FaceSlots slots(mesh, cells, {});
    const check_parts::FaceMatch match =
        check_parts::match_faces(slots, mesh.points.size(), static_cast<std::uint64_t>(CheckOptions{}.faces_at_a_time), {}, false, GateTable{}, context);
    const check_parts::LayerLines lines(mesh, slots, match, context);
    if (!lines.reason().empty()) return;
    std::vector<std::uint8_t> is_taken(mesh.points.size(), 0);
    for (std::uint32_t line = 0; line < lines.n_lines(); ++line) {
      for (int j = 0; j <= lines.n_layers(line); ++j)
        if (const NodeId node = lines.node(line, j); is_taken[node.index()]++ == 0) nodes.push_back(node.value());
      if (nodes.size() > first.back()) first.push_back(static_cast<std::uint32_t>(nodes.size()));
    }
  }
};

/// Lines and the nodes that belong to no line, as vertices of one graph: lines first.
struct LineVertices {
  NodeLines lines;
  std::vector<std::uint32_t> of_node;
  std::vector<std::uint32_t> free_nodes;

  LineVertices(const HybridMesh& mesh, NodeLines given) : lines(std::move(given)), of_node(mesh.points.size(), k_no_number) {
    for (std::uint32_t line = 0; line < lines.size(); ++line)
      for (const std::uint32_t node : lines.of(line)) of_node[node] = line;
    for (std::uint32_t node = 0; node < of_node.size(); ++node) {
      if (of_node[node] != k_no_number) continue;
      of_node[node] = static_cast<std::uint32_t>(lines.size() + free_nodes.size());
      free_nodes.push_back(node);
    }
  }
  std::size_t size() const { return lines.size() + free_nodes.size(); }
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

/// Renumbers the nodes of the items and sorts the items. The sort key is first `rank` of the new numbers, lowest first, then the numbers themselves.
template <class Items, class NodesOf, class Rank>
void renumber_and_sort(Items& items, const std::vector<std::uint32_t>& new_number, const NodesOf& nodes_of, const Rank& rank) {
  struct Keyed {
    std::array<std::uint32_t, 8> key;
    std::uint32_t lowest, item;
    bool operator<(const Keyed& other) const { return std::tie(key, lowest, item) < std::tie(other.key, other.lowest, other.item); }
  };
  std::vector<Keyed> keys(items.size());
  for (std::size_t i = 0; i < items.size(); ++i) {
    std::array<std::uint32_t, 8> key;
    key.fill(k_no_number);
    std::size_t n = 0;
    std::uint32_t lowest = k_no_number;
    for (NodeId& node : nodes_of(items[i])) {
      node = NodeId(new_number[node.index()]);
      lowest = std::min(lowest, node.value());
      key[n++] = rank(node.value());
    }
    std::sort(key.begin(), key.begin() + static_cast<std::ptrdiff_t>(n));
    keys[i] = {key, lowest, static_cast<std::uint32_t>(i)};
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
  const bool has_lines = numbering == Numbering::both;
  HybridMesh result = has_lines ? mesh : explicit_cells(mesh);
  const LineVertices vertices(result, has_lines ? NodeLines(result, context) : NodeLines());
  const std::vector<std::uint32_t> order = bandwidth_order(line_graph(result, vertices, context));
  std::vector<std::uint32_t> new_number(result.points.size()), base_node(result.points.size()), old_lines;
  std::uint32_t next = 0;
  for (const std::uint32_t v : order) {
    const std::uint32_t first = next;
    if (v < vertices.lines.size()) {
      old_lines.push_back(v);
      for (const std::uint32_t node : vertices.lines.of(v)) new_number[node] = next++;
    } else {
      new_number[vertices.free_nodes[v - vertices.lines.size()]] = next++;
    }
    std::fill(base_node.begin() + first, base_node.begin() + next, first);
  }
  Column<NodeId, Point> points(result.points.size());
  for (std::size_t i = 0; i < new_number.size(); ++i) points[NodeId(new_number[i])] = result.points.raw()[i];
  result.points = std::move(points);
  if (result.layers.n_lines() > 0) reorder_layers(result, old_lines, new_number);
  // Prisms are sorted by the lines between which they lie, so that prisms of a stack are consecutive.
  const auto by_line = [&](std::uint32_t node) { return base_node[node]; };
  const auto by_node = [](std::uint32_t node) { return node; };
  const auto itself = [](auto& nodes) -> auto& { return nodes; };
  const auto of_face = [](auto& face) -> auto& { return face.nodes; };
  renumber_and_sort(result.prisms, new_number, itself, by_line);
  renumber_and_sort(result.pyramids, new_number, itself, by_node);
  renumber_and_sort(result.hexahedra, new_number, itself, by_node);
  renumber_and_sort(result.tetrahedra, new_number, itself, by_node);
  renumber_and_sort(result.boundary_triangles, new_number, of_face, by_node);
  renumber_and_sort(result.boundary_quads, new_number, of_face, by_node);
  return result;
}

}  // namespace sterna
