// Options together with the structs that they set, for descriptions of what a verb or a command takes.
#pragma once

#include <iterator>
#include <memory>
#include <tuple>
#include <utility>

#include "geom/base/schema.h"

namespace sterna::scripting {

struct HeldOptions {
  OptionTable table;
  std::shared_ptr<void> structs = {};  ///< owner of the structs; the table refers to them
};

/// Returns the options of new structs, in the order of the types.
template <class... Structs>
HeldOptions held_options() {
  const auto structs = std::make_shared<std::tuple<Structs...>>();
  HeldOptions held{.table = {}, .structs = structs};
  const auto add = [&](OptionTable table) {
    held.table.insert(held.table.end(), std::make_move_iterator(table.begin()), std::make_move_iterator(table.end()));
  };
  std::apply([&](auto&... each) { (add(sterna::options_of(each)), ...); }, *structs);
  return held;
}

/// Returns the options of both, those of `a` first.
inline HeldOptions joined_options(HeldOptions a, HeldOptions b) {
  HeldOptions both{.table = std::move(a.table), .structs = std::make_shared<std::pair<std::shared_ptr<void>, std::shared_ptr<void>>>(a.structs, b.structs)};
  both.table.insert(both.table.end(), std::make_move_iterator(b.table.begin()), std::make_move_iterator(b.table.end()));
  return both;
}

/// Returns the table that `Make` makes of new structs.
template <auto Make, class... Structs>
HeldOptions held_table() {
  const auto structs = std::make_shared<std::tuple<Structs...>>();
  return {.table = std::apply(Make, *structs), .structs = structs};
}

}  // namespace sterna::scripting
