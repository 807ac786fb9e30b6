// Improvement of an engine's tetrahedra within the same boundary.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "geom/base/error.h"
#include "geom/base/run_context.h"
#include "volmesh/case/improve_options.h"
#include "volmesh/tetra/tetra.h"

namespace sterna::volmesh {

/// Result of the improvement.
struct ImproveReport {
  std::int64_t n_bad_before = 0;  ///< tetrahedra with a dihedral angle beyond the limits
  std::int64_t n_bad_after = 0;
  std::int64_t n_bad_free_after = 0;  ///< bad tetrahedra without a vertex on the boundary
  double min_angle_before = 0.0;      ///< radians
  double min_angle_after = 0.0;
  double max_angle_before = 0.0;
  double max_angle_after = 0.0;
  int rounds = 0;
  std::int64_t n_at_boundary = 0;  ///< all tetrahedra with a vertex on the boundary
  std::int64_t n_forced = 0;  ///< bad tetrahedra that the boundary provably forces, see remaining.h; a tetrahedron that is neither forced nor within the limits
                              ///< is a failure of improvement
  std::int64_t n_slid = 0;    ///< growth lines of the layer whose height has changed since
  std::vector<ErrorPlace> remaining;  ///< each bad tetrahedron, worst first: its centre, its angles, the sharpest angle of the boundary at it; the first 10 000
};

/// Improves every tetrahedron with a dihedral angle beyond the limits, worst first. Operations: edge removal (rings of 3 to 10: 2-3, 4-4, ...), multi-face
/// removal, smoothing, contraction and insertion of interior vertices, and short detours over worse tetrahedra. Each change is proven positive with exact
/// predicates. It is accepted only if it lowers a sum of costs without a tetrahedron of worse angles than the worst removed or than half of the limit, so the
/// smallest quality of the mesh never falls.
///
/// A second pass works towards the targets of the gates: no angle beyond the target of G14, no volume ratio beyond that of G9, between tetrahedra and last
/// prisms (TetraBoundary::layer_volumes) or among tetrahedra. This pass makes no angle worse than the worst removed, or than the limits. Disjoint
/// neighbourhoods of bad tetrahedra are improved in parallel: bit-identical results for any number of threads.
/// \pre verify_tetrahedra() passed.
/// \post it passes again; points of the boundary and its triangles as before.
ImproveReport improve_tetrahedra(const TetraBoundary& boundary, TetraResult& tets, const ImproveOptions& options, const RunContext& context);

/// Repeats the improvement, for all gate targets, for the tetrahedra around some points of the boundary that have moved since.
/// \pre, \post as above; `around` ascending
void improve_around(const TetraBoundary& boundary, std::span<const std::uint32_t> around, TetraResult& tets, const ImproveOptions& options,
                    ImproveReport& report, const RunContext& context);

/// Updates the data of the report about the tetrahedra.
void tell_remaining(const TetraBoundary& boundary, const TetraResult& tets, const ImproveOptions& options, ImproveReport& report, const RunContext& context);

}  // namespace sterna::volmesh
