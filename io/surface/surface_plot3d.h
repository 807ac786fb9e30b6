// PLOT3D surfaces of several blocks, whole format: text, Fortran records, plain binary.
#pragma once

#include <filesystem>

#include "geom/base/run_context.h"
#include "geom/mesh/surface_soup.h"

namespace sterna::io {

/// Reads each block as a patch of quads, "patch_<number>"; one of the three dimensions of a block must be 1. Byte order, precision and a trailing IBLANK array
/// are derived from the sizes.
/// \throws Error file_not_found, file_malformed (line or byte offset), unsupported_format (volume blocks), overflow, cancelled.
SurfaceSoup read_plot3d(const std::filesystem::path& path, const RunContext& context);

}  // namespace sterna::io
