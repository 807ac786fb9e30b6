// Disjoint sets (union-find): determines connected members by joining pairs.
#pragma once

#include <cstddef>
#include <cstdint>
#include <numeric>
#include <vector>

namespace sterna {

/// Disjoint sets of 0 .. n - 1; each has its lowest member as root, so the result does not depend on the order of the joins. A join or a look-up takes O(log n)
/// at most.
class DisjointSets {
 public:
  explicit DisjointSets(std::size_t n) : parent_(n) { std::iota(parent_.begin(), parent_.end(), 0u); }

  /// Returns the lowest member of the set of `i`. Not const: it shortens the path for later calls.
  std::uint32_t root(std::uint32_t i) {
    while (parent_[i] != i) i = parent_[i] = parent_[parent_[i]];
    return i;
  }
  /// Joins the sets of `a` and `b`. Returns false if they are already one set.
  bool join(std::uint32_t a, std::uint32_t b) {
    a = root(a);
    b = root(b);
    if (a < b) parent_[b] = a;
    if (b < a) parent_[a] = b;
    return a != b;
  }
  /// Returns the root of each member.
  std::vector<std::uint32_t> roots() && {
    for (std::uint32_t i = 0; i < parent_.size(); ++i) parent_[i] = root(i);
    return std::move(parent_);
  }

 private:
  std::vector<std::uint32_t> parent_;
};

}  // namespace sterna
