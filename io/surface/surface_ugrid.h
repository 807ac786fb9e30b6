// UGRID (AFLR3): boundary faces with patch numbers, named in a .mapbc file beside the mesh.
#pragma once

#include <filesystem>

#include "geom/base/run_context.h"
#include "geom/mesh/surface_soup.h"
#include "geom/mesh/tri_mesh.h"

namespace sterna::io {

/// Reads the surface in a UGRID file, plain or gzipped; coordinates as in the file.
/// \throws Error file_not_found, file_malformed (location, what was found, what was expected), unsupported_format, cancelled.
SurfaceSoup read_ugrid(const std::filesystem::path& path, const RunContext& context);

/// Writes the surface as the boundary of a mesh without cells, with normals as in `mesh` (into the fluid). The variant follows from the name, as in reading.
/// Names are written to the .mapbc file beside the mesh.
/// \throws Error write_failed, overflow (31-bit counts), cancelled.
void write_ugrid(const TriMesh& mesh, const std::filesystem::path& path, const RunContext& context);

}  // namespace sterna::io
