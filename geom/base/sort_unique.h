// Sorted lists without duplicates.
#pragma once

#include <algorithm>
#include <vector>

namespace sterna {

/// \post ascending, each value once
template <class T>
void sort_unique(std::vector<T>& values) {
  std::sort(values.begin(), values.end());
  values.erase(std::unique(values.begin(), values.end()), values.end());
}

}  // namespace sterna
