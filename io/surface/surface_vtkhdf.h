// VTKHDF files of surfaces: an unstructured grid of triangles.
#pragma once

#include <filesystem>

#include "geom/base/run_context.h"
#include "geom/mesh/surface_soup.h"
#include "geom/mesh/tri_mesh.h"

namespace sterna::io {

/// Reads the triangles and quads of a VTKHDF file, or the boundary of a volume mesh; coordinates as in the file.
/// \throws as read_volume_vtkhdf
SurfaceSoup read_surface_vtkhdf(const std::filesystem::path& path, const RunContext& context);

/// Writes triangles with "marker" = patch number + 1, names and kinds as field data: see write_volume_vtkhdf.
void write_surface_vtkhdf(const TriMesh& mesh, const std::filesystem::path& path, const RunContext& context);

}  // namespace sterna::io
