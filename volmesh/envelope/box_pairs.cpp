#include "volmesh/envelope/box_pairs.h"

#include "geom/mesh/bvh.h"

namespace sterna::volmesh {
namespace {

/// Smallest number of tasks of a search, enough to balance them over many threads.
constexpr std::size_t k_tasks = 1024;
/// Size of the stack, as in BoxTree::for_each_overlap: median splits of at most 2^31 items.
constexpr int k_pair_stack = 64;

}  // namespace

BoxHierarchy::BoxHierarchy(const TriMesh& mesh, const RunContext& context) {
  std::vector<Box> boxes(mesh.n_triangles());
  parallel_for(context, boxes.size(), [&](std::size_t i) {
    for (const Point& p : corners(mesh, TriangleId(i))) boxes[i].add(p);
  });
  const BoxTree tree(boxes, context);
  nodes.reserve(tree.nodes().size());
  for (const BoxTree::Node& node : tree.nodes()) nodes.push_back({node.first, node.count});
  level_begin.assign(tree.level_begins().begin(), tree.level_begins().end());
  item_at.assign(tree.order().begin(), tree.order().end());
}

void FittedBoxes::fit(const BoxHierarchy& tree, const RunContext& context) {
  location_role.assign(tree.item_at.size(), k_both_roles);
  spread_roles(tree, true, context);
  location_role.clear();
  node_role.clear();
}

void FittedBoxes::spread_roles(const BoxHierarchy& tree, bool refit, const RunContext& context) {
  node.resize(tree.nodes.size());
  node_role.resize(tree.nodes.size());
  for (std::size_t level = tree.level_begin.empty() ? 0 : tree.level_begin.size() - 1; level-- > 0;) {
    const std::size_t begin = tree.level_begin[level];
    parallel_for(context, tree.level_begin[level + 1] - begin, [&](std::size_t i) {
      const auto [first, count] = tree.nodes[begin + i];
      Role role = k_no_role;
      if (count == 0) role = node_role[first] | node_role[first + 1];
      for (std::uint32_t j = first; j < first + count; ++j) role |= location_role[j];
      node_role[begin + i] = role;
      if (!refit || role == k_no_role) return;
      RoundedBox box;
      for (std::uint32_t j = first; j < first + count; ++j) box.add(location[j]);
      if (count == 0) {
        box.add(node[first]);
        box.add(node[first + 1]);
      }
      node[begin + i] = box;
    });
  }
}

void find_overlaps(const BoxHierarchy& tree, const FittedBoxes& a, const FittedBoxes& b, const RoundedBox& box, std::vector<std::uint32_t>& found) {
  if (tree.nodes.empty()) return;
  const auto overlaps = [&box](RoundedBox first, const RoundedBox& second) {
    first.add(second);
    return overlap(first, box);
  };
  std::uint32_t stack[k_pair_stack];
  int n = 0;
  stack[n++] = 0;
  while (n > 0) {
    const std::uint32_t index = stack[--n];
    if (!overlaps(a.node[index], b.node[index])) continue;
    const auto [first, count] = tree.nodes[index];
    for (std::uint32_t j = first; j < first + count; ++j)
      if (overlaps(a.location[j], b.location[j])) found.push_back(tree.item_at[j]);
    if (count > 0) continue;
    stack[n++] = first + 1;
    stack[n++] = first;
  }
}

namespace detail {

std::vector<NodePair> split_search(const SearchSide& a, const SearchSide& b) {
  std::vector<NodePair> pairs;
  if (a.tree->nodes.empty() || b.tree->nodes.empty()) return pairs;
  pairs.push_back({0, 0});
  for (bool has_split = true; has_split && pairs.size() < k_tasks;) {
    has_split = false;
    std::vector<NodePair> next;
    for (const NodePair& pair : pairs) {
      if (!is_worthwhile(a, b, pair)) continue;
      if (split_pair(a, b, pair, next)) has_split = true;
      else next.push_back(pair);
    }
    pairs.swap(next);
  }
  return pairs;
}

}  // namespace detail
}  // namespace sterna::volmesh
