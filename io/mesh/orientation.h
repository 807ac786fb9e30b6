// Windings of meshes that were read: formats and programs disagree on them, so readers measure and repair.
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

/// Flips every explicit cell of negative volume (tets and wedges: two nodes swapped in each triangle; pyramids, hexahedra: in each quad), then turns every
/// boundary face that is the reverse of a cell's face. Both are told in the log. Faces of no cell, and faces with crossed quads, stay; `check` reports them.
/// \pre node ids in range. Parallel, same result for any number of threads.
FlipCounts orient_mesh(HybridMesh& mesh, const RunContext& context);

}  // namespace sterna::io
