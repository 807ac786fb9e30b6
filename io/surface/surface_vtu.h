// VTU and VTP files of surfaces: triangles with patch numbers, patch names as field data.
#pragma once

#include <filesystem>

#include "geom/base/run_context.h"
#include "geom/mesh/surface_soup.h"
#include "geom/mesh/tri_mesh.h"

namespace sterna::io {

/// Reads the faces of a VTU or VTP file, or the boundary of a volume mesh; coordinates as in the file.
/// \throws Error file_not_found, file_malformed (byte offset), unsupported_format, cancelled.
SurfaceSoup read_surface_vtu(const std::filesystem::path& path, const RunContext& context);

/// Writes triangles with "marker" = patch number + 1; names and kinds as field data "patch:<kind>:<name>".
/// \throws Error write_failed, cancelled.
void write_surface_vtu(const TriMesh& mesh, const std::filesystem::path& path, const RunContext& context);
/// Writes the same contents as PolyData.
void write_surface_vtp(const TriMesh& mesh, const std::filesystem::path& path, const RunContext& context);

}  // namespace sterna::io
