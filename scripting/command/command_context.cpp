#include "scripting/command/command_context.h"

#include <algorithm>
#include <cstddef>
#include <map>
#include <utility>
#include <vector>

#include "geom/base/error.h"
#include "scripting/values/typed_number.h"
#include "scripting/values/verbs.h"

namespace sterna::scripting {
namespace {

/// Returns the options to which no name on the command line refers, not even a misspelt one or one with a refused value, so that each mistake is reported once.
OptionTable not_meant(const OptionTable& table, const OptionOverrides& given) {
  OptionTable result;
  for (const Option& option : table) {
    const std::vector<std::string> names{std::string(option.name), std::string(option.stage) + "." + std::string(option.name)};
    if (std::ranges::none_of(given, [&](const auto& entry) { return !nearest_name(entry.first, names).empty(); })) result.push_back(option);
  }
  return result;
}

bool has_option(const OptionTable& table, const std::string& name) {
  return std::ranges::any_of(table,
                             [&](const Option& option) { return option.name == name || std::string(option.stage) + "." + std::string(option.name) == name; });
}

std::string why_elsewhere(const OptionTable& table, const std::string& name, const std::vector<OptionsElsewhere>& elsewhere) {
  if (has_option(table, name)) return {};
  for (const OptionsElsewhere& other : elsewhere)
    if (has_option(other.table, name)) return other.why;
  return {};
}

}  // namespace

void set_options(const OptionTable& table, const OptionOverrides& given, const CommandContext& context, const std::vector<OptionsElsewhere>& elsewhere) {
  std::string problems;
  std::size_t n_problems = 0;
  std::map<std::string, std::pair<std::string, OptionValue>> before;  // settings that the options had before, by full name
  for (const auto& [name, text] : given) {
    try {
      if (const std::string why = why_elsewhere(table, name, elsewhere); !why.empty())
        throw Error({.code = ErrorCode::bad_argument, .attempted = "option " + name, .problem = why});
      const Option& option = find_option(table, name, "option " + name);
      set_option_as_typed(option, text);
      const auto [same, is_new] = before.try_emplace(std::string(option.stage) + "." + std::string(option.name), text, option.get());
      if (!is_new && same->second.second != option.get())
        throw Error({.code = ErrorCode::bad_argument,
                     .attempted = "option " + name,
                     .problem = same->first + " is given twice, as " + same->second.first + " and as " + text});
    } catch (const Error& error) {
      problems += "\n  - " + error.info().attempted + ": " + error.info().problem + (error.info().hint.empty() ? "" : " (" + error.info().hint + ")");
      ++n_problems;
    }
  }
  try {
    require_options(n_problems == 0 ? table : not_meant(table, given), "mesh");
  } catch (const Error& error) {
    problems += "\n  - " + error.info().problem;
    ++n_problems;
  }
  if (n_problems == 0 && context.only_options) throw OptionsShown{options_to_json(table)};
  if (n_problems == 0) return;
  throw Error({.code = ErrorCode::bad_argument,
               .attempted = "reading the options",
               .problem = n_problems == 1 ? problems.substr(5) : std::to_string(n_problems) + " problems" + problems});
}

namespace {

template <class IsTaken>
OptionOverrides take_if(OptionOverrides& given, IsTaken is_taken) {
  const auto rest = std::ranges::stable_partition(given, is_taken);
  OptionOverrides taken(std::make_move_iterator(given.begin()), std::make_move_iterator(rest.begin()));
  given.erase(given.begin(), rest.begin());
  return taken;
}

}  // namespace

OptionOverrides take_options(OptionOverrides& given, const OptionTable& table) {
  return take_if(given, [&](const auto& entry) { return has_option(table, entry.first); });
}

OptionOverrides take_stage(OptionOverrides& given, std::string_view stage) {
  return take_if(given, [&](const auto& entry) { return entry.first.starts_with(std::string(stage) + "."); });
}

void refuse_without_effect(const std::vector<std::string>& given, std::initializer_list<std::string_view> without_effect, const std::string& attempted,
                           const std::string& why, const std::string& hint) {
  std::string names;
  int n = 0;
  for (const std::string_view name : without_effect) {
    if (std::ranges::find(given, name) == given.end()) continue;
    names += (names.empty() ? "" : ", ") + std::string(name);
    ++n;
  }
  if (n == 0) return;
  throw Error({.code = ErrorCode::bad_argument, .attempted = attempted, .problem = names + (n == 1 ? " has" : " have") + " no effect: " + why, .hint = hint});
}

}  // namespace sterna::scripting
