// Conversion between a surface and the boundary of a volume mesh without cells, shared by formats that store both.
#pragma once

#include <cstdint>
#include <string>

#include "geom/base/run_context.h"
#include "geom/mesh/hybrid_mesh.h"
#include "geom/mesh/surface_soup.h"
#include "geom/mesh/tri_mesh.h"

namespace sterna::io {

/// Winding of the surface's triangles as boundary faces. They keep their order; node i is vertex i.
enum class Winding { kept, turned };
HybridMesh as_boundary(const TriMesh& mesh, Winding winding);

/// The boundary of a file's volume mesh, of which the cells were only counted; or a surface without cells.
struct FileBoundary {
  HybridMesh mesh;            ///< without cells
  std::uint64_t n_cells = 0;  ///< in the file
};

/// Returns the boundary faces of a volume mesh: triangles, then quads split in two. Points that no face uses are left out. The winding is that of the mesh, out
/// of the fluid. Patches without faces are dropped.
/// \pre faces have patches
SurfaceSoup boundary_soup(const HybridMesh& mesh, const std::string& source, const RunContext& context);
SurfaceSoup boundary_soup(const FileBoundary& boundary, const std::string& source, const RunContext& context);

}  // namespace sterna::io
