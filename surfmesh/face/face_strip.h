// Structured mesh of a narrow face: the base of a blunt trailing edge.
#pragma once

#include <optional>

#include "surfmesh/face/band_rows.h"

namespace sterna::surfmesh {

/// Start positions of the sides of a strip in the border's only loop. The strip has two long sides of `n_along` segments each. Between the end of the first
/// and the start of the second lies a side of `n_across` segments, or the corner that both share; the same holds between the end of the second and the start
/// of the first.
struct StripSides {
  std::size_t first_long = 0;  ///< position of the first point of the first long side
  std::size_t n_along = 0;
  std::size_t n_across = 0;
  bool is_end_pointed = false;    ///< the long sides meet at the end of the first
  bool is_start_pointed = false;  ///< ... and at its start
};

/// Creates n_along x n_across cells of two triangles each (a fan of triangles in front of a pointed end). Inner vertices lie on the surface, at equal
/// fractions between the long sides. \return nothing if cells would be inverted in (u, v)
std::optional<BandedFace> mesh_strip(const Surface& surface, const FaceBorder& border, const StripSides& sides);

}  // namespace sterna::surfmesh
