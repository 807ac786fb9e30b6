// Quality of single cells as defined by VTK's MeshQuality (Verdict), for pictures and comparison. The measures of the gates are in gates.h.
#pragma once

#include <array>
#include <span>

#include "geom/mesh/hybrid_mesh.h"

namespace sterna {

/// Returns the smallest triple product of the edges at a corner over their lengths, scaled to 1 for the ideal shape: regular tetrahedron and pyramid sqrt(2),
/// prism over an equilateral triangle 2/sqrt(3), cube 1. All corners of a tetrahedron have the same triple product, so the largest product of edge lengths
/// decides. A pyramid is evaluated at the corners of its base; a hexahedron also at its centre (axes through the centres of opposite faces). Range -1 .. 1; 0
/// if an edge vanishes.
/// \param p corners in CGNS order, as many as the kind has
double scaled_jacobian(CellKind kind, std::span<const Vec3> p);

struct CellQuality {
  double scaled_jacobian = 0.0;
  double volume = 0.0;                            ///< m^3, signed
  double min_dihedral = 0.0, max_dihedral = 0.0;  ///< radians, for tetrahedra; NaN for other cells
};
CellQuality cell_quality(CellKind kind, std::span<const Vec3> p);

}  // namespace sterna
