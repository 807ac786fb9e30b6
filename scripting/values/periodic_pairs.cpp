#include "scripting/values/periodic_pairs.h"

#include <optional>

#include "geom/base/error.h"
#include "scripting/lua/verb_tools.h"

namespace sterna::scripting {
namespace {

constexpr std::string_view k_expected = "expected the names of two patches, such as { \"left\", \"right\" }";

std::optional<PeriodicNames> pair_of(const ScriptTable& table) {
  if (table.items.size() != 2 || !table.fields.empty() || !table.other_keys.empty()) return std::nullopt;
  const auto *first = std::get_if<std::string>(&table.items[0]), *second = std::get_if<std::string>(&table.items[1]);
  if (!first || !second) return std::nullopt;
  return PeriodicNames{*first, *second};
}

}  // namespace

std::vector<PeriodicNames> read_periodic(TableReader& reader) {
  const ScriptValue* value = reader.field("periodic");
  if (!value) return {};
  const auto* table = std::get_if<TableHandle>(value);
  if (!table || (*table)->items.empty()) {
    reader.add_problem("periodic: " + std::string(k_expected) + " or a list of such pairs");
    return {};
  }
  if (const std::optional<PeriodicNames> single = pair_of(**table)) return {*single};
  std::vector<PeriodicNames> pairs;
  for (std::size_t i = 0; i < (*table)->items.size(); ++i) {
    const auto* entry = std::get_if<TableHandle>(&(*table)->items[i]);
    const std::optional<PeriodicNames> pair = entry ? pair_of(**entry) : std::nullopt;
    if (pair) pairs.push_back(*pair);
    else reader.add_problem("periodic, entry " + std::to_string(i + 1) + ": " + std::string(k_expected));
  }
  return pairs;
}

PeriodicNames periodic_of_text(const std::string& text) {
  const std::size_t comma = text.find(',');
  if (comma == std::string::npos || comma == 0 || comma + 1 == text.size() || text.find(',', comma + 1) != std::string::npos)
    throw Error({.code = ErrorCode::bad_argument,
                 .attempted = "option --periodic",
                 .problem = "\"" + text + "\" does not consist of two names of patches",
                 .hint = "such as --periodic left,right"});
  return {text.substr(0, comma), text.substr(comma + 1)};
}

Json periodic_json(const std::vector<PeriodicNames>& pairs) {
  Json list = Json::array();
  for (const PeriodicNames& pair : pairs) list.push_back({pair.first, pair.second});
  return list;
}

std::vector<PeriodicNames> periodic_of_json(const Json& list) {
  const auto fail = [] {
    throw Error({.code = ErrorCode::bad_argument, .attempted = "reading periodic sides", .problem = "expected a list of pairs of names"});
  };
  if (!list.is_array()) fail();
  std::vector<PeriodicNames> pairs;
  for (const Json& pair : list) {
    if (!pair.is_array() || pair.size() != 2 || !pair[0].is_string() || !pair[1].is_string()) fail();
    pairs.push_back({pair[0].get<std::string>(), pair[1].get<std::string>()});
  }
  return pairs;
}

}  // namespace sterna::scripting
