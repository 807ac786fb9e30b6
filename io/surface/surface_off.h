// OFF, COFF, NOFF, STOFF, 4OFF as text and OFF BINARY; no patches.
#pragma once

#include <filesystem>

#include "geom/base/run_context.h"
#include "geom/mesh/surface_soup.h"
#include "geom/mesh/tri_mesh.h"

namespace sterna::io {

/// Reads the surface in an OFF file, plain or gzipped; coordinates as in the file.
/// \throws Error file_not_found, file_malformed (location, what was found, what was expected), unsupported_format, cancelled.
SurfaceSoup read_off(const std::filesystem::path& path, const RunContext& context);

/// Writes text in full precision; the format has no patches.
/// \throws Error write_failed, cancelled.
void write_off(const TriMesh& mesh, const std::filesystem::path& path, const RunContext& context);

}  // namespace sterna::io
