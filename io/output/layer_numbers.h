// Numbering of items that columns have layer by layer (cells, faces of a side), one column after the other. It is computed if all columns have the same number
// of layers; otherwise a table of offsets is used.
#pragma once

#include <algorithm>
#include <cstdint>
#include <vector>

#include "geom/mesh/hybrid_mesh.h"

namespace sterna::io {

class LayerNumbers {
 public:
  LayerNumbers() = default;
  /// Creates the numbering for n columns. Column i has count(i) items, or n_layers of the block if all its growth lines have that number.
  template <class Count>
  LayerNumbers(const LayerBlock& layers, std::uint64_t n, const Count& count)
      : per_column_(static_cast<std::uint64_t>(std::max(layers.n_layers, 0))), size_(n * per_column_) {
    if (layers.is_uniform()) return;
    first_.resize(n + 1, 0);
    for (std::uint64_t i = 0; i < n; ++i) first_[i + 1] = first_[i] + count(i);
    size_ = first_.back();
  }

  std::uint64_t size() const { return size_; }
  std::uint64_t first(std::uint64_t i) const { return first_.empty() ? i * per_column_ : first_[i]; }
  std::uint64_t n_layers(std::uint64_t i) const { return first_.empty() ? per_column_ : first_[i + 1] - first_[i]; }

  struct Location {
    std::uint64_t i, layer;  ///< i-th column; layer 0 is the column's first item, at the wall
  };
  /// \pre number < size()
  Location at(std::uint64_t number) const {
    if (first_.empty()) return {number / per_column_, number % per_column_};
    const auto i = static_cast<std::uint64_t>(std::upper_bound(first_.begin(), first_.end(), number) - first_.begin()) - 1;
    return {i, number - first_[i]};
  }

 private:
  std::uint64_t per_column_ = 0, size_ = 0;
  std::vector<std::uint64_t> first_;  ///< empty if each column has per_column_ items
};

}  // namespace sterna::io
