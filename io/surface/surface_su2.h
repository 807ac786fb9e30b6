// SU2: the boundary markers of a volume mesh, or the elements of a surface mesh.
#pragma once

#include <filesystem>

#include "geom/base/run_context.h"
#include "geom/mesh/surface_soup.h"
#include "geom/mesh/tri_mesh.h"

namespace sterna::io {

/// Reads the surface in an SU2 file, plain or gzipped; coordinates as in the file.
/// \throws Error file_not_found, file_malformed (location, what was found, what was expected), unsupported_format, cancelled.
SurfaceSoup read_su2(const std::filesystem::path& path, const RunContext& context);

/// Writes the surface as markers of a mesh without elements, with normals as in `mesh`. Names that SU2 does not accept are changed, with a warning.
/// \throws Error write_failed, overflow (31-bit counts), cancelled.
void write_su2(const TriMesh& mesh, const std::filesystem::path& path, const RunContext& context);

}  // namespace sterna::io
