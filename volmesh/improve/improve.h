// Improves the tetrahedra of an engine within the same boundary.
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
  std::int64_t n_bad_before = 0;  ///< number of tetrahedra with a dihedral angle beyond the limits
  std::int64_t n_bad_after = 0;
  std::int64_t n_bad_free_after = 0;  ///< number of bad tetrahedra without a vertex on the boundary
  double min_angle_before = 0.0;      ///< radians
  double min_angle_after = 0.0;
  double max_angle_before = 0.0;
  double max_angle_after = 0.0;
  int rounds = 0;
  std::int64_t n_at_boundary = 0;  ///< number of tetrahedra with a vertex on the boundary
  /// Number of bad tetrahedra that the boundary provably forces (remaining.h); other bad tetrahedra are failures of the improvement.
  std::int64_t n_forced = 0;
  std::int64_t n_slid = 0;  ///< number of growth lines whose height was changed afterwards
  std::vector<ErrorLocation>
      remaining;  ///< the first 10 000 bad tetrahedra, worst first: centre, angles, and sharpest angle of the boundary at the tetrahedron
};

/// Improves every tetrahedron with a dihedral angle beyond the limits, worst first. Operations are edge removal (rings of 3 to 10: 2-3, 4-4 etc.), multi-face
/// removal, smoothing, contraction and insertion of interior vertices, and short detours over worse tetrahedra. Each new tetrahedron is proved positive with
/// exact predicates. A change is accepted only if it lowers the sum of costs. Its tetrahedra must not have worse angles than the worst one removed or than half
/// of the limit, so the smallest quality of the mesh never falls.
///
/// A second pass works towards the targets of the gates: no angle beyond the target of G14, and no volume ratio beyond that of G9, between tetrahedra and last
/// prisms (TetraBoundary::layer_volumes) or among tetrahedra. This pass makes no angle worse than the worst one removed, or than the limits. Disjoint
/// neighbourhoods of bad tetrahedra are improved in parallel; results are bit-identical for any number of threads.
/// \pre verify_tetrahedra() has passed
/// \post verify_tetrahedra() passes again; the points of the boundary and its triangles are unchanged
ImproveReport improve_tetrahedra(const TetraBoundary& boundary, TetraResult& tets, const ImproveOptions& options, const RunContext& context);

/// Repeats the improvement, for all targets of the gates, for the tetrahedra around some boundary points that were moved.
/// \pre, \post as for improve_tetrahedra(); `around` is ascending
void improve_around(const TetraBoundary& boundary, std::span<const std::uint32_t> around, TetraResult& tets, const ImproveOptions& options,
                    ImproveReport& report, const RunContext& context);

/// Updates the data of the report about the tetrahedra.
void report_remaining(const TetraBoundary& boundary, const TetraResult& tets, const ImproveOptions& options, ImproveReport& report, const RunContext& context);

}  // namespace sterna::volmesh
