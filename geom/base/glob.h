// Patterns of names: "wing*".
#pragma once

#include <algorithm>
#include <cstddef>
#include <span>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

namespace sterna {

/// Whether a name is like a pattern: "*" any run of characters, "?" any one.
bool matches_glob(std::string_view name, std::string_view glob);

/// Letters that a pattern spells out. Of two patterns that match a name, the one that spells out more says what holds there.
std::size_t n_spelled_out(std::string_view glob);

/// Sorts rules by their member `names`, a pattern: those that spell out more come later, so that they win ("wing*", then "wing_tip"). Deterministic.
template <class Rule>
void sort_by_pattern(std::vector<Rule>& rules) {
  std::sort(rules.begin(), rules.end(),
            [](const Rule& a, const Rule& b) { return std::pair(n_spelled_out(a.names), a.names) < std::pair(n_spelled_out(b.names), b.names); });
}

/// "names are a, b, c": sorted, each once, the first dozen; for the hint of a pattern that no name is like. With "did you mean" where one is nearly the
/// pattern.
std::string names_hint(std::span<const std::string> names, std::string_view glob);

}  // namespace sterna
