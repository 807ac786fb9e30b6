// Another value than the default for any option, from what the schema says of it.
#pragma once

#include <string>

#include "geom/base/schema.h"
#include "scripting/interpreter/script_help.h"

namespace sterna::scripting {

/// A value of the option within its range that is not its default.
OptionValue other_value(const Option& option);
/// As the command line takes it: SI, 17 digits.
std::string text_of(const OptionValue& value);

/// The same from the help of a verb, as text of Lua.
std::string other_value(const OptionDoc& option);

}  // namespace sterna::scripting
