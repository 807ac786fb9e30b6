// VTU and VTP with a surface: triangles with patch numbers, patch names beside them.
#pragma once

#include <filesystem>

#include "geom/base/run_context.h"
#include "geom/mesh/surface_soup.h"
#include "geom/mesh/tri_mesh.h"

namespace sterna::io {

/// The faces of a VTU or VTP file, of a volume mesh its boundary; coordinates as in the file.
/// \throws Error file_not_found, file_malformed (byte offset), unsupported_format, cancelled.
SurfaceSoup read_surface_vtu(const std::filesystem::path& path, const RunContext& context);

/// Triangles with "marker" = patch number + 1; names and kinds as field data "patch:<kind>:<name>".
/// \throws Error write_failed, cancelled.
void write_surface_vtu(const TriMesh& mesh, const std::filesystem::path& path, const RunContext& context);
/// The same as PolyData.
void write_surface_vtp(const TriMesh& mesh, const std::filesystem::path& path, const RunContext& context);

}  // namespace sterna::io
