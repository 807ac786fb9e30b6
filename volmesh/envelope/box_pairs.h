// Overlapping pairs of boxes that move a little at a time: the hierarchy keeps its shape, boxes are refitted, and a search visits only pairs of roles that
// matter. Two hierarchies, or one with itself, are descended together.
#pragma once

#include <array>
#include <cstdint>
#include <limits>
#include <span>
#include <vector>

#include "geom/base/parallel.h"
#include "geom/mesh/tri_mesh.h"

namespace sterna::volmesh {

/// Box in single precision, half the memory. Rounding is monotone, so boxes that overlap still do. Empty until something is added.
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
/// Of closed boxes; no branches, the usual answer is unpredictable.
inline bool overlap(const RoundedBox& a, const RoundedBox& b) {
  return ((a.min[0] <= b.max[0]) & (b.min[0] <= a.max[0]) & (a.min[1] <= b.max[1]) & (b.min[1] <= a.max[1]) & (a.min[2] <= b.max[2]) &
          (b.min[2] <= a.max[2])) != 0;
}

/// Shape of a binary hierarchy over the triangles of a mesh: those of a leaf lie together.
struct BoxHierarchy {
  struct Node {
    std::uint32_t first = 0;  ///< leaf: first place; inner: left child, the right one follows
    std::uint32_t count = 0;  ///< leaf: number of places; inner: 0
  };
  std::vector<Node> nodes;               ///< the root first, children after their parents
  std::vector<std::size_t> level_begin;  ///< nodes of level l: [level_begin[l], level_begin[l + 1])
  std::vector<std::uint32_t> item_at;    ///< triangle at each place

  BoxHierarchy() = default;
  BoxHierarchy(const TriMesh& mesh, const RunContext& context);
};

/// What an item may be in a search: a pair is wanted when one is a seeker and the other a partner.
using Role = std::uint8_t;
inline constexpr Role k_no_role = 0, k_seeker = 1, k_partner = 2, k_both_roles = 3;
inline bool is_wanted(Role a, Role b) { return (((a & k_seeker) && (b & k_partner)) || ((a & k_partner) && (b & k_seeker))); }

/// Boxes of a hierarchy's places and nodes, and their roles in the next search: one for all, or one each.
struct FittedBoxes {
  std::vector<RoundedBox> place, node;
  Role common_role = k_no_role;
  std::vector<Role> place_role, node_role;  ///< empty: common_role; of a node: those of its places together

  /// Boxes of all nodes from those of the places.
  void fit(const BoxHierarchy& tree, const RunContext& context);
  /// Roles of the nodes from those of the places; with `refit`, boxes of nodes with a role too.
  void spread_roles(const BoxHierarchy& tree, bool refit, const RunContext& context);

  Role role_of_place(std::size_t i) const { return place_role.empty() ? common_role : place_role[i]; }
  Role role_of_node(std::size_t i) const { return node_role.empty() ? common_role : node_role[i]; }
};

/// Items for which the box around the item's boxes in `a` and in `b` overlaps `box`, in the order of their places, appended to `found`.
void find_overlaps(const BoxHierarchy& tree, const FittedBoxes& a, const FittedBoxes& b, const RoundedBox& box, std::vector<std::uint32_t>& found);

/// One hierarchy with its boxes, as a side of a search.
struct SearchSide {
  const BoxHierarchy* tree;
  const FittedBoxes* boxes;
};

namespace detail {

using NodePair = std::array<std::uint32_t, 2>;
/// Pairs of nodes that make up the whole search, as tasks: a fixed number, whatever the number of threads.
std::vector<NodePair> split_search(const SearchSide& a, const SearchSide& b);
/// False when the pair holds no wanted pair of places.
inline bool is_worthwhile(const SearchSide& a, const SearchSide& b, const NodePair& pair) {
  return is_wanted(a.boxes->role_of_node(pair[0]), b.boxes->role_of_node(pair[1])) && overlap(a.boxes->node[pair[0]], b.boxes->node[pair[1]]);
}
/// Appends the pairs of children into which a pair is split; false when both are leaves.
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

/// Calls test(item_a, item_b, partial) for every wanted pair with overlapping boxes, once each (an item with itself too, when a and b are
/// the same boxes), with one Partial per task; returns all joined by Partial::append in an order that does not depend on threads. Parallel.
template <class Partial, class Test>
Partial search_pairs(const SearchSide& a, const SearchSide& b, const Test& test, const RunContext& context) {
  const std::vector<detail::NodePair> tasks = detail::split_search(a, b);
  const bool is_same = a.boxes == b.boxes;
  const auto visit_leaves = [&](const detail::NodePair& pair, Partial& partial) {
    const auto [first_a, count_a] = a.tree->nodes[pair[0]];
    const auto [first_b, count_b] = b.tree->nodes[pair[1]];
    const bool is_diagonal = is_same && pair[0] == pair[1];
    for (std::uint32_t i = first_a; i < first_a + count_a; ++i) {
      const Role role = a.boxes->role_of_place(i);
      for (std::uint32_t j = is_diagonal ? i : first_b; j < first_b + count_b; ++j) {
        if (is_wanted(role, b.boxes->role_of_place(j)) && overlap(a.boxes->place[i], b.boxes->place[j])) test(a.tree->item_at[i], b.tree->item_at[j], partial);
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
