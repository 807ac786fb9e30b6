// The cases of a series: what `over` says, and the names of cases.
#pragma once

#include <cstddef>
#include <string>
#include <vector>

#include "scripting/lua/script_value.h"

namespace sterna::scripting {

struct SeriesCase {
  std::size_t index = 0;   ///< from 1, in the order of the list
  std::string name;        ///< unique in its series, of letters, digits and . + - _ = ~ only: also the name of its folder
  ScriptTable parameters;  ///< plain values by name
};

/// Letters, digits and . + - _ = only, not a dot first, not empty: what can be the name of a folder everywhere.
bool is_safe_name(const std::string& name);

/// The cases of over = ...: of { alpha = {0, 4}, beta = {0, 5} } the product, names in alphabetical order, the last of them changing fastest; a value that is
/// no list counts as a list of one. Entries without name are tables of parameters, or lists of such tables (zip{}); they come before the named ones, so those
/// change faster. A case is called by its parameters ("alpha=-4_beta=0"), or as the parameter `name` says; long and doubtful names end with a hash.
/// \throws Error(bad_argument) for values that are not plain, empty lists, two cases with the same parameters or the same given name, more than k_max_cases.
std::vector<SeriesCase> cases_of(const ScriptTable& over);

/// {alpha = {0, 1}, bend = {0, 0.1}} as a list of tables { {alpha = 0, bend = 0}, {alpha = 1, bend = 0.1} }.
/// \throws Error(bad_argument) where the lists differ in length
ScriptValue zipped(const ScriptTable& lists);

/// first, first + step, ... up to last, which is met within a millionth of a step; whole numbers where both first and step are.
/// \throws Error(bad_argument) for steps that never arrive
ScriptValue range_of(const ScriptValue& first, const ScriptValue& last, const ScriptValue& step);

inline constexpr std::size_t k_max_cases = 100000;

}  // namespace sterna::scripting
