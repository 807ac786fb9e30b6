// Numbers as users type them on the command line: options, --set, rules of patches, sources, discs, farfields, flow conditions, gates and cases.
// Only this file defines the unit of a number that is given without a unit: metres, degrees, kelvin, seconds, bytes. Scripts use SI and do not call these
// functions.
#pragma once

#include <string>
#include <string_view>
#include <vector>

#include "geom/base/schema.h"

namespace sterna::scripting {

/// Returns "0.5", "2.5mm", "35", "35deg", "0.6rad", "288.15K" in SI.
/// \throws Error(bad_argument) if the string is no number, or its unit is of another dimension
double typed_number(std::string_view text, Unit expected);

/// Sets an option from such a string. Lengths may also be a unit alone ("mm" is 1 mm) or follow from the flow ("y_plus 1 mach=0.78 ...").
/// \throws Error(bad_argument)
void set_option_as_typed(const Option& option, std::string_view text);

/// Sets the options of a string such as "radius=1.2m center=0,0,1"; a name may follow several words without "=", which are returned.
/// \throws Error(bad_argument, or unknown_option with a suggestion); \p attempted starts the message
std::vector<std::string> set_options_as_typed(const OptionTable& options, std::string_view text, std::string_view attempted);

}  // namespace sterna::scripting
