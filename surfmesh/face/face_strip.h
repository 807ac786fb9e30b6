// A narrow face as a structured strip: the base of a blunt trailing edge.
#pragma once

#include <optional>

#include "surfmesh/face/band_rows.h"

namespace sterna::surfmesh {

/// Where in the border's only loop the sides of a strip begin: two long ones of `n_along` segments each and, between the end of the first and the start of the
/// second, one of `n_across` segments, or the corner that both share; the same between the end of the second and the start of the first.
struct StripSides {
  std::size_t first_long = 0;  ///< position of the first point of the first long side
  std::size_t n_along = 0;
  std::size_t n_across = 0;
  bool is_end_pointed = false;    ///< the long sides meet at the end of the first
  bool is_start_pointed = false;  ///< ... and at its start
};

/// n_along x n_across cells, each of two triangles (a fan in front of a pointed end). Inner vertices lie on the surface, at equal shares between the long
/// sides. \return nothing where cells would be turned over in (u, v)
std::optional<BandedFace> mesh_strip(const Surface& surface, const FaceBorder& border, const StripSides& sides);

}  // namespace sterna::surfmesh
