// Values other than the default for any option, derived from the schema of the option.
#pragma once

#include <string>

#include "geom/base/schema.h"
#include "scripting/interpreter/script_help.h"

namespace sterna::scripting {

/// Returns a value within the option's range that is not its default.
OptionValue other_value(const Option& option);
/// Returns the value in the syntax of the command line: SI units, 17 digits.
std::string text_of(const OptionValue& value);

/// Returns such a value from the help of a verb, in Lua syntax.
std::string other_value(const OptionDoc& option);

}  // namespace sterna::scripting
