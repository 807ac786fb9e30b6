// Writes the geometry of a failure, so that a user can look at it.
#pragma once

#include <filesystem>

#include "geom/base/error.h"
#include "geom/base/run_context.h"
#include "geom/mesh/tri_mesh.h"

namespace sterna::io {

/// VTU with the triangles, edges and vertices of the failure. \throws Error(write_failed).
void write_trouble_vtu(const TroubleGeometry& geometry, const std::filesystem::path& path);

/// VTU of a surface: triangles with patch numbers. \throws Error(write_failed).
void write_surface_vtu(const TriMesh& mesh, const std::filesystem::path& path, const RunContext& context);

}  // namespace sterna::io
