// Disjoint sets built by joins, compared with a brute-force labelling.
#include "geom/base/disjoint_sets.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <random>

namespace sterna {
namespace {

TEST(DisjointSets, RootsAreTheLowestMembersWhateverTheOrder) {
  std::mt19937 random(7);
  for (int round = 0; round < 50; ++round) {
    const std::uint32_t n = 1 + random() % 40;
    std::vector<std::pair<std::uint32_t, std::uint32_t>> pairs(random() % 60);
    for (auto& [a, b] : pairs) a = random() % n, b = random() % n;
    std::vector<std::uint32_t> label(n);
    std::iota(label.begin(), label.end(), 0u);
    for (const auto& [a, b] : pairs) {
      const std::uint32_t low = std::min(label[a], label[b]), high = std::max(label[a], label[b]);
      std::ranges::replace(label, high, low);
    }
    DisjointSets forward(n), backward(n);
    for (const auto& [a, b] : pairs) {
      const bool is_apart = forward.root(a) != forward.root(b);
      EXPECT_EQ(forward.join(a, b), is_apart);
    }
    for (auto it = pairs.rbegin(); it != pairs.rend(); ++it) backward.join(it->second, it->first);
    EXPECT_EQ(std::move(forward).roots(), label);
    EXPECT_EQ(std::move(backward).roots(), label);
  }
}

}  // namespace
}  // namespace sterna
