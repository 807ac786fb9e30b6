// PLY as text or binary of either byte order; an integer face property can number patches.
#pragma once

#include <filesystem>

#include "geom/base/run_context.h"
#include "geom/mesh/surface_soup.h"
#include "geom/mesh/tri_mesh.h"

namespace sterna::io {

/// Reads the surface in a PLY file, plain or gzipped; coordinates as in the file.
/// \throws Error file_not_found, file_malformed (location, what was found, what was expected), unsupported_format, cancelled.
SurfaceSoup read_ply(const std::filesystem::path& path, const RunContext& context);

/// Writes binary little endian with doubles. Faces have an integer "patch" from 1, with a comment "patch <number> <name>" per patch.
/// \throws Error write_failed, overflow (31-bit indices), cancelled.
void write_ply(const TriMesh& mesh, const std::filesystem::path& path, const RunContext& context);

}  // namespace sterna::io
