// Structured mesh of a narrow face, such as the base of a blunt trailing edge.
#pragma once

#include <optional>

#include "surfmesh/face/band_rows.h"

namespace sterna::surfmesh {

/// Start positions of the sides of a strip in the border's only loop. The strip has two long sides of `n_along` segments each. At each end the two long sides
/// are joined by a short side of `n_across` segments, or they meet in one corner.
struct StripSides {
  std::size_t first_long = 0;  ///< position of the first point of the first long side
  std::size_t n_along = 0;
  std::size_t n_across = 0;
  bool is_end_pointed = false;    ///< the long sides meet in a corner at the end of the first long side
  bool is_start_pointed = false;  ///< the long sides meet in a corner at the start of the first long side
};

/// Creates n_along x n_across cells of two triangles each; a pointed end gets a fan of triangles. Inner vertices lie on the surface, at equal fractions between
/// the long sides. \return nothing if cells would be inverted in (u, v)
std::optional<BandedFace> mesh_strip(const Surface& surface, const FaceBorder& border, const StripSides& sides);

}  // namespace sterna::surfmesh
