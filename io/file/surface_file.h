// Surfaces from and to files. What a file holds before it becomes a wall is a triangle soup with patch names: readers do no geometry.
#pragma once

#include <filesystem>
#include <string_view>

#include "geom/base/run_context.h"
#include "geom/mesh/surface_soup.h"
#include "geom/mesh/tri_mesh.h"

namespace sterna::io {

/// Reads one surface file; the format follows from the extension (".gz" peeled off) and the contents. Polygons are split into
/// triangles. Polygons with coordinates that are not finite are left out with a warning. A volume mesh gives its boundary faces; SurfaceSoup::n_cells tells.
/// Coordinates are as in the file (no unit applied).
/// \throws Error file_not_found, file_malformed (line or byte offset and what was expected), unsupported_format.
SurfaceSoup read_surface_file(const std::filesystem::path& path, const RunContext& context);

/// Writes a surface; the format follows from the extension, or is named. Names and kinds of patches that the format cannot hold are told in the log. An
/// existing file stays as it was on failure.
/// \throws Error unsupported_format, write_failed, overflow, mesh_invalid (coordinates that are not finite), cancelled.
void write_surface_file(const TriMesh& mesh, const std::filesystem::path& path, const RunContext& context, std::string_view format_name = {});

/// The soup as it is, in the form that writers take: nothing is welded, turned or repaired, unless every triangle has corners of its own (STL): then corners at
/// exactly the same place become one, numbered in the order of their first use.
TriMesh to_tri_mesh(const SurfaceSoup& soup);

}  // namespace sterna::io
