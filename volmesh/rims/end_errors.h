// Errors of adjacent patches. All of them name the patch and contain its loops as a drawing.
#pragma once

#include <string>

#include "geom/base/error.h"
#include "volmesh/rims/end_surface.h"

namespace sterna::volmesh {

/// Returns an error with the loops as a drawing. The caller adds locations.
ErrorInfo end_error(const EndRegion& region, ErrorCode code, std::string problem);

inline constexpr int k_end_digits = 3;  ///< number of digits of lengths in these errors

}  // namespace sterna::volmesh
