// VTU output of the geometry of a failure, for inspection by the user.
#pragma once

#include <filesystem>

#include "geom/base/error.h"

namespace sterna::io {

/// Writes a VTU file with the triangles, edges and vertices of the failure.
/// \throws Error(write_failed).
void write_trouble_vtu(const TroubleGeometry& geometry, const std::filesystem::path& path);

}  // namespace sterna::io
