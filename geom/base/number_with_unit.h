// Numbers as users write them in options, with a unit of the expected dimension.
#pragma once

#include <string_view>

#include "geom/base/schema.h"

namespace sterna {

/// Numbers with a unit suffix ("mm", "um", "cm", "inch", "ft", "deg") in SI; both "2*mm" and "2mm". A bare number is in SI already.
/// \throws Error(bad_argument) where it is no number, or its unit is not one of `expected`: 12deg is no length, and what has no unit takes none
double parse_number_with_unit(std::string_view text, Unit expected);

}  // namespace sterna
