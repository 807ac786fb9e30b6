// Writes the geometry of a failure, so that a user can look at it.
#pragma once

#include <filesystem>

#include "geom/base/error.h"

namespace sterna::io {

/// VTU with the triangles, edges and vertices of the failure.
/// \throws Error(write_failed).
void write_trouble_vtu(const TroubleGeometry& geometry, const std::filesystem::path& path);

}  // namespace sterna::io
