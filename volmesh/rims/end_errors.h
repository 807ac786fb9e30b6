// Errors of end surfaces: all name the patch and draw its loops.
#pragma once

#include <string>

#include "geom/base/error.h"
#include "volmesh/rims/end_surface.h"

namespace sterna::volmesh {

/// With the loops as geometry; places are to be added.
ErrorInfo end_error(const EndRegion& region, ErrorCode code, std::string problem);

inline constexpr int k_end_digits = 3;  ///< of lengths in these errors

}  // namespace sterna::volmesh
