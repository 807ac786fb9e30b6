// Baffles of zero thickness: back-to-back boundary faces of kind interface, the two sides of an actuator disc. Nodes on the two sides are distinct but
// coincide.
#pragma once

#include <cstdint>
#include <vector>

#include "geom/mesh/hybrid_mesh.h"
#include "geom/mesh/tri_mesh.h"

namespace sterna {

inline constexpr std::uint32_t k_no_side = 0xffffffffu;

/// Stores for each boundary face of a mesh (triangles, then quadrilaterals) the face of opposite sense whose corners coincide with its corners to the bit, or
/// k_no_side if there is none. Empty if no faces coincide. Considers only patches of kind interface. Serial, O(n log n) in the number of their faces.
struct BaffleSides {
  std::vector<std::uint32_t> other_side;  ///< per face
  std::vector<std::uint32_t> twin;        ///< per node: itself, or the coincident node of the first side (the side with the smaller number)
  bool empty() const { return other_side.empty(); }
  /// Returns true if the face coincides with a face of a smaller number.
  bool is_second(std::size_t face) const { return !empty() && other_side[face] < face; }
  bool is_baffle(std::size_t face) const { return !empty() && other_side[face] != k_no_side; }
};

/// \pre patch indices in range (faces with other indices belong to no baffle); node indices in range, coordinates finite
BaffleSides find_baffle_sides(const HybridMesh& mesh);
/// Finds the two sides of baffles among the triangles and vertices of a surface.
BaffleSides find_baffle_sides(const TriMesh& mesh);

}  // namespace sterna
