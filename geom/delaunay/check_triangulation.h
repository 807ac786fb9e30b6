// The invariants of a Triangulation, counted; for tests and for the last line of defence of its users.
#pragma once

#include <cstdint>
#include <string>

#include "geom/delaunay/triangulation.h"

namespace sterna::delaunay {

struct TriangulationCheck {
  std::int64_t n_triangles = 0;  ///< living and real
  std::int64_t n_ghosts = 0;
  std::int64_t n_used_vertices = 0;  ///< corners of a real triangle
  std::int64_t n_edges = 0;
  std::int64_t n_border_edges = 0;  ///< with a real triangle on one side only
  std::int64_t n_border_loops = 0;  ///< closed walks along border edges, left turns first where several meet
  std::int64_t n_constrained = 0;   ///< edges

  std::int64_t n_inverted = 0;      ///< real triangles that do not turn strictly counter-clockwise
  std::int64_t n_bad_twins = 0;     ///< half-edges whose twin is not mutual, dead, or has other ends
  std::int64_t n_bad_flags = 0;     ///< sides of an edge that disagree, or a border edge without constraint in a carved domain
  std::int64_t n_bad_outgoing = 0;  ///< vertices whose half-edge is dead or starts elsewhere
  std::int64_t n_not_delaunay = 0;  ///< free edges with the opposite vertex strictly inside the circle in the plane

  /// Vertices - edges + triangles: 1 for a disc, 1 - holes in it.
  std::int64_t euler_number() const { return n_used_vertices - n_edges + n_triangles; }
  /// All but the empty circle (which triangulations by another criterion do not have).
  bool is_valid() const { return n_inverted + n_bad_twins + n_bad_flags + n_bad_outgoing == 0; }
  /// One sentence with the counts that are not zero.
  std::string text() const;
};

/// O(n); exact.
TriangulationCheck check_triangulation(const Triangulation& mesh);

}  // namespace sterna::delaunay
