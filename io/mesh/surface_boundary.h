// A surface as the boundary of a volume mesh without cells, and back: what formats share that hold both.
#pragma once

#include <cstdint>
#include <string>

#include "geom/base/run_context.h"
#include "geom/mesh/hybrid_mesh.h"
#include "geom/mesh/surface_soup.h"
#include "geom/mesh/tri_mesh.h"

namespace sterna::io {

/// The surface's triangles as boundary faces, in their order; node i is vertex i.
enum class Winding { kept, turned };
HybridMesh as_boundary(const TriMesh& mesh, Winding winding);

/// The boundary of a file's volume mesh, whose cells were only counted; or a surface, without any.
struct FileBoundary {
  HybridMesh mesh;            ///< without cells
  std::uint64_t n_cells = 0;  ///< in the file
};

/// The boundary faces of a volume mesh: triangles, then quads split in two; points that no face uses are left out. Winding as in the mesh, out of the fluid.
/// Patches without faces are dropped.
/// \pre faces have patches
SurfaceSoup boundary_soup(const HybridMesh& mesh, const std::string& source, const RunContext& context);
SurfaceSoup boundary_soup(const FileBoundary& boundary, const std::string& source, const RunContext& context);

}  // namespace sterna::io
