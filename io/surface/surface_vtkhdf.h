// VTKHDF with a surface: an unstructured grid of triangles.
#pragma once

#include <filesystem>

#include "geom/base/run_context.h"
#include "geom/mesh/surface_soup.h"
#include "geom/mesh/tri_mesh.h"

namespace sterna::io {

/// The triangles and quads of a VTKHDF file, of a volume mesh its boundary; coordinates as in the file.
/// \throws what read_volume_vtkhdf throws
SurfaceSoup read_surface_vtkhdf(const std::filesystem::path& path, const RunContext& context);

/// Triangles with "marker" = patch number + 1, names and kinds as field data: see write_volume_vtkhdf.
void write_surface_vtkhdf(const TriMesh& mesh, const std::filesystem::path& path, const RunContext& context);

}  // namespace sterna::io
