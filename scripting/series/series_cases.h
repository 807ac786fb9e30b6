// The cases of a series, derived from `over`, and the names of cases.
#pragma once

#include <cstddef>
#include <string>
#include <vector>

#include "scripting/lua/script_value.h"

namespace sterna::scripting {

struct SeriesCase {
  std::size_t index = 0;   ///< from 1, in the order of the list
  std::string name;        ///< unique in its series; only letters, digits and . + - _ = ~, as it is also the folder name
  ScriptTable parameters;  ///< plain values by name
};

/// Returns true if the name is valid as a folder name everywhere: it consists of letters, digits and . + - _ = only, is not empty and does not begin with a
/// dot.
bool is_safe_name(const std::string& name);

/// Returns the cases of over = .... For { alpha = {0, 4}, beta = {0, 5} } these are the product, with names in alphabetical order and the last name changing
/// fastest; a value that is not a list counts as a list of one. Entries without name are tables of parameters, or lists of such tables (zip{}). They come
/// before the named entries, which thus change faster. A case is named by its parameters ("alpha=-4_beta=0"), or by the parameter `name`. Long and ambiguous
/// names end with a hash.
/// \throws Error(bad_argument) for values that are not plain, for empty lists, for two cases with the same parameters or the same given name, and for more than
/// k_max_cases.
std::vector<SeriesCase> cases_of(const ScriptTable& over);

/// Converts {alpha = {0, 1}, bend = {0, 0.1}} to a list of tables { {alpha = 0, bend = 0}, {alpha = 1, bend = 0.1} }.
/// \throws Error(bad_argument) if the lists differ in length
ScriptValue zipped(const ScriptTable& lists);

/// Returns first, first + step, ... up to last. The last value is included within a tolerance of a millionth of a step. All are whole numbers if both first and
/// step are.
/// \throws Error(bad_argument) for steps that never reach last
ScriptValue range_of(const ScriptValue& first, const ScriptValue& last, const ScriptValue& step);

inline constexpr std::size_t k_max_cases = 100000;

}  // namespace sterna::scripting
