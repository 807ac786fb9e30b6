// TAU primary grids with a surface.
#pragma once

#include <filesystem>

#include "geom/base/run_context.h"
#include "geom/mesh/surface_soup.h"
#include "geom/mesh/tri_mesh.h"

namespace sterna::io {

/// The surface elements of a grid, quads split: see read_boundary_tau.
SurfaceSoup read_tau(const std::filesystem::path& path, const RunContext& context);

/// A grid without volume elements, normals as in `mesh` (into the fluid); names and conditions go to the .bmap beside it.
void write_tau(const TriMesh& mesh, const std::filesystem::path& path, const RunContext& context);

}  // namespace sterna::io
