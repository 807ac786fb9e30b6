// Coordinates of a mesh as stored by a file of single precision, and the change of its edges by this rounding.
#pragma once

#include <span>
#include <string>
#include <vector>

#include "geom/base/run_context.h"
#include "geom/mesh/hybrid_mesh.h"

namespace sterna::io {

/// Returns the coordinates as read from a single-precision file.
std::vector<Point> in_single_precision(const HybridMesh& mesh, const RunContext& context);

/// The edge of a cell whose nodes move most against each other, relative to its length.
struct RoundedEdge {
  double share = 0.0;   ///< length of the change of the edge's vector over the length of the edge; 0 if no edge changes
  double length = 0.0;  ///< m
  Point position;       ///< middle of the edge
};
/// Largest RoundedEdge::share for which gates measured on the mesh hold for the file, too.
inline constexpr double k_most_rounding = 0.01;

/// Returns the edge with the largest share; of equal edges, the first in mesh order. Parallel, same result for any number of threads.
/// \pre one rounded point for each point of the mesh, indices in range
RoundedEdge worst_rounded_edge(const HybridMesh& mesh, std::span<const Point> rounded, const RunContext& context);

/// Returns "single precision moves nodes against each other by up to 20 % of the length of their edge, 1e-05 m at (1, 2, 3) (limit 1 %)"; an empty string if
/// the share is at most k_most_rounding.
std::string rounding_text(const RoundedEdge& edge);

}  // namespace sterna::io
