#include "geom/base/rules.h"

#include <cstdint>
#include <utility>

namespace sterna {
namespace {

/// Returns true if a value stands for an option that the rule does not set.
bool stands_for_all(const Option& option, const OptionValue& value) {
  if (const double* number = std::get_if<double>(&value)) return is_automatic(*number);
  return (option.kind == OptionKind::integer || option.kind == OptionKind::string) && value == option.default_value;
}

OptionValue value_for_all(const Option& option) {
  if (option.kind == OptionKind::number) return k_automatic;
  if (option.kind == OptionKind::integer) return std::int64_t{k_automatic_count};
  if (option.kind == OptionKind::string && !option.choices.empty()) return std::string(detail::choice_at(option.choices, 0));
  return option.default_value;
}

}  // namespace

bool is_set(const Rule& rule, std::string_view option) { return rule.options.contains(option); }

const Rule* rule_for(std::string_view patch, std::span<const Rule> rules, std::string_view option) {
  for (std::size_t i = rules.size(); i-- > 0;)
    if (is_set(rules[i], option) && matches_glob(patch, rules[i].names)) return &rules[i];
  return nullptr;
}

OptionTable options_of(Rule& rule, std::span<const RuleOption> listed, const OptionTable& of_all) {
  OptionTable table;
  for (const RuleOption& own : listed) {
    Option option = find_option(of_all, own.name, "describing the options of rules");
    option.stage = "patches";
    option.required = false;
    option.automatic = own.automatic;
    if (!own.help.empty()) option.help = own.help;
    if (!own.choices.empty()) option.choices = own.choices;
    if (option.kind == OptionKind::integer) option.min = k_automatic_count;
    option.default_value = value_for_all(option);
    option.get = [&rule, name = own.name, unset = option.default_value] {
      const auto found = rule.options.find(name);
      return found == rule.options.end() ? unset : found->second;
    };
    option.store = [&rule, description = option](const OptionValue& value) {
      if (stands_for_all(description, value)) rule.options.erase(std::string(description.name));
      else rule.options.insert_or_assign(std::string(description.name), value);
    };
    table.push_back(std::move(option));
  }
  return table;
}

}  // namespace sterna
