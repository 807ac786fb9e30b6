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
};

/// Flips every explicit cell of negative volume: two nodes are swapped in each triangle of tets and wedges, and in each quad of pyramids and hexahedra. Then
/// reverses every boundary face whose orientation is opposite to that of its cell's face. Both are reported in the log. Faces without a cell, and faces with
/// crossed quads, are kept; `check` reports them.
/// \pre node ids in range. Parallel, same result for any number of threads.
FlipCounts orient_mesh(HybridMesh& mesh, const RunContext& context);

}  // namespace sterna::io
