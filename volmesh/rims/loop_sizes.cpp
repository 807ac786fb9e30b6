#include "volmesh/rims/loop_sizes.h"

#include <algorithm>
#include <cmath>
#include <tuple>

namespace sterna::volmesh {
namespace {

constexpr std::uint32_t k_leaf = 8;

}  // namespace

LoopSizes::LoopSizes(std::vector<SizePlace> places, double slope) : places_(std::move(places)), slope_(slope) {
  if (places_.empty()) return;
  nodes_.emplace_back();
  build(0, 0, static_cast<std::uint32_t>(places_.size()));
}

void LoopSizes::build(std::uint32_t node, std::uint32_t first, std::uint32_t count) {
  Box box;
  double least = std::numeric_limits<double>::infinity();
  for (std::uint32_t i = first; i < first + count; ++i) {
    box.add(places_[i].point);
    least = std::min(least, places_[i].size);
  }
  nodes_[node].box = box;
  nodes_[node].least = least;
  nodes_[node].first = first;
  nodes_[node].count = count;
  if (count <= k_leaf) return;
  const Vec3 extent = box.max - box.min;
  const std::size_t axis = extent.x >= extent.y && extent.x >= extent.z ? 0 : extent.y >= extent.z ? 1 : 2;
  const std::uint32_t half = count / 2;
  const auto begin = places_.begin() + first;
  // A total order but for places that are equal in all respects, so the tree is the same whatever nth_element does.
  std::nth_element(begin, begin + half, begin + count, [axis](const SizePlace& a, const SizePlace& b) {
    return std::tuple(a.point[axis], a.point.x, a.point.y, a.point.z, a.size) < std::tuple(b.point[axis], b.point.x, b.point.y, b.point.z, b.size);
  });
  const auto left = static_cast<std::uint32_t>(nodes_.size());
  nodes_.resize(nodes_.size() + 2);
  nodes_[node].first = left;
  nodes_[node].count = 0;
  build(left, first, half);
  build(left + 1, first + half, count - half);
}

double LoopSizes::bound(const Node& node, const Point& p) const {
  const auto beyond = [](double x, double low, double high) { return std::max({low - x, x - high, 0.0}); };
  const Vec3 d{beyond(p.x, node.box.min.x, node.box.max.x), beyond(p.y, node.box.min.y, node.box.max.y), beyond(p.z, node.box.min.z, node.box.max.z)};
  return node.least + slope_ * norm(d);
}

double LoopSizes::operator()(const Point& p) const {
  double best = std::numeric_limits<double>::infinity();
  if (nodes_.empty()) return best;
  struct Waiting {
    std::uint32_t node;
    double bound;
  };
  // Halves of at most 2^32 places: the nearer child is opened at once, one waits on each level.
  Waiting stack[40];
  int n = 0;
  stack[n++] = {0, bound(nodes_[0], p)};
  while (n > 0) {
    const Waiting waiting = stack[--n];
    if (waiting.bound * (1.0 + k_tolerance) >= best) continue;
    const Node& node = nodes_[waiting.node];
    if (node.count > 0) {
      for (std::uint32_t i = node.first; i < node.first + node.count; ++i) best = std::min(best, places_[i].size + slope_ * distance(places_[i].point, p));
      continue;
    }
    const Waiting left{node.first, bound(nodes_[node.first], p)}, right{node.first + 1, bound(nodes_[node.first + 1], p)};
    const bool is_left_nearer = left.bound <= right.bound;
    stack[n++] = is_left_nearer ? right : left;
    stack[n++] = is_left_nearer ? left : right;
  }
  return best;
}

}  // namespace sterna::volmesh
