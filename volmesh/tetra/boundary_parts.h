// The boundary as an engine with a boundary representation wants it: closed surfaces, and the regions of the domain that they bound.
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
/// parts of the domain. A component that a sheet parts into sides of two regions is two surfaces.
struct BoundaryParts {
  std::vector<std::int32_t> triangle2surface;  ///< sheets' triangles last
  std::vector<std::int32_t> surface2region;    ///< regions in order of their first surface
  std::vector<std::int32_t> surface2second;    ///< of a sheet that parts two regions the one on its second side; else -1
  std::size_t n_sheet_surfaces = 0;
  std::size_t n_surfaces() const { return surface2region.size(); }
};

/// A surface whose normals point inwards encloses a region; the others are bodies in the smallest region around them, as sheets are, which may touch the
/// boundary. \p joined: of a boundary with sheets, or null; its triangles are numbered then.
/// \pre check_boundary() passed, no self-intersection.
/// \throws Error(not_orientable) when a body lies in no region, with its place.
BoundaryParts find_parts(const TetraBoundary& boundary, const JoinedBoundary* joined, const RunContext& context);

}  // namespace sterna::volmesh
