#include "surfmesh/model/size_field.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <tuple>

namespace sterna::surfmesh {
namespace {

constexpr std::uint32_t k_leaf = 8;
/// Cells that sources are thinned in, by the power of two below their size: with growth 0.2 a field is off by a tenth at most.
constexpr double k_thinning = 0.5;

bool is_before(const SizeSource& a, const SizeSource& b) {
  return std::tie(a.size, a.point.x, a.point.y, a.point.z) < std::tie(b.size, b.point.x, b.point.y, b.point.z);
}

/// The least source of each cell of its size's grid.
std::vector<SizeSource> thinned(const std::vector<SizeSource>& sources, double largest) {
  struct Entry {
    std::array<std::int64_t, 4> cell;
    SizeSource source;
  };
  std::vector<Entry> entries;
  for (const SizeSource& s : sources) {
    if (!(s.size < largest)) continue;
    int level = 0;
    std::frexp(s.size, &level);
    const double side = std::ldexp(k_thinning, level);
    entries.push_back({{level, static_cast<std::int64_t>(std::floor(s.point.x / side)), static_cast<std::int64_t>(std::floor(s.point.y / side)),
                        static_cast<std::int64_t>(std::floor(s.point.z / side))},
                       s});
  }
  std::sort(entries.begin(), entries.end(), [](const Entry& a, const Entry& b) { return a.cell != b.cell ? a.cell < b.cell : is_before(a.source, b.source); });
  std::vector<SizeSource> result;
  for (std::size_t i = 0; i < entries.size(); ++i)
    if (i == 0 || entries[i].cell != entries[i - 1].cell) result.push_back(entries[i].source);
  return result;
}

double distance_to_box(const Point& p, const Point& low, const Point& high) {
  const double x = std::max({low.x - p.x, 0.0, p.x - high.x}), y = std::max({low.y - p.y, 0.0, p.y - high.y}), z = std::max({low.z - p.z, 0.0, p.z - high.z});
  return std::sqrt(x * x + y * y + z * z);
}

}  // namespace

SizeField::SizeField(std::vector<SizeSource> sources, double growth, double largest) : sources_(thinned(sources, largest)), growth_(growth) {
  if (!sources_.empty()) build(0, static_cast<std::uint32_t>(sources_.size()));
}

std::uint32_t SizeField::build(std::uint32_t first, std::uint32_t count) {
  const auto id = static_cast<std::uint32_t>(nodes_.size());
  Node node{{1e300, 1e300, 1e300}, {-1e300, -1e300, -1e300}, 1e300, first, count, 0};
  for (std::uint32_t i = first; i < first + count; ++i) {
    for (std::size_t k = 0; k < 3; ++k) {
      node.low[k] = std::min(node.low[k], sources_[i].point[k]);
      node.high[k] = std::max(node.high[k], sources_[i].point[k]);
    }
    node.least = std::min(node.least, sources_[i].size);
  }
  nodes_.push_back(node);
  if (count <= k_leaf) return id;
  std::size_t axis = 0;
  for (std::size_t k = 1; k < 3; ++k)
    if (node.high[k] - node.low[k] > node.high[axis] - node.low[axis]) axis = k;
  const std::uint32_t half = count / 2;
  const auto begin = sources_.begin() + first;
  std::nth_element(begin, begin + half, begin + count, [axis](const SizeSource& a, const SizeSource& b) {
    return a.point[axis] != b.point[axis] ? a.point[axis] < b.point[axis] : is_before(a, b);
  });
  build(first, half);
  const std::uint32_t right = build(first + half, count - half);
  nodes_[id].right = right;
  return id;
}

double SizeField::operator()(const Point& p, double cap, double reach) const {
  if (nodes_.empty()) return cap;
  struct Entry {
    double bound;
    std::uint32_t node;
  };
  std::array<Entry, 64> stack;  // median splits: the depth is the logarithm of at most 2^32 sources
  std::size_t n = 0;
  double best = cap;
  const auto bound_of = [&](std::uint32_t i) { return nodes_[i].least + growth_ * std::max(0.0, distance_to_box(p, nodes_[i].low, nodes_[i].high) - reach); };
  stack[n++] = {bound_of(0), 0};
  while (n > 0) {
    const Entry entry = stack[--n];
    if (entry.bound >= best) continue;
    const Node& node = nodes_[entry.node];
    if (node.right == 0) {
      for (std::uint32_t i = node.first; i < node.first + node.count; ++i)
        best = std::min(best, sources_[i].size + growth_ * std::max(0.0, distance(p, sources_[i].point) - reach));
      continue;
    }
    const Entry left{bound_of(entry.node + 1), entry.node + 1}, right{bound_of(node.right), node.right};
    const bool is_left_nearer = left.bound <= right.bound;
    stack[n++] = is_left_nearer ? right : left;
    stack[n++] = is_left_nearer ? left : right;
  }
  return best;
}

}  // namespace sterna::surfmesh
