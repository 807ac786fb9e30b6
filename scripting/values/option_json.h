// Described values (geom/base/schema.h) as JSON objects. The folder geom does not use the JSON library: its functions return JSON text, which these functions
// parse.
#pragma once

#include <nlohmann/json.hpp>
#include <vector>

#include "geom/base/schema.h"

namespace sterna::scripting {

using Json = nlohmann::ordered_json;

/// Returns the object of options_to_json().
inline Json options_json(const OptionTable& table) { return Json::parse(options_to_json(table)); }

/// Returns the object of value_to_json().
inline Json value_json(const OptionTable& table) { return Json::parse(value_to_json(table)); }

/// Returns the list of values_to_json().
template <class T>
Json values_json(const std::vector<T>& values) {
  return Json::parse(values_to_json(values));
}
/// Reads such a list. \throws Error(bad_argument)
template <class T>
std::vector<T> values_of(const Json& list) {
  return values_of_json<T>(list.dump());
}

}  // namespace sterna::scripting
