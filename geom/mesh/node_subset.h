// A subset of the nodes with dense numbers, small enough to stay in cache: one bit per node and a running count per word.
#pragma once

#include <atomic>
#include <bit>
#include <cstdint>
#include <vector>

namespace sterna {

class NodeSubset {
 public:
  explicit NodeSubset(std::size_t n_nodes) : bits_((n_nodes + 63) / 64, 0) {}

  /// Adds a node. May be called from several threads.
  void insert(std::size_t node) {
    const std::atomic_ref<std::uint64_t> word(bits_[node / 64]);
    const std::uint64_t bit = std::uint64_t{1} << (node % 64);
    if ((word.load(std::memory_order_relaxed) & bit) == 0) word.fetch_or(bit, std::memory_order_relaxed);
  }
  /// Numbers the members by ascending node. Call after the last insert.
  void number() {
    rank_.resize(bits_.size() + 1);
    rank_[0] = 0;
    for (std::size_t w = 0; w < bits_.size(); ++w) rank_[w + 1] = rank_[w] + static_cast<std::uint32_t>(std::popcount(bits_[w]));
  }
  bool contains(std::size_t node) const { return ((bits_[node / 64] >> (node % 64)) & 1) != 0; }
  /// \pre contains(node), number() was called
  std::uint32_t index(std::size_t node) const {
    const std::uint64_t below = bits_[node / 64] & ((std::uint64_t{1} << (node % 64)) - 1);
    return rank_[node / 64] + static_cast<std::uint32_t>(std::popcount(below));
  }
  std::size_t size() const { return rank_.back(); }
  /// Returns the members, ascending.
  std::vector<std::uint32_t> members() const {
    std::vector<std::uint32_t> result;
    result.reserve(size());
    for (std::size_t w = 0; w < bits_.size(); ++w)
      for (std::uint64_t word = bits_[w]; word != 0; word &= word - 1)
        result.push_back(static_cast<std::uint32_t>(64 * w) + static_cast<std::uint32_t>(std::countr_zero(word)));
    return result;
  }

 private:
  std::vector<std::uint64_t> bits_;
  std::vector<std::uint32_t> rank_;
};

}  // namespace sterna
