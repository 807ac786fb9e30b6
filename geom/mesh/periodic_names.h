// Pairs of patches that the user declares to be periodic.
#pragma once

#include <string>
#include <string_view>
#include <vector>

namespace sterna {

/// Names of two patches that must be images of each other.
struct PeriodicNames {
  std::string first, second;
  friend bool operator==(const PeriodicNames&, const PeriodicNames&) = default;
};

/// Parses "left,right; floor,ceiling"; side_pairs_text() writes it.
/// \throws Error(bad_argument) for other strings
std::vector<PeriodicNames> side_pairs(std::string_view text);
std::string side_pairs_text(const std::vector<PeriodicNames>& pairs);
/// Checks that side_pairs() restores the pairs from their text. \throws Error(bad_argument) for a name with "," or ";", or with a blank at an end
void require_separable(const std::vector<PeriodicNames>& pairs);

}  // namespace sterna
