// Counts violations of the invariants of a Triangulation; for tests and for final checks by its users.
#pragma once

#include <cstdint>
#include <string>

#include "geom/delaunay/triangulation.h"

namespace sterna::delaunay {

struct TriangulationCheck {
  std::int64_t n_triangles = 0;  ///< existing real triangles
  std::int64_t n_ghosts = 0;
  std::int64_t n_used_vertices = 0;  ///< corners of a real triangle
  std::int64_t n_edges = 0;
  std::int64_t n_border_edges = 0;  ///< edges with a real triangle on one side only
  std::int64_t n_border_loops = 0;  ///< closed walks along border edges, turning left first where several meet
  std::int64_t n_constrained = 0;   ///< constrained edges

  std::int64_t n_inverted = 0;      ///< real triangles that do not turn strictly counter-clockwise
  std::int64_t n_bad_twins = 0;     ///< half-edges whose twin is not mutual, is dead, or has other ends
  std::int64_t n_bad_flags = 0;     ///< edges whose sides disagree, or unconstrained border edges in a carved domain
  std::int64_t n_bad_outgoing = 0;  ///< vertices whose half-edge is dead or starts elsewhere
  std::int64_t n_not_delaunay = 0;  ///< free edges with the opposite vertex strictly inside the circle in the plane

  /// Returns vertices - edges + triangles: 1 for a disc, 1 minus the number of its holes.
  std::int64_t euler_number() const { return n_used_vertices - n_edges + n_triangles; }
  /// Returns true if all invariants hold, except the empty circle (which triangulations by another criterion do not satisfy).
  bool is_valid() const { return n_inverted + n_bad_twins + n_bad_flags + n_bad_outgoing == 0; }
  /// Returns one sentence with the counts that are not zero.
  std::string text() const;
};

/// Checks all invariants. O(n); exact.
TriangulationCheck check_triangulation(const Triangulation& mesh);

}  // namespace sterna::delaunay
