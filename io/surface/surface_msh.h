// Gmsh MSH 4.1 and 2.2, text and binary: triangles and quads; physical groups (or entities) are patches.
#pragma once

#include <filesystem>

#include "geom/base/run_context.h"
#include "geom/mesh/surface_soup.h"
#include "geom/mesh/tri_mesh.h"

namespace sterna::io {

/// Reads the surface in an MSH file, plain or gzipped; coordinates as in the file.
/// \throws Error file_not_found, file_malformed (location, what was found, what was expected), unsupported_format, cancelled.
SurfaceSoup read_msh(const std::filesystem::path& path, const RunContext& context);

/// Writes MSH 4.1 (2.2) as text in full precision, with a surface entity and a physical group per patch.
/// \throws Error write_failed, cancelled.
void write_msh(const TriMesh& mesh, const std::filesystem::path& path, const RunContext& context);
void write_msh_2_2(const TriMesh& mesh, const std::filesystem::path& path, const RunContext& context);

}  // namespace sterna::io
