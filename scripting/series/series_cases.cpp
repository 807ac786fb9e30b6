#include "scripting/series/series_cases.h"

#include <algorithm>
#include <array>
#include <charconv>
#include <cmath>
#include <cstdio>
#include <map>
#include <memory>

#include "geom/base/error.h"
#include "geom/base/hash.h"
#include "scripting/values/value_json.h"

namespace sterna::scripting {
namespace {

/// Axis of the product of cases. A case takes one choice of each axis and merges them.
using Axis = std::vector<ScriptTable>;

/// Maximum bytes of a folder name: file systems accept 255, and a path holds several names.
constexpr std::size_t k_max_name = 100;
/// Fraction of a step by which rounding may miss the last value of a range.
constexpr double k_range_slack = 1e-6;

[[noreturn]] void refuse(std::string problem, std::string hint = {}) {
  throw Error({.code = ErrorCode::bad_argument, .attempted = "over", .problem = std::move(problem), .hint = std::move(hint)});
}

bool is_list(const ScriptTable& table) { return table.fields.empty() && table.other_keys.empty() && !table.items.empty(); }

void require_parameters(const ScriptTable& table) {
  if (!table.items.empty() || !table.other_keys.empty()) refuse("every parameter of a case needs a name");
  if (table.fields.empty()) refuse("a case has no parameters");
  for (const auto& [name, value] : table.fields) {
    if (!is_plain(value))
      refuse(name + ": " + std::string(type_text(value)) + " cannot be a parameter",
             "parameters are numbers, strings, true or false, and tables of these: make objects inside case = function(p)");
    if (name == "index") refuse("index: this name is reserved, p.index is the number of the case");
  }
}

Axis axis_of_list(const ScriptTable& list) {
  Axis axis;
  for (const ScriptValue& item : list.items) {
    const auto* table = std::get_if<TableHandle>(&item);
    if (!table)
      refuse("expected tables of parameters, not " + std::string(type_text(item)), "over = { alpha = {0, 4} }  or  over = { {alpha = 0}, {alpha = 4} }");
    require_parameters(**table);
    axis.push_back(**table);
  }
  return axis;
}

Axis axis_of_values(const std::string& name, const ScriptValue& value) {
  const auto* list = std::get_if<TableHandle>(&value);
  std::vector<ScriptValue> values = {value};
  if (list && is_list(**list)) values = (*list)->items;
  if (list && (*list)->items.empty() && (*list)->fields.empty()) refuse(name + ": the list is empty");
  Axis axis;
  for (const ScriptValue& one : values) {
    ScriptTable table;
    table.fields.emplace(name, one);
    require_parameters(table);
    axis.push_back(std::move(table));
  }
  return axis;
}

std::vector<Axis> axes_of(const ScriptTable& over) {
  std::vector<Axis> axes;
  if (!over.other_keys.empty()) refuse("key " + over.other_keys.front() + ": keys must be names");
  const bool is_of_lists = std::any_of(over.items.begin(), over.items.end(), [](const ScriptValue& item) {
    const auto* table = std::get_if<TableHandle>(&item);
    return table && is_list(**table);
  });
  if (is_of_lists) {
    for (const ScriptValue& item : over.items) {
      const auto* table = std::get_if<TableHandle>(&item);
      if (!table || !is_list(**table))
        refuse("lists of cases and single cases cannot be mixed", "over = { zip{ ... }, beta = {0, 5} }  or  over = { {alpha = 0}, {alpha = 4} }");
      axes.push_back(axis_of_list(**table));
    }
  } else if (!over.items.empty()) {
    axes.push_back(axis_of_list(over));
  }
  for (const auto& [name, value] : over.fields) axes.push_back(axis_of_values(name, value));
  if (axes.empty()) refuse("there are no cases");
  return axes;
}

std::string number_text(double value) {
  std::array<char, 32> text{};
  const auto end = std::to_chars(text.data(), text.data() + text.size(), value == 0.0 ? 0.0 : value).ptr;  // avoids negative zero
  return {text.data(), end};
}

/// Returns the value as text for a name. Sets `is_doubtful` if another value could have the same text.
std::string text_of(const ScriptValue& value, bool& is_doubtful) {
  if (const auto* whole = std::get_if<std::int64_t>(&value)) return std::to_string(*whole);
  if (const auto* number = std::get_if<double>(&value)) return number_text(*number);
  if (const auto* flag = std::get_if<bool>(&value)) return *flag ? "true" : "false";
  std::string text;
  if (const auto* given = std::get_if<std::string>(&value)) text = *given;
  else is_doubtful = true;
  for (char& c : text) {
    const bool is_safe = (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z') || (c >= '0' && c <= '9') || c == '.' || c == '+' || c == '-' || c == '_';
    if (is_safe) continue;
    c = '-';
    is_doubtful = true;
  }
  return text;
}

std::string short_hash(const ScriptTable& parameters) {
  std::array<char, 17> text{};
  std::snprintf(text.data(), text.size(), "%016llx", static_cast<unsigned long long>(hash_bytes(to_json(std::make_shared<const ScriptTable>(parameters)))));
  return {text.data(), 8};
}

std::string name_of(const ScriptTable& parameters) {
  if (const auto given = parameters.fields.find("name"); given != parameters.fields.end()) {
    const auto* name = std::get_if<std::string>(&given->second);
    if (!name || !is_safe_name(*name) || name->size() > k_max_name) refuse("name: names of cases have letters, digits and . + - _ = only (at most 100)");
    return *name;
  }
  std::string name;
  bool is_doubtful = false;
  for (const auto& [parameter, value] : parameters.fields) {
    std::string key = text_of(parameter, is_doubtful);
    name += (name.empty() ? "" : "_") + key + "=" + text_of(value, is_doubtful);
  }
  if (name.size() > k_max_name) {
    name.resize(k_max_name);
    is_doubtful = true;
  }
  if (name.front() == '.') name.front() = '-';
  return is_doubtful ? name + "~" + short_hash(parameters) : name;
}

}  // namespace

bool is_safe_name(const std::string& name) {
  return !name.empty() && name.front() != '.' &&
         name.find_first_not_of("abcdefghijklmnopqrstuvwxyzABCDEFGHIJKLMNOPQRSTUVWXYZ0123456789.+-_=") == std::string::npos;
}

std::vector<SeriesCase> cases_of(const ScriptTable& over) {
  std::vector<ScriptTable> tables = {{}};
  for (const Axis& axis : axes_of(over)) {
    if (tables.size() * axis.size() > k_max_cases) refuse("more than " + std::to_string(k_max_cases) + " cases");
    std::vector<ScriptTable> product;
    for (const ScriptTable& before : tables)
      for (const ScriptTable& choice : axis) {
        ScriptTable merged = before;
        for (const auto& [name, value] : choice.fields)
          if (!merged.fields.emplace(name, value).second) refuse(name + ": given twice");
        product.push_back(std::move(merged));
      }
    tables = std::move(product);
  }
  std::vector<SeriesCase> cases;
  std::map<std::string, std::size_t> known;
  for (ScriptTable& table : tables) {
    SeriesCase one{.index = cases.size() + 1, .name = name_of(table), .parameters = std::move(table)};
    const auto [same, is_new] = known.emplace(one.name, one.index);
    if (!is_new) refuse("cases " + std::to_string(same->second) + " and " + std::to_string(one.index) + " have the same name \"" + one.name + "\"");
    cases.push_back(std::move(one));
  }
  return cases;
}

ScriptValue zipped(const ScriptTable& lists) {
  auto result = std::make_shared<ScriptTable>();
  std::string first;
  std::size_t n = 0;
  if (!lists.items.empty() || !lists.other_keys.empty() || lists.fields.empty()) refuse("zip takes named lists", "zip{ alpha = {0, 4}, bend = {0, 0.02} }");
  for (const auto& [name, value] : lists.fields) {
    const auto* list = std::get_if<TableHandle>(&value);
    if (!list || !is_list(**list)) refuse(name + ": expected a list, not " + std::string(type_text(value)));
    if (first.empty()) {
      first = name;
      n = (*list)->items.size();
    }
    if ((*list)->items.size() != n) refuse(name + " has " + std::to_string((*list)->items.size()) + " values, " + first + " " + std::to_string(n));
  }
  for (std::size_t i = 0; i < n; ++i) {
    auto one = std::make_shared<ScriptTable>();
    for (const auto& [name, value] : lists.fields) one->fields.emplace(name, std::get<TableHandle>(value)->items[i]);
    result->items.emplace_back(TableHandle(one));
  }
  return TableHandle(result);
}

ScriptValue range_of(const ScriptValue& first, const ScriptValue& last, const ScriptValue& step) {
  const auto number = [](const ScriptValue& value, const char* what) {
    if (const auto* whole = std::get_if<std::int64_t>(&value)) return static_cast<double>(*whole);
    if (const auto* real = std::get_if<double>(&value); real && std::isfinite(*real)) return *real;
    const auto* infinite = std::get_if<double>(&value);
    throw Error({.code = ErrorCode::bad_argument,
                 .attempted = "range",
                 .problem = std::string(what) + ": expected a finite number, not " + (infinite ? number_text(*infinite) : std::string(type_text(value))),
                 .hint = "range(-4, 12, 2)"});
  };
  const bool has_step = !std::holds_alternative<std::monostate>(step);
  const double from = number(first, "first value"), to = number(last, "last value"), by = has_step ? number(step, "step") : 1.0;
  const double n = by == 0.0 ? -1.0 : std::floor((to - from) / by + k_range_slack);
  if (n < 0.0)
    throw Error({.code = ErrorCode::bad_argument,
                 .attempted = "range",
                 .problem = "from " + number_text(from) + " to " + number_text(to) + " in steps of " + number_text(by) + " there are no values",
                 .hint = "the step must lead from the first to the last value: range(-4, 12, 2)"});
  if (n >= static_cast<double>(k_max_cases))
    throw Error({.code = ErrorCode::bad_argument, .attempted = "range", .problem = "more than " + std::to_string(k_max_cases) + " values"});
  const bool is_whole = std::holds_alternative<std::int64_t>(first) && (!has_step || std::holds_alternative<std::int64_t>(step));
  auto values = std::make_shared<ScriptTable>();
  for (std::int64_t i = 0; i <= static_cast<std::int64_t>(n); ++i) {
    if (is_whole) values->items.emplace_back(std::get<std::int64_t>(first) + i * (has_step ? std::get<std::int64_t>(step) : 1));
    else values->items.emplace_back(from + static_cast<double>(i) * by);
  }
  return TableHandle(values);
}

}  // namespace sterna::scripting
