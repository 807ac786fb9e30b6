// Sheets without thickness: boundary faces of kind interface that lie back to back, the two sides of an actuator disc. Their nodes at the same place are two.
#pragma once

#include <cstdint>
#include <vector>

#include "geom/mesh/hybrid_mesh.h"
#include "geom/mesh/tri_mesh.h"

namespace sterna {

inline constexpr std::uint32_t k_no_side = 0xffffffffu;

/// For each boundary face of a mesh (triangles, then quadrilaterals) the one that lies on it, turned over, corner on corner to the bit; k_no_side for others.
/// Empty when there are none. Only faces of patches of kind interface are looked at. Serial, O(n log n) in their number.
struct SheetSides {
  std::vector<std::uint32_t> other_side;  ///< of each face
  std::vector<std::uint32_t> twin;        ///< of each node: itself, or the node of the first side in its place (the first side is that of the smaller number)
  bool empty() const { return other_side.empty(); }
  /// Whether it lies on a face of a smaller number.
  bool is_second(std::size_t face) const { return !empty() && other_side[face] < face; }
  bool is_sheet(std::size_t face) const { return !empty() && other_side[face] != k_no_side; }
};

/// \pre patch indices in range or else the face is no sheet's; node indices in range, coordinates finite
SheetSides find_sheet_sides(const HybridMesh& mesh);
/// Of triangles and vertices.
SheetSides find_sheet_sides(const TriMesh& mesh);

}  // namespace sterna
