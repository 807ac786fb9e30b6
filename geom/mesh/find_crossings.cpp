// Finds crossing pairs of a set of triangles with three tools: a tree of boxes over triangles in the order of a space-filling curve, a cheap proof that
// neighbours do not cross, and the exact test for the remaining pairs.
//
// 1. Triangles are sorted along Morton's curve (their centres in 2^21 cells of each axis), eight to a leaf, leaves in a tree of eight children each,
//    level by level: no pointers, and triangles near in space are near in memory.
// 2. Boxes are stored as floats about the centre of all. Each float is a monotone function of its double, so boxes that overlap still do.
// 3. Each leaf searches the tree for later leaves that overlap, and tests the pairs of triangles whose boxes overlap.
// 4. Most of these pairs are neighbours on a smooth surface: in the projection along an axis, an edge of one triangle separates them (two triangles whose
//    projections are apart except for shared vertices cannot cross). A filter of orient2d proves the separation or is undecided; triangles_cross decides the
//    rest.
#include "geom/mesh/find_crossings.h"

#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <limits>
#include <string>

#include "geom/base/error.h"
#include "geom/base/parallel.h"
#include "geom/base/vec3.h"
#include "geom/math/intersect.h"
#include "geom/mesh/tri_mesh.h"

namespace sterna {
namespace {

using CornerIndices = std::array<std::uint32_t, 3>;

/// Number of boxes in a packet, of triangles in a leaf and of children of a node. This many floats fill one vector register.
constexpr std::size_t k_leaf_width = 8;
/// Leaves per task: about 1 ms.
constexpr std::size_t k_chunk = 128;
/// Bits per axis of Morton's curve; a key holds three times as many bits.
constexpr int k_curve_bits = 21;

void check_input(std::span<const Vec3> points, std::span<const CornerIndices> triangles) {
  const auto fail = [](const std::string& problem) {
    throw Error({.code = ErrorCode::bad_argument, .attempted = "finding crossing triangles", .problem = problem});
  };
  for (std::size_t t = 0; t < triangles.size(); ++t) {
    for (const std::uint32_t v : triangles[t]) {
      if (v >= points.size()) fail("triangle " + std::to_string(t) + " refers to point " + std::to_string(v) + " of " + std::to_string(points.size()));
      if (!is_finite(points[v])) fail("point " + std::to_string(v) + " of triangle " + std::to_string(t) + " is not finite");
    }
  }
}

// ---------------------------------------------------------------- the tree

struct FloatBox {
  std::array<float, 3> low, high;
};

/// Eight boxes, coordinate by coordinate; unused boxes overlap nothing.
struct alignas(32) Packet {
  std::array<std::array<float, k_leaf_width>, 3> low, high;
  Packet() {
    for (std::size_t axis = 0; axis < 3; ++axis) {
      low[axis].fill(std::numeric_limits<float>::infinity());
      high[axis].fill(-std::numeric_limits<float>::infinity());
    }
  }
  void set(std::size_t k, const FloatBox& box) {
    for (std::size_t axis = 0; axis < 3; ++axis) {
      low[axis][k] = box.low[axis];
      high[axis][k] = box.high[axis];
    }
  }
  FloatBox box(std::size_t k) const { return {{low[0][k], low[1][k], low[2][k]}, {high[0][k], high[1][k], high[2][k]}}; }
  FloatBox hull() const {
    FloatBox all;
    for (std::size_t axis = 0; axis < 3; ++axis) {
      all.low[axis] = *std::min_element(low[axis].begin(), low[axis].end());
      all.high[axis] = *std::max_element(high[axis].begin(), high[axis].end());
    }
    return all;
  }
  /// Returns a bit mask; bit k: box k overlaps.
  std::uint32_t overlapping(const FloatBox& b) const {
    constexpr std::array<std::uint32_t, k_leaf_width> bit{1, 2, 4, 8, 16, 32, 64, 128};
    std::uint32_t mask = 0;
    for (std::size_t k = 0; k < k_leaf_width; ++k) {
      const bool is_hit = (low[0][k] <= b.high[0]) & (high[0][k] >= b.low[0]) & (low[1][k] <= b.high[1]) & (high[1][k] >= b.low[1]) & (low[2][k] <= b.high[2]) &
                          (high[2][k] >= b.low[2]);
      mask |= is_hit ? bit[k] : 0u;
    }
    return mask;
  }
};

/// Returns the 21 lowest bits of x, with two zeros after each.
std::uint64_t spread(std::uint64_t x) {
  x = (x | x << 32) & 0x001f00000000ffffu;
  x = (x | x << 16) & 0x001f0000ff0000ffu;
  x = (x | x << 8) & 0x100f00f00f00f00fu;
  x = (x | x << 4) & 0x10c30c30c30c30c3u;
  return (x | x << 2) & 0x1249249249249249u;
}

/// Returns a monotone function of x: the order is preserved despite the rounding.
float rounded(double x) {
  constexpr double k_largest = std::numeric_limits<float>::max();
  return static_cast<float>(std::clamp(x, -k_largest, k_largest));
}

struct TriangleLeaves {
  std::vector<std::uint32_t> order;         ///< triangles along the curve; leaf i has 8 i .. 8 i + 7
  std::vector<std::vector<Packet>> levels;  ///< [0]: boxes of triangles, one packet per leaf; [l + 1]: boxes of the packets of level l
  std::size_t n_leaves() const { return levels.empty() ? 0 : levels[0].size(); }
};

TriangleLeaves make_leaves(std::span<const Vec3> points, std::span<const CornerIndices> triangles, const RunContext& context) {
  TriangleLeaves tree;
  if (triangles.empty()) return tree;
  Box all;
  for (const CornerIndices& t : triangles)
    for (const std::uint32_t v : t) all.add(points[v]);
  const Vec3 middle = all.center();
  const double cells = (1u << k_curve_bits) - 1, side = all.longest_side();
  const double scale = side > 0.0 ? cells / side : 0.0;
  struct Location {
    std::uint64_t key;
    std::uint32_t triangle;
  };
  std::vector<Location> locations(triangles.size());
  parallel_for(context, triangles.size(), [&](std::size_t i) {
    const CornerIndices& t = triangles[i];
    const Vec3 centre = (points[t[0]] - all.min) / 3.0 + (points[t[1]] - all.min) / 3.0 + (points[t[2]] - all.min) / 3.0;
    std::uint64_t key = 0;
    for (std::size_t axis = 0; axis < 3; ++axis) key |= spread(static_cast<std::uint64_t>(std::clamp(centre[axis] * scale, 0.0, cells))) << axis;
    locations[i] = {key, static_cast<std::uint32_t>(i)};
  });
  parallel_sort(context, locations, [](const Location& a, const Location& b) { return a.key != b.key ? a.key < b.key : a.triangle < b.triangle; });
  tree.order.resize(locations.size());
  for (std::size_t i = 0; i < locations.size(); ++i) tree.order[i] = locations[i].triangle;

  tree.levels.emplace_back((locations.size() + k_leaf_width - 1) / k_leaf_width);
  parallel_for(context, locations.size(), [&](std::size_t i) {
    Box box;
    for (const std::uint32_t v : triangles[tree.order[i]]) box.add(points[v]);
    FloatBox near;
    for (std::size_t axis = 0; axis < 3; ++axis) {
      near.low[axis] = rounded(box.min[axis] - middle[axis]);
      near.high[axis] = rounded(box.max[axis] - middle[axis]);
    }
    tree.levels[0][i / k_leaf_width].set(i % k_leaf_width, near);
  });
  while (tree.levels.back().size() > 1) {
    const std::vector<Packet>& below = tree.levels.back();
    std::vector<Packet> above((below.size() + k_leaf_width - 1) / k_leaf_width);
    for (std::size_t i = 0; i < below.size(); ++i) above[i / k_leaf_width].set(i % k_leaf_width, below[i].hull());
    tree.levels.push_back(std::move(above));
  }
  return tree;
}

/// Calls visit(leaf) for the leaves from `first` onwards whose box overlaps.
template <class Visit>
void for_each_leaf(const TriangleLeaves& tree, const FloatBox& box, std::size_t first, const Visit& visit) {
  struct Step {
    std::size_t level, packet;
  };
  // At most seven siblings are pending on each of the 11 levels that 2^32 triangles need.
  std::array<Step, 96> stack;
  std::size_t n = 0;
  const std::size_t top = tree.levels.size() - 1;
  if (top == 0) return visit(std::size_t{0});
  stack[n++] = {top, 0};
  while (n > 0) {
    const Step step = stack[--n];
    std::uint32_t mask = tree.levels[step.level][step.packet].overlapping(box);
    // Children before the one that contains `first` have only leaves before `first`.
    const std::size_t least = first >> (3 * (step.level - 1));
    for (; mask != 0; mask &= mask - 1) {
      const std::size_t child = step.packet * k_leaf_width + static_cast<std::size_t>(std::countr_zero(mask));
      if (child < least) continue;
      if (step.level == 1) visit(child);
      else stack[n++] = {step.level - 1, child};
    }
  }
}

// ---------------------------------------------------------------- proof that two triangles are apart

/// Returns the certain sign of orient2d of three points projected along an axis, or zero if rounding may decide (Shewchuk 1997, bound A; products that
/// underflow stay undecided).
int sure_turn(const Vec3& a, const Vec3& b, const Vec3& c, std::size_t u, std::size_t v) {
  constexpr double k_bound = 3.4e-16, k_least = 1e-290;
  const double left = (b[u] - a[u]) * (c[v] - a[v]), right = (b[v] - a[v]) * (c[u] - a[u]);
  const double det = left - right, error = k_bound * (std::abs(left) + std::abs(right)) + k_least;
  return det > error ? 1 : det < -error ? -1 : 0;
}

/// Two triangles with their shared corners first.
struct Pair {
  std::array<const Vec3*, 3> a, b;
  std::size_t n_shared = 0;
};

Pair gather(std::span<const Vec3> points, const CornerIndices& a, const CornerIndices& b) {
  Pair pair;
  std::array<bool, 3> is_shared_a{}, is_shared_b{};
  for (std::size_t i = 0; i < 3; ++i)
    for (std::size_t j = 0; j < 3; ++j)
      if (a[i] == b[j]) is_shared_a[i] = is_shared_b[j] = true;
  std::size_t n_a = 0, n_b = 0;
  for (std::size_t i = 0; i < 3; ++i)
    if (is_shared_a[i]) pair.a[n_a++] = &points[a[i]];
  for (std::size_t i = 0; i < 3; ++i)
    if (is_shared_b[i]) pair.b[n_b++] = &points[b[i]];
  pair.n_shared = n_a == n_b ? n_a : 3;  // a corner repeated within one triangle: left to the exact test
  for (std::size_t i = 0; i < 3; ++i)
    if (!is_shared_a[i]) pair.a[n_a++] = &points[a[i]];
  for (std::size_t i = 0; i < 3; ++i)
    if (!is_shared_b[i]) pair.b[n_b++] = &points[b[i]];
  return pair;
}

/// Returns true if an edge of `a` that contains all shared corners separates the triangles: the rest of `a` is strictly on one side, the rest of `b` strictly
/// on the other. Common points then project onto the shared corners; since `a` has area in the projection, they are the shared corners.
bool edge_separates(const std::array<const Vec3*, 3>& a, const std::array<const Vec3*, 3>& b, std::size_t n_shared, std::size_t u, std::size_t v) {
  constexpr std::size_t k_edge[3][3] = {{0, 1, 2}, {0, 2, 1}, {1, 2, 0}};
  // The candidates are all three edges if no corner is shared, two edges if corner 0 is shared, and one edge if corners 0 and 1 are shared.
  for (std::size_t e = 0; e < 3 - n_shared; ++e) {
    const Vec3 &from = *a[k_edge[e][0]], &to = *a[k_edge[e][1]];
    const int side = sure_turn(from, to, *a[k_edge[e][2]], u, v);
    if (side == 0) continue;
    bool is_apart = true;
    for (std::size_t k = n_shared; k < 3 && is_apart; ++k) is_apart = sure_turn(from, to, *b[k], u, v) == -side;
    if (is_apart) return true;
  }
  return false;
}

/// Returns true only if the triangles do not cross.
bool are_apart(std::span<const Vec3> points, const CornerIndices& a, const CornerIndices& b) {
  const Pair pair = gather(points, a, b);
  if (pair.n_shared == 3) return false;
  const Vec3 normal = cross(*pair.a[1] - *pair.a[0], *pair.a[2] - *pair.a[0]);
  const double x = std::abs(normal.x), y = std::abs(normal.y), z = std::abs(normal.z);
  const std::size_t u = x >= y && x >= z ? 1 : 0, v = z >= x && z >= y ? 1 : 2;
  return edge_separates(pair.a, pair.b, pair.n_shared, u, v) || (pair.n_shared < 2 && edge_separates(pair.b, pair.a, pair.n_shared, u, v));
}

// ---------------------------------------------------------------- pairs

/// Keeps the first `limit` pairs.
void shorten(std::vector<std::array<std::uint32_t, 2>>& pairs, std::size_t limit) {
  if (pairs.size() <= limit) return;
  std::nth_element(pairs.begin(), pairs.begin() + static_cast<std::ptrdiff_t>(limit), pairs.end());
  pairs.resize(limit);
}

}  // namespace

CrossingPairs find_crossings(std::span<const Vec3> points, std::span<const std::array<std::uint32_t, 3>> triangles, const RunContext& context,
                             std::size_t limit) {
  check_input(points, triangles);
  const TriangleLeaves tree = make_leaves(points, triangles, context);

  const auto crossings_of = [&](std::size_t begin, std::size_t end) {
    // More than `limit` pairs are kept temporarily, so that the amortised cost of dropping the last pairs is small.
    const std::size_t many = limit > std::numeric_limits<std::size_t>::max() / 4 ? limit : 2 * limit + 1024;
    CrossingPairs found;
    const auto test = [&](std::uint32_t i, std::uint32_t j) {
      if (i > j) std::swap(i, j);
      if (are_apart(points, triangles[i], triangles[j]) || !triangles_cross(points, triangles[i], triangles[j])) return;
      ++found.total;
      found.pairs.push_back({i, j});
      if (found.pairs.size() > many) shorten(found.pairs, limit);
    };
    for (std::size_t leaf = begin; leaf < end; ++leaf) {
      const Packet& own = tree.levels[0][leaf];
      const FloatBox hull = own.hull();
      for_each_leaf(tree, hull, leaf, [&](std::size_t other) {
        const Packet& packet = tree.levels[0][other];
        std::uint32_t mine = other == leaf ? 0xffu : own.overlapping(packet.hull());
        for (; mine != 0; mine &= mine - 1) {
          const auto k = static_cast<std::size_t>(std::countr_zero(mine));
          std::uint32_t theirs = packet.overlapping(own.box(k));
          if (other == leaf) theirs &= ~((2u << k) - 1u);
          for (; theirs != 0; theirs &= theirs - 1)
            test(tree.order[leaf * k_leaf_width + k], tree.order[other * k_leaf_width + static_cast<std::size_t>(std::countr_zero(theirs))]);
        }
      });
    }
    shorten(found.pairs, limit);
    return found;
  };
  const auto append = [limit](CrossingPairs all, CrossingPairs more) {
    all.pairs.insert(all.pairs.end(), more.pairs.begin(), more.pairs.end());
    shorten(all.pairs, limit);
    all.total += more.total;
    return all;
  };
  CrossingPairs found = parallel_reduce(context, tree.n_leaves(), CrossingPairs{}, crossings_of, append, k_chunk);
  parallel_sort(context, found.pairs, std::less<>());
  return found;
}

CrossingPairs find_crossings(const TriMesh& mesh, const RunContext& context, std::size_t limit) {
  std::vector<std::array<std::uint32_t, 3>> triangles;
  triangles.reserve(mesh.n_triangles());
  for (const TriangleVertices& v : mesh.triangles) triangles.push_back({v[0].value(), v[1].value(), v[2].value()});
  return find_crossings(mesh.points.raw(), triangles, context, limit);
}

}  // namespace sterna
