// CGNS files of surfaces.
#pragma once

#include <filesystem>

#include "geom/base/run_context.h"
#include "geom/mesh/surface_soup.h"
#include "geom/mesh/tri_mesh.h"

namespace sterna::io {

/// Reads the faces of a CGNS file, quads split: see read_boundary_cgns.
SurfaceSoup read_cgns(const std::filesystem::path& path, const RunContext& context);

/// Writes a base of two dimensions, with a section and a family per patch: see write_volume_cgns.
void write_cgns(const TriMesh& mesh, const std::filesystem::path& path, const RunContext& context);

}  // namespace sterna::io
