// Numbers as users write them in options, with a unit of the expected dimension.
#pragma once

#include <string_view>

#include "geom/base/schema.h"

namespace sterna {

/// Kelvin: unit of options that are temperatures or temperature differences. (Declared here and not in the header of the enumeration, which everything
/// includes.)
inline constexpr Unit k_kelvin{5};

/// Unit of an angle given as a plain number: files written by the program hold radians, the command line takes degrees.
enum class BareAngle { radians, degrees };

/// Parses a number with an optional unit suffix ("mm", "um", "cm", "inch", "ft", "deg", "K") and returns it in SI; accepts both "2*mm" and "2mm". A plain
/// number is in SI; for angles `bare_angle` gives the unit.
/// \throws Error(bad_argument) if the text is not a number or its unit is not one of `expected`: 12deg is not a length, and a dimensionless quantity takes no
/// unit
double parse_number_with_unit(std::string_view text, Unit expected, BareAngle bare_angle);

/// Calls set_option_from_text with the unit assumed for angles given without one.
/// \throws Error(bad_argument)
void set_option_from_text(const Option& option, std::string_view text, BareAngle bare_angle);

}  // namespace sterna
