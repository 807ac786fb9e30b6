// Numbers as users write them in options, with a unit of the expected dimension.
#pragma once

#include <string_view>

#include "geom/base/schema.h"

namespace sterna {

/// Kelvin, of options that are temperatures or differences of temperatures. (Beside the enumeration, whose header everything includes.)
inline constexpr Unit k_kelvin{5};

/// The unit of an angle that is given as a number alone: files that the program writes hold radians, the command line takes degrees.
enum class BareAngle { radians, degrees };

/// Numbers with a unit suffix ("mm", "um", "cm", "inch", "ft", "deg", "K") in SI; both "2*mm" and "2mm". A number alone is in SI, an angle as `bare_angle`
/// says. \throws Error(bad_argument) where it is no number, or its unit is not one of `expected`: 12deg is no length, and what has no unit takes none
double parse_number_with_unit(std::string_view text, Unit expected, BareAngle bare_angle);

/// set_option_from_text with the unit of angles that have none.
/// \throws Error(bad_argument)
void set_option_from_text(const Option& option, std::string_view text, BareAngle bare_angle);

}  // namespace sterna
