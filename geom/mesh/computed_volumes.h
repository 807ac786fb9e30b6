// Cell volumes and Jacobians as a solver computes them in double precision, from the node coordinates written to a file.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "geom/base/error.h"
#include "geom/base/run_context.h"
#include "geom/mesh/hybrid_mesh.h"

namespace sterna {

/// Relative margin above which a volume, sub-volume or Jacobian counts as positive in double precision. It is relative to the product of the lengths of the
/// three vectors that span the value. Rounding of the product itself is 1e-15, but solvers add and average coordinates before they multiply.
inline constexpr double k_solver_margin = 1e-13;

/// Returns the smallest Jacobian of a cell, as computed in double precision, over the product of the three edges. For tetrahedra this is the six-fold volume
/// over the largest product of three edges at a corner, for prisms wedge_quality(), for pyramids the smallest value at the corners of the base, for hexahedra
/// at all corners.
/// \pre points of a cell of this kind in CGNS order
double least_computed_jacobian(CellKind kind, std::span<const Vec3> points);

/// Returns the smallest dual sub-volume of a cell as SU2 computes it. A sub-volume is the tetrahedron of a node, the midpoint of an edge, the mean of a face's
/// nodes and the mean of the cell's nodes, all rounded as coordinates. The value is normalised: six times the volume over the product of the lengths of the
/// three vectors from the node. Zero if a length is zero.
/// \pre points of a cell of this kind in CGNS order
double least_computed_sub_volume(CellKind kind, std::span<const Vec3> points);

/// Returns true if both figures are above k_solver_margin.
bool is_positive_in_double(CellKind kind, std::span<const Vec3> points);

/// Cells that are positive in double precision at the points of the mesh but not at the rounded points of a file.
struct LostCells {
  std::int64_t n = 0;
  std::vector<ErrorLocation> locations;  ///< the first ten in mesh order: name, patch nearby, value
};

/// Finds the cells that become flat or folded by rounding of the coordinates.
/// \pre one rounded point for each point of the mesh, indices in range
LostCells cells_lost_by_rounding(const HybridMesh& mesh, std::span<const Point> rounded, const RunContext& context);

}  // namespace sterna
