#include "geom/mesh/size_points.h"

#include <algorithm>
#include <cmath>

#include "geom/base/parallel.h"
#include "geom/mesh/bvh.h"

namespace sterna {
namespace {

/// Number of size points in a leaf. It is not 1, because testing a size point costs less than testing a box.
constexpr std::uint32_t k_leaf_points = 8;

float below(double x) { return std::nextafter(static_cast<float>(x), -std::numeric_limits<float>::infinity()); }
float above(double x) { return std::nextafter(static_cast<float>(x), std::numeric_limits<float>::infinity()); }

}  // namespace

SizePointTree::SizePointTree(std::span<const SizePoint> size_points, double slope, const RunContext& context) : slope_(slope) {
  std::vector<Box> boxes(size_points.size());
  parallel_for(context, size_points.size(), [&](std::size_t i) { boxes[i].add(size_points[i].point); });
  const BoxTree tree(boxes, context, k_leaf_points);
  size_points_.resize(size_points.size());
  parallel_for(context, size_points.size(), [&](std::size_t i) { size_points_[i] = size_points[tree.order()[i]]; });

  nodes_.resize(tree.nodes().size());
  parallel_for(context, nodes_.size(), [&](std::size_t i) {
    const BoxTree::Node& from = tree.nodes()[i];
    Node& node = nodes_[i];
    for (std::size_t axis = 0; axis < 3; ++axis) {
      node.min[axis] = below(from.box.min[axis]);
      node.max[axis] = above(from.box.max[axis]);
    }
    node.first = from.first;
    node.count = from.count;
    double smallest = std::numeric_limits<double>::infinity();
    for (std::uint32_t k = 0; k < from.count; ++k) smallest = std::min(smallest, size_points_[from.first + k].size);
    node.smallest = from.count > 0 ? below(smallest) : 0.0f;
  });
  for (std::size_t i = nodes_.size(); i-- > 0;) {
    Node& node = nodes_[i];
    if (node.count == 0) node.smallest = std::min(nodes_[node.first].smallest, nodes_[node.first + 1].smallest);
  }
}

double SizePointTree::lower_bound(const Node& node, const Point& p, double reach) const {
  double squared = 0.0;
  for (std::size_t axis = 0; axis < 3; ++axis) {
    const double away = std::max({static_cast<double>(node.min[axis]) - p[axis], p[axis] - static_cast<double>(node.max[axis]), 0.0});
    squared += away * away;
  }
  return static_cast<double>(node.smallest) + slope_ * std::max(0.0, std::sqrt(squared) - reach);
}

template <class Found>
void SizePointTree::lower(const Point& p, const Search& search, double& best, const Found& found) const {
  if (nodes_.empty()) return;
  struct Entry {
    std::uint32_t node;
    double bound;  ///< includes the tolerance
  };
  const auto entry_of = [&](std::uint32_t node) { return Entry{node, lower_bound(nodes_[node], p, search.reach) * (1.0 + search.tolerance)}; };
  Entry stack[64];  // median splits: one entry remains on each of at most 32 levels
  int n = 0;
  stack[n++] = entry_of(0);
  while (n > 0) {
    const Entry entry = stack[--n];
    if (entry.bound >= best) continue;
    const Node& node = nodes_[entry.node];
    if (node.count == 0) {
      Entry near = entry_of(node.first);
      Entry far = entry_of(node.first + 1);
      if (far.bound < near.bound) std::swap(near, far);
      if (far.bound < best) stack[n++] = far;
      if (near.bound < best) stack[n++] = near;
      continue;
    }
    for (std::uint32_t i = node.first; i < node.first + node.count; ++i) {
      const double value = size_points_[i].size + slope_ * std::max(0.0, distance(p, size_points_[i].point) - search.reach);
      if (value < best) {
        best = value;
        found(i);
      }
    }
  }
}

double SizePointTree::smallest(const Point& p, const Search& search) const {
  double best = search.cap;
  lower(p, search, best, [](std::uint32_t) {});
  return best;
}

double SizePointTree::smallest(const Point& p, std::uint32_t& hint) const {
  double best = size_points_[hint].size + slope_ * distance(p, size_points_[hint].point);
  lower(p, {}, best, [&](std::uint32_t size_point) { hint = size_point; });
  return best;
}

}  // namespace sterna
