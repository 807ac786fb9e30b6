// Gmsh MSH 4.1 and 2.2, text and binary: triangles and quads; physical groups (or entities) are patches.
#pragma once

#include <filesystem>

#include "geom/base/run_context.h"
#include "geom/mesh/surface_soup.h"

namespace sterna::io {

/// Reads the surface in an MSH file, plain or gzipped; coordinates as in the file.
/// \throws Error file_not_found, file_malformed (place, what was found, what was expected), unsupported_format, cancelled.
SurfaceSoup read_msh(const std::filesystem::path& path, const RunContext& context);

}  // namespace sterna::io
