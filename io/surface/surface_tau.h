// TAU primary grids of surfaces.
#pragma once

#include <filesystem>

#include "geom/base/run_context.h"
#include "geom/mesh/surface_soup.h"
#include "geom/mesh/tri_mesh.h"

namespace sterna::io {

/// Reads the surface elements of a grid, quads split: see read_boundary_tau.
SurfaceSoup read_tau(const std::filesystem::path& path, const RunContext& context);

/// Writes a grid without volume elements, with normals as in `mesh` (into the fluid). Names and conditions are written to the .bmap file beside the grid.
void write_tau(const TriMesh& mesh, const std::filesystem::path& path, const RunContext& context);

}  // namespace sterna::io
