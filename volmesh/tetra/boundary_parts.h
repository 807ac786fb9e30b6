// The boundary for engines with a boundary representation: closed surfaces, and the regions of the domain that they bound.
#pragma once

#include <array>
#include <cstdint>
#include <span>
#include <vector>

#include "geom/base/run_context.h"
#include "volmesh/tetra/sheets.h"
#include "volmesh/tetra/tetra.h"

namespace sterna::volmesh {

/// Surfaces are connected components of the boundary (over shared vertices), in order of their first triangle, then those of the sheets; regions are connected
/// parts of the domain. A component that a sheet divides into sides of two regions counts as two surfaces.
struct BoundaryParts {
  std::vector<std::int32_t> triangle2surface;  ///< triangles of sheets last
  std::vector<std::int32_t> surface2region;    ///< regions in order of their first surface
  std::vector<std::int32_t> surface2second;    ///< for a sheet between two regions, the region on its second side; otherwise -1
  std::size_t n_sheet_surfaces = 0;
  std::size_t n_surfaces() const { return surface2region.size(); }
};

/// Finds surfaces and regions. A surface whose normals point inwards encloses a region. The other surfaces are bodies in the smallest region around them, as
/// are sheets, which may touch the boundary. \p joined: of a boundary with sheets, or null; if given, its triangles are numbered.
/// \pre check_boundary() passed, no self-intersection.
/// \throws Error(not_orientable) if a body lies in no region, with its location.
BoundaryParts find_parts(const TetraBoundary& boundary, const JoinedBoundary* joined, const RunContext& context);

}  // namespace sterna::volmesh
