// Reading and writing of surface files. Readers return a triangle soup with patch names and do no geometry processing.
#pragma once

#include <filesystem>
#include <string_view>

#include "geom/base/run_context.h"
#include "geom/mesh/surface_soup.h"
#include "geom/mesh/tri_mesh.h"

namespace sterna::io {

/// Reads one surface file; the format follows from the extension (without ".gz") and the contents. Polygons are split into triangles. Polygons with coordinates
/// that are not finite are left out with a warning. For a volume mesh the boundary faces are returned, and SurfaceSoup::n_cells is its number of cells.
/// Coordinates are as in the file (no unit applied).
/// \throws Error file_not_found, file_malformed (line or byte offset and what was expected), unsupported_format.
SurfaceSoup read_surface_file(const std::filesystem::path& path, const RunContext& context);

/// Writes a surface; the format follows from the extension, or is named. Names and kinds of patches that the format cannot store are reported in the log. On
/// failure an existing file is unchanged.
/// \throws Error unsupported_format, write_failed, overflow, mesh_invalid (coordinates that are not finite), cancelled.
void write_surface_file(const TriMesh& mesh, const std::filesystem::path& path, const RunContext& context, std::string_view format_name = {});

/// Converts a soup to the type that writers take, without welding, reorientation or repair. Exception: if no triangles share vertices (STL), vertices with
/// identical coordinates are merged and numbered in order of first use.
TriMesh to_tri_mesh(const SurfaceSoup& soup);

}  // namespace sterna::io
