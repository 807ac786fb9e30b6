// Quality of single cells as VTK's MeshQuality (Verdict) has it, for pictures and comparison; the gates' own measures are in gates.h.
#pragma once

#include <array>
#include <span>

#include "geom/mesh/hybrid_mesh.h"

namespace sterna {

/// Smallest triple product of the edges at a corner over their lengths, times what makes the ideal shape 1: regular tetrahedron and pyramid sqrt(2), prism over
/// an equilateral triangle 2/sqrt(3), cube 1. Of a tetrahedron all corners have one triple product, and the largest of their products of lengths counts. Of a
/// pyramid the corners of its base; of a hexahedron also its middle (the axes through the middles of opposite faces). -1 .. 1; 0 where an edge vanishes. \param
/// p corners in CGNS order, as many as the kind has
double scaled_jacobian(CellKind kind, std::span<const Vec3> p);

struct CellQuality {
  double scaled_jacobian = 0.0;
  double volume = 0.0;                            ///< m^3, signed
  double min_dihedral = 0.0, max_dihedral = 0.0;  ///< radians, of tetrahedra; NaN for other cells
};
CellQuality cell_quality(CellKind kind, std::span<const Vec3> p);

}  // namespace sterna
