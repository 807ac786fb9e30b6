// Numbers as users type them on the command line: options, --set, rules of patches, sources, discs, farfields, flow conditions, gates and cases.
// This is the one place that says what a number without a unit is: metres, degrees, kelvin, seconds, bytes. Scripts count in SI and never come here.
#pragma once

#include <string_view>

#include "geom/base/schema.h"

namespace sterna::scripting {

/// "0.5", "2.5mm", "35", "35deg", "0.6rad", "288.15K" in SI.
/// \throws Error(bad_argument) where it is no number, or its unit is of another dimension
double typed_number(std::string_view text, Unit expected);

/// Sets an option from such a text. Lengths may also be a unit alone ("mm" is 1 mm) or follow from the flow ("y_plus 1 mach=0.78 ...").
/// \throws Error(bad_argument)
void set_option_as_typed(const Option& option, std::string_view text);

}  // namespace sterna::scripting
