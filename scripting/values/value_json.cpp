#include "scripting/values/value_json.h"

#include <algorithm>
#include <cmath>
#include <memory>
#include <nlohmann/json.hpp>

#include "geom/base/error.h"

namespace sterna::scripting {
namespace {

using PlainJson = nlohmann::json;
PlainJson json_of(const ScriptValue& value) {
  if (const auto* flag = std::get_if<bool>(&value)) return *flag;
  if (const auto* whole = std::get_if<std::int64_t>(&value)) return *whole;
  if (const auto* number = std::get_if<double>(&value)) return std::isfinite(*number) ? PlainJson(*number) : PlainJson(nullptr);
  if (const auto* text = std::get_if<std::string>(&value)) return *text;
  const auto* table = std::get_if<TableHandle>(&value);
  if (!table) return nullptr;
  PlainJson list = PlainJson::array(), object = PlainJson::object();
  for (const ScriptValue& item : (*table)->items) list.push_back(json_of(item));
  for (const auto& [name, entry] : (*table)->fields)
    if (PlainJson json = json_of(entry); !json.is_null()) object[name] = std::move(json);
  if ((*table)->fields.empty()) return (*table)->items.empty() ? object : list;
  if (!list.empty()) object["items"] = std::move(list);
  return object;
}

ScriptValue value_of(const PlainJson& json) {
  if (json.is_boolean()) return json.get<bool>();
  if (json.is_number_integer()) return json.get<std::int64_t>();
  if (json.is_number()) return json.get<double>();
  if (json.is_string()) return json.get<std::string>();
  if (!json.is_structured()) return std::monostate{};
  auto table = std::make_shared<ScriptTable>();
  if (json.is_array())
    for (const PlainJson& item : json) table->items.push_back(value_of(item));
  else
    for (const auto& [name, entry] : json.items())
      if (!entry.is_null()) table->fields.emplace(name, value_of(entry));
  return TableHandle(table);
}

}  // namespace

bool is_plain(const ScriptValue& value) {
  if (const auto* table = std::get_if<TableHandle>(&value))
    return (*table)->other_keys.empty() && std::all_of((*table)->items.begin(), (*table)->items.end(), is_plain) &&
           std::all_of((*table)->fields.begin(), (*table)->fields.end(), [](const auto& entry) { return is_plain(entry.second); });
  return std::holds_alternative<std::monostate>(value) || std::holds_alternative<bool>(value) || std::holds_alternative<std::int64_t>(value) ||
         std::holds_alternative<double>(value) || std::holds_alternative<std::string>(value);
}

std::string to_json(const ScriptValue& value) { return json_of(value).dump(-1, ' ', false, PlainJson::error_handler_t::replace); }

std::string to_result(const ScriptValue& value) { return is_plain(value) || std::holds_alternative<TableHandle>(value) ? to_json(value) : "null"; }

ScriptValue value_of_json(std::string_view text) {
  const PlainJson json = PlainJson::parse(text, nullptr, false);
  if (json.is_discarded())
    throw Error({.code = ErrorCode::file_malformed, .attempted = "reading JSON", .problem = "it is not JSON: " + std::string(text.substr(0, 100))});
  return value_of(json);
}

}  // namespace sterna::scripting
