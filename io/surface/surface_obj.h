// Wavefront OBJ; groups (or objects, or materials) are patches.
#pragma once

#include <filesystem>

#include "geom/base/run_context.h"
#include "geom/mesh/surface_soup.h"
#include "geom/mesh/tri_mesh.h"

namespace sterna::io {

/// Reads the surface in an OBJ file, plain or gzipped; coordinates as in the file.
/// \throws Error file_not_found, file_malformed (location, what was found, what was expected), unsupported_format, cancelled.
SurfaceSoup read_obj(const std::filesystem::path& path, const RunContext& context);

/// Writes vertices in full precision, triangles in their order, patches as groups. Blanks in names become '_'.
/// \throws Error write_failed, cancelled.
void write_obj(const TriMesh& mesh, const std::filesystem::path& path, const RunContext& context);

}  // namespace sterna::io
