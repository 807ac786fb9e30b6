// Structs of columns with a single list of their members: `columns_of(s)` returns a tuple of references to all members. Code that must process every column
// uses that list.
#pragma once

#include <cstddef>
#include <tuple>
#include <utility>

namespace sterna {

/// Calls f(column of the first struct, column of the second, ...) for each column. `columns_of` is found by argument-dependent lookup.
template <class F, class... Structs>
void for_each_column(const F& f, Structs&... structs) {
  const auto lists = std::make_tuple(columns_of(structs)...);
  constexpr std::size_t n = std::tuple_size_v<std::tuple_element_t<0, decltype(lists)>>;
  const auto visit = [&]<std::size_t I>(std::integral_constant<std::size_t, I>) { std::apply([&](const auto&... list) { f(std::get<I>(list)...); }, lists); };
  [&]<std::size_t... I>(std::index_sequence<I...>) { (visit(std::integral_constant<std::size_t, I>{}), ...); }
  (std::make_index_sequence<n>{});
}

}  // namespace sterna
