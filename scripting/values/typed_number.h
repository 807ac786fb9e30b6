// Numbers as users type them on the command line: options, --set, rules of patches, sources, discs, farfields, flow conditions, gates and cases.
// Only this file defines the unit of a number that is given without a unit: metres, degrees, kelvin, seconds, bytes. Scripts use SI and do not call these
// functions.
#pragma once

#include <string_view>

#include "geom/base/schema.h"

namespace sterna::scripting {

/// Returns "0.5", "2.5mm", "35", "35deg", "0.6rad", "288.15K" in SI.
/// \throws Error(bad_argument) if the string is no number, or its unit is of another dimension
double typed_number(std::string_view text, Unit expected);

/// Sets an option from such a string. Lengths may also be a unit alone ("mm" is 1 mm) or follow from the flow ("y_plus 1 mach=0.78 ...").
/// \throws Error(bad_argument)
void set_option_as_typed(const Option& option, std::string_view text);

}  // namespace sterna::scripting
