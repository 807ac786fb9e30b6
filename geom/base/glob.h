// Name patterns such as "wing*".
#pragma once

#include <algorithm>
#include <cstddef>
#include <span>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

namespace sterna {

/// Returns true if the name matches the pattern: "*" stands for any sequence of characters, "?" for any single character.
bool matches_glob(std::string_view name, std::string_view glob);

/// Returns the number of literal characters in a pattern. If several patterns match a name, the pattern with the most literal characters applies.
std::size_t n_spelled_out(std::string_view glob);

/// Sorts rules by the number of literal characters of their member `names`, a pattern: more specific patterns come later and so take precedence ("wing*", then
/// "wing_tip"). Deterministic.
template <class Rule>
void sort_by_pattern(std::vector<Rule>& rules) {
  std::sort(rules.begin(), rules.end(),
            [](const Rule& a, const Rule& b) { return std::pair(n_spelled_out(a.names), a.names) < std::pair(n_spelled_out(b.names), b.names); });
}

/// Returns "names are a, b, c" (sorted, without duplicates, the first dozen) as a hint for a pattern that matches no name. Adds "did you mean" if a name is
/// close to the pattern.
std::string names_hint(std::span<const std::string> names, std::string_view glob);

}  // namespace sterna
