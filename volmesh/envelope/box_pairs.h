// Finds overlapping pairs of boxes that move in small steps. The topology of the hierarchy is fixed, and boxes are refitted. A search visits only pairs with
// relevant roles. It descends two hierarchies together, or one hierarchy against itself.
#pragma once

#include <array>
#include <cstdint>
#include <limits>
#include <span>
#include <vector>

#include "geom/base/parallel.h"
#include "geom/mesh/tri_mesh.h"

namespace sterna::volmesh {

/// Box in single precision, which halves the memory. Rounding is monotone, so boxes that overlap still overlap after rounding. The box is empty until a point
/// is added.
struct RoundedBox {
  std::array<float, 3> min = {k_far, k_far, k_far};
  std::array<float, 3> max = {-k_far, -k_far, -k_far};

  void add(const Point& p) {
    for (std::size_t k = 0; k < 3; ++k) {
      const float x = static_cast<float>(p[k]);
      min[k] = x < min[k] ? x : min[k];
      max[k] = x > max[k] ? x : max[k];
    }
  }
  void add(const RoundedBox& other) {
    for (std::size_t k = 0; k < 3; ++k) {
      min[k] = other.min[k] < min[k] ? other.min[k] : min[k];
      max[k] = other.max[k] > max[k] ? other.max[k] : max[k];
    }
  }

  static constexpr float k_far = std::numeric_limits<float>::infinity();
};
/// Returns true if two closed boxes overlap. The code has no branches, because the result is hard to predict.
inline bool overlap(const RoundedBox& a, const RoundedBox& b) {
  return ((a.min[0] <= b.max[0]) & (b.min[0] <= a.max[0]) & (a.min[1] <= b.max[1]) & (b.min[1] <= a.max[1]) & (a.min[2] <= b.max[2]) &
          (b.min[2] <= a.max[2])) != 0;
}

/// Topology of a binary hierarchy over the triangles of a mesh. The triangles of a leaf are contiguous.
struct BoxHierarchy {
  struct Node {
    std::uint32_t first = 0;  ///< leaf: first position; inner node: left child, after which the right child follows
    std::uint32_t count = 0;  ///< leaf: number of positions; inner node: 0
  };
  std::vector<Node> nodes;               ///< nodes, root first, children after their parents
  std::vector<std::size_t> level_begin;  ///< nodes of level l: [level_begin[l], level_begin[l + 1])
  std::vector<std::uint32_t> item_at;    ///< triangle at each position

  BoxHierarchy() = default;
  BoxHierarchy(const TriMesh& mesh, const RunContext& context);
};

/// Role of an item in a search. A pair is tested if one item is a seeker and the other a partner.
using Role = std::uint8_t;
inline constexpr Role k_no_role = 0, k_seeker = 1, k_partner = 2, k_both_roles = 3;
inline bool is_needed(Role a, Role b) { return (((a & k_seeker) && (b & k_partner)) || ((a & k_partner) && (b & k_seeker))); }

/// Boxes of the positions and nodes of a hierarchy, and their roles in the next search. There is either one common role, or one role for each position and
/// node.
struct FittedBoxes {
  std::vector<RoundedBox> location, node;
  Role common_role = k_no_role;
  std::vector<Role> location_role, node_role;  ///< empty: common_role applies; the role of a node combines the roles of its positions

  /// Computes the boxes of all nodes from the boxes of the positions.
  void fit(const BoxHierarchy& tree, const RunContext& context);
  /// Computes the roles of the nodes from the roles of the positions. With `refit`, also computes the boxes of nodes that have a role.
  void spread_roles(const BoxHierarchy& tree, bool refit, const RunContext& context);

  Role role_of_location(std::size_t i) const { return location_role.empty() ? common_role : location_role[i]; }
  Role role_of_node(std::size_t i) const { return node_role.empty() ? common_role : node_role[i]; }
};

/// Appends items to `found`, in the order of their positions. An item is appended if the union of its boxes in `a` and in `b` overlaps `box`.
void find_overlaps(const BoxHierarchy& tree, const FittedBoxes& a, const FittedBoxes& b, const RoundedBox& box, std::vector<std::uint32_t>& found);

/// One side of a search: a hierarchy with its boxes.
struct SearchSide {
  const BoxHierarchy* tree;
  const FittedBoxes* boxes;
};

namespace detail {

using NodePair = std::array<std::uint32_t, 2>;
/// Returns pairs of nodes that together cover the whole search. Each pair is a task; the number of tasks does not depend on the number of threads.
std::vector<NodePair> split_search(const SearchSide& a, const SearchSide& b);
/// Returns false if the pair of nodes contains no pair of positions to test.
inline bool is_worthwhile(const SearchSide& a, const SearchSide& b, const NodePair& pair) {
  return is_needed(a.boxes->role_of_node(pair[0]), b.boxes->role_of_node(pair[1])) && overlap(a.boxes->node[pair[0]], b.boxes->node[pair[1]]);
}
/// Appends the pairs of children into which a pair is split. Returns false if both nodes are leaves.
inline bool split_pair(const SearchSide& a, const SearchSide& b, const NodePair& pair, std::vector<NodePair>& children) {
  const auto [first_a, count_a] = a.tree->nodes[pair[0]];
  const auto [first_b, count_b] = b.tree->nodes[pair[1]];
  if (count_a > 0 && count_b > 0) return false;
  if (a.boxes == b.boxes && pair[0] == pair[1]) {
    children.insert(children.end(), {{first_a, first_a}, {first_a, first_a + 1}, {first_a + 1, first_a + 1}});
    return true;
  }
  const std::uint32_t n_a = count_a > 0 ? 1 : 2, n_b = count_b > 0 ? 1 : 2;
  for (std::uint32_t i = 0; i < n_a; ++i)
    for (std::uint32_t j = 0; j < n_b; ++j) children.push_back({count_a > 0 ? pair[0] : first_a + i, count_b > 0 ? pair[1] : first_b + j});
  return true;
}

}  // namespace detail

/// Calls test(item_a, item_b, partial) once for every pair with matching roles and overlapping boxes. If a and b are the same boxes, an item is also paired
/// with itself. There is one Partial per task. Returns all partial results, joined by Partial::append in an order that does not depend on the number of
/// threads. Parallel.
template <class Partial, class Test>
Partial search_pairs(const SearchSide& a, const SearchSide& b, const Test& test, const RunContext& context) {
  const std::vector<detail::NodePair> tasks = detail::split_search(a, b);
  const bool is_same = a.boxes == b.boxes;
  const auto visit_leaves = [&](const detail::NodePair& pair, Partial& partial) {
    const auto [first_a, count_a] = a.tree->nodes[pair[0]];
    const auto [first_b, count_b] = b.tree->nodes[pair[1]];
    const bool is_diagonal = is_same && pair[0] == pair[1];
    for (std::uint32_t i = first_a; i < first_a + count_a; ++i) {
      const Role role = a.boxes->role_of_location(i);
      for (std::uint32_t j = is_diagonal ? i : first_b; j < first_b + count_b; ++j) {
        if (is_needed(role, b.boxes->role_of_location(j)) && overlap(a.boxes->location[i], b.boxes->location[j]))
          test(a.tree->item_at[i], b.tree->item_at[j], partial);
      }
    }
  };
  return parallel_reduce(
      context, tasks.size(), Partial{},
      [&](std::size_t begin, std::size_t end) {
        Partial partial;
        std::vector<detail::NodePair> stack;
        for (std::size_t task = begin; task < end; ++task) {
          stack.push_back(tasks[task]);
          while (!stack.empty()) {
            const detail::NodePair pair = stack.back();
            stack.pop_back();
            if (!detail::is_worthwhile(a, b, pair)) continue;
            if (!detail::split_pair(a, b, pair, stack)) visit_leaves(pair, partial);
          }
        }
        return partial;
      },
      [](Partial all, Partial more) {
        all.append(std::move(more));
        return all;
      },
      1);
}

}  // namespace sterna::volmesh
