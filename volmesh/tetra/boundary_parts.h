// The boundary as required by engines with a boundary representation: closed surfaces, and the regions of the domain that they bound.
#pragma once

#include <array>
#include <cstdint>
#include <span>
#include <vector>

#include "geom/base/run_context.h"
#include "volmesh/tetra/tetra.h"
#include "volmesh/tetra/tetra_baffles.h"

namespace sterna::volmesh {

/// Surfaces and regions of a boundary. Surfaces are connected components of the boundary (connected through shared vertices), in the order of their first
/// triangles, followed by those of the sheets. Regions are connected parts of the domain. A component that a sheet divides into sides of two regions counts as
/// two surfaces.
struct BoundaryParts {
  std::vector<std::int32_t> triangle2surface;  ///< surface of each triangle; triangles of sheets come last
  std::vector<std::int32_t> surface2region;    ///< region of each surface; regions are in the order of their first surface
  std::vector<std::int32_t> surface2second;    ///< for a sheet between two regions, the region on its second side; otherwise -1
  std::size_t n_baffle_surfaces = 0;
  std::size_t n_surfaces() const { return surface2region.size(); }
};

/// Finds surfaces and regions. A surface whose normals point inwards encloses a region. The other surfaces are bodies in the smallest region around them.
/// Sheets also belong to the smallest region around them; they may touch the boundary. \p joined joined boundary if there are sheets, otherwise null; if given,
/// its triangles are numbered
/// \pre check_boundary() has passed, and there is no self-intersection
/// \throws Error(not_orientable) with the location if a body lies in no region
BoundaryParts find_parts(const TetraBoundary& boundary, const JoinedBoundary* joined, const RunContext& context);

}  // namespace sterna::volmesh
