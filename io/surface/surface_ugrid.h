// UGRID (AFLR3): the boundary faces; patch numbers, named by a .mapbc file beside it.
#pragma once

#include <filesystem>

#include "geom/base/run_context.h"
#include "geom/mesh/surface_soup.h"
#include "geom/mesh/tri_mesh.h"

namespace sterna::io {

/// Reads the surface in an UGRID file, plain or gzipped; coordinates as in the file.
/// \throws Error file_not_found, file_malformed (place, what was found, what was expected), unsupported_format, cancelled.
SurfaceSoup read_ugrid(const std::filesystem::path& path, const RunContext& context);

/// Writes the surface as the boundary of a mesh without cells, normals as in `mesh` (into the fluid), variant by the name as in reading; names go to the .mapbc
/// file beside it.
/// \throws Error write_failed, overflow (31-bit counts), cancelled.
void write_ugrid(const TriMesh& mesh, const std::filesystem::path& path, const RunContext& context);

}  // namespace sterna::io
