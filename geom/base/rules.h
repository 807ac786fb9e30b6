// Rules: options of the patches whose names match a pattern, over the options for all patches. A rule can set any option that has a Field, so that an
// option for all patches needs no second member for single ones.
#pragma once

#include <functional>
#include <map>
#include <span>
#include <string>
#include <string_view>
#include <type_traits>

#include "geom/base/glob.h"
#include "geom/base/schema.h"

namespace sterna {

/// Options for the patches whose names match a pattern. An option without an entry has its value for all patches.
struct Rule {
  std::string names;  ///< pattern of names, such as "wing*": "*" matches any characters, "?" any single one
  std::map<std::string, OptionValue, std::less<>> options;
};

/// Returns the value that the rule sets for an option, or `otherwise` if it sets none.
/// \pre V is the type of the option: bool, int, double, std::string ...
template <class V>
V value_or(const Rule& rule, std::string_view option, V otherwise) {
  const auto found = rule.options.find(option);
  if (found == rule.options.end()) return otherwise;
  if constexpr (std::is_same_v<V, int>) return static_cast<int>(std::get<std::int64_t>(found->second));
  else return std::get<V>(found->second);
}

/// Returns true if the rule sets the option.
bool is_set(const Rule& rule, std::string_view option);

/// Returns the rule whose value of an option applies to the patch: the last one that matches its name and sets the option. Null: no rule sets the option.
const Rule* rule_for(std::string_view patch, std::span<const Rule> rules, std::string_view option);

/// Returns the options of the patch: those of all patches, replaced by the rules that match its name, in their order. Options of rules that T does not have
/// belong to other structs.
/// \pre the values have the types of the options (set_option)
template <class T>
T resolve(T of_all, std::span<const Rule> rules, std::string_view patch) {
  for (const Rule& rule : rules) {
    if (rule.options.empty() || !matches_glob(patch, rule.names)) continue;
    for (const Field<T>& field : Schema<T>::fields)
      if (const auto found = rule.options.find(field.name); found != rule.options.end()) store_member(of_all, field, found->second);
  }
  return of_all;
}

/// An option that rules may set: the option for all patches of the same name, with texts of its own. Unit, range and kind are those of the option for all
/// patches.
struct RuleOption {
  std::string_view name;
  std::string_view help = {};       ///< empty: the help of the option for all patches
  std::string_view automatic = {};  ///< numbers: meaning of "automatic", the value that stands for an option which the rule does not set
  std::string_view choices = {};    ///< strings: allowed values; the first one stands for an option which the rule does not set
};

/// Returns the listed options as users see them. The default of an option stands for the value for all patches: automatic, -1 for whole numbers, or the first
/// of the choices. Storing this default removes the option from the rule. `rule` must outlive the table. \param of_all options for all patches; used for their
/// descriptions only \throws Error(unknown_option) if a listed option is not among them
OptionTable options_of(Rule& rule, std::span<const RuleOption> listed, const OptionTable& of_all);

}  // namespace sterna
