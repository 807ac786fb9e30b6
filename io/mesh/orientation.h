// Windings of meshes that were read. Formats and programs use different conventions, so readers check and repair the winding.
#pragma once

#include <array>
#include <cstdint>
#include <span>

#include "geom/base/run_context.h"
#include "geom/mesh/hybrid_mesh.h"

namespace sterna::io {

struct FlipCounts {
  std::array<std::int64_t, 4> cells{};  ///< by CellKind
  std::int64_t faces = 0;
  std::int64_t inverted = 0;  ///< flipped cells, without prisms that follow another convention
};

/// Flips every explicit cell of negative volume: two nodes are swapped in each triangle of tets and wedges, and in each quad of pyramids and hexahedra. Then
/// reverses every boundary face whose orientation is opposite to that of its cell's face. Both are reported in the log. Faces without a cell, and faces with
/// crossed quads, are kept; `check` reports them.
/// Stores the number of inverted cells in HybridMesh::n_flipped_cells. Programs number the nodes of prisms in two ways (VTK's documentation and its code
/// differ), so prisms count as inverted only if a part of them is flipped, or if all cells of the other kinds are flipped, too.
/// \pre node ids in range. Parallel, same result for any number of threads.
FlipCounts orient_mesh(HybridMesh& mesh, const RunContext& context);

}  // namespace sterna::io
