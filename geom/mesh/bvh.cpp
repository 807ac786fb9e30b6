// Builds a BoxTree level by level from the root. All nodes of a level split their items independently.
//
// Each node is split at the median of the box centres along their longest extent, ties by item number. The shape of the tree depends only on the number of
// items, and its content does not depend on the number of threads. Nodes are numbered level by level, so that two children are neighbours and parents come
// first.
#include "geom/mesh/bvh.h"

#include <algorithm>
#include <string>

#include "geom/base/error.h"
#include "geom/base/parallel.h"

namespace sterna {
namespace {

/// Query items per task of overlapping_pairs.
constexpr std::size_t k_query_chunk = 512;
/// Items per task of one level; the large nodes of the upper levels are split one per task.
constexpr std::size_t k_large_node = 1 << 14;

struct Entry {
  Vec3 center;
  std::uint32_t item;
};

/// Partitions the entries at the median, along the longest extent of their centres.
void split_at_median(std::span<Entry> entries) {
  Box extent;
  for (const Entry& e : entries) extent.add(e.center);
  const Vec3 size = extent.max - extent.min;
  const std::size_t axis = size.x >= size.y && size.x >= size.z ? 0 : size.y >= size.z ? 1 : 2;
  const auto is_before = [axis](const Entry& a, const Entry& b) {
    return a.center[axis] != b.center[axis] ? a.center[axis] < b.center[axis] : a.item < b.item;
  };
  std::nth_element(entries.begin(), entries.begin() + static_cast<std::ptrdiff_t>(entries.size() / 2), entries.end(), is_before);
}

std::vector<Entry> make_entries(std::span<const Box> boxes, const RunContext& context) {
  std::vector<Entry> entries(boxes.size());
  parallel_for(context, boxes.size(), [&](std::size_t i) {
    // An empty box overlaps nothing, whatever its position in the tree.
    const Vec3 center = boxes[i].empty() ? Vec3{} : boxes[i].center();
    if (!is_finite(center)) {
      throw Error({.code = ErrorCode::bad_argument, .attempted = "building a box tree", .problem = "box " + std::to_string(i) + " is not finite"});
    }
    entries[i] = {center, static_cast<std::uint32_t>(i)};
  });
  return entries;
}

}  // namespace

BoxTree::BoxTree(std::span<const Box> boxes, const RunContext& context, std::uint32_t leaf_items) : boxes_(boxes.begin(), boxes.end()) {
  if (boxes.empty()) return;
  if (boxes.size() >= std::size_t{1} << 31) throw_id_overflow(boxes.size());
  std::vector<Entry> entries = make_entries(boxes, context);

  // A node under construction keeps its range of entries in first and count.
  nodes_.push_back({{}, 0, static_cast<std::uint32_t>(boxes.size())});
  level_begin_ = {0};
  while (level_begin_.back() < nodes_.size()) {
    const std::size_t begin = level_begin_.back();
    const std::size_t end = nodes_.size();
    level_begin_.push_back(end);
    const std::size_t chunk = std::max<std::size_t>(1, k_large_node / (nodes_[begin].count + 1));
    parallel_for(
        context, end - begin,
        [&](std::size_t i) {
          const Node& node = nodes_[begin + i];
          if (node.count > leaf_items) split_at_median(std::span(entries).subspan(node.first, node.count));
        },
        chunk);
    for (std::size_t i = begin; i < end; ++i) {
      const auto [box, first, count] = nodes_[i];
      if (count <= leaf_items) continue;
      const std::uint32_t left = count / 2;
      nodes_[i].first = static_cast<std::uint32_t>(nodes_.size());
      nodes_[i].count = 0;
      nodes_.push_back({{}, first, left});
      nodes_.push_back({{}, first + left, count - left});
    }
  }

  order_.resize(entries.size());
  parallel_for(context, entries.size(), [&](std::size_t i) { order_[i] = entries[i].item; });
  // Computes the boxes from the deepest level to the root.
  for (std::size_t level = level_begin_.size() - 1; level-- > 0;) {
    const std::size_t begin = level_begin_[level];
    parallel_for(context, level_begin_[level + 1] - begin, [&](std::size_t i) {
      Node& node = nodes_[begin + i];
      // An empty box must not be passed to Box::add: its bounds are +-1e300.
      const auto add = [&node](const Box& box) {
        if (!box.empty()) node.box.add(box);
      };
      for (std::uint32_t j = 0; j < node.count; ++j) add(boxes_[order_[node.first + j]]);
      if (node.count > 0) return;
      add(nodes_[node.first].box);
      add(nodes_[node.first + 1].box);
    });
  }
}

void BoxTree::visit_overlaps(const Box& box, const std::function<bool(std::uint32_t)>& visit) const { for_each_overlap(box, visit); }

std::vector<std::array<std::uint32_t, 2>> BoxTree::overlapping_pairs(const RunContext& context) const {
  using Pairs = std::vector<std::array<std::uint32_t, 2>>;
  const auto pairs_of = [&](std::size_t begin, std::size_t end) {
    Pairs pairs;
    for (std::size_t t = begin; t < end; ++t) {
      const auto i = static_cast<std::uint32_t>(t);
      const std::size_t n = pairs.size();
      for_each_overlap(boxes_[t], [&](std::uint32_t j) {
        if (j > i) pairs.push_back({i, j});
        return true;
      });
      std::sort(pairs.begin() + static_cast<std::ptrdiff_t>(n), pairs.end());
    }
    return pairs;
  };
  const auto append = [](Pairs all, Pairs more) {
    all.insert(all.end(), more.begin(), more.end());
    return all;
  };
  return parallel_reduce(context, boxes_.size(), Pairs{}, pairs_of, append, k_query_chunk);
}

}  // namespace sterna
