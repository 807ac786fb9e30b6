// Errors of adjacent patches. All of them name the patch and contain its loops as a drawing.
#pragma once

#include <string>

#include "geom/base/error.h"
#include "volmesh/adjacent/adjacent_surface.h"

namespace sterna::volmesh {

/// Returns an error with the loops as a drawing. The caller adds locations.
ErrorInfo adjacent_error(const AdjacentRegion& region, ErrorCode code, std::string problem);

inline constexpr int k_adjacent_digits = 3;  ///< number of digits of lengths in these errors

}  // namespace sterna::volmesh
