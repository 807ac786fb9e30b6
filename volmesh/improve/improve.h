// Better tetrahedra from those that an engine made, within the same boundary.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "geom/base/error.h"
#include "geom/base/run_context.h"
#include "volmesh/case/improve_options.h"
#include "volmesh/tetra/tetra.h"

namespace sterna::volmesh {

/// What improvement found and left.
struct ImproveReport {
  std::int64_t n_bad_before = 0;  ///< tetrahedra with a dihedral angle beyond the limits
  std::int64_t n_bad_after = 0;
  std::int64_t n_bad_free_after = 0;  ///< of these without a vertex on the boundary
  double min_angle_before = 0.0;      ///< radians
  double min_angle_after = 0.0;
  double max_angle_before = 0.0;
  double max_angle_after = 0.0;
  int rounds = 0;
  std::int64_t n_at_boundary = 0;  ///< all tetrahedra with a vertex on the boundary
  std::int64_t n_forced =
      0;  ///< bad ones that the boundary is proven to force, see remaining.h; what is neither forced nor within the limits is a failure of improvement
  std::int64_t n_slid = 0;            ///< lines of the layer that end at another height since
  std::vector<ErrorPlace> remaining;  ///< each bad one, worst first: its centre, its angles, the sharpest angle of the boundary at it; the first 10 000
};

/// Works on every tetrahedron with a dihedral angle beyond the limits, worst first: edge removal (rings of 3 to 10: 2-3, 4-4, ...), multi-face removal,
/// smoothing, contraction and insertion of interior vertices, and short detours over worse ones; each change proven positive with exact predicates and accepted
/// only when it lowers a sum of costs without a tetrahedron of worse angles than the worst that it removes or than half of the limit, so the smallest quality
/// of the mesh never falls. Then once more for what gates wish for: no angle beyond the target of G14, no step of volume beyond that of G9, between tetrahedra
/// and last prisms (TetraBoundary::layer_volumes) or among tetrahedra; no angle gets worse for it than the worst removed, or than the limits. Disjoint
/// neighbourhoods of bad tetrahedra are worked on in parallel: same bytes for any number of threads.
/// \pre verify_tetrahedra() passed.
/// \post it passes again; points of the boundary and its triangles as before.
ImproveReport improve_tetrahedra(const TetraBoundary& boundary, TetraResult& tets, const ImproveOptions& options, const RunContext& context);

/// The same once more, for all that gates wish for, with the tetrahedra around some points of the boundary, which have moved since.
/// \pre, \post as above; `around` ascending
void improve_around(const TetraBoundary& boundary, std::span<const std::uint32_t> around, TetraResult& tets, const ImproveOptions& options,
                    ImproveReport& report, const RunContext& context);

/// Brings what the report says of the tetrahedra up to date.
void tell_remaining(const TetraBoundary& boundary, const TetraResult& tets, const ImproveOptions& options, ImproveReport& report, const RunContext& context);

}  // namespace sterna::volmesh
