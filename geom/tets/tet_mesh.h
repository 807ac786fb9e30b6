// A tetrahedral mesh inside a closed boundary as arrays, with the neighbour across every face: the data structure of this folder.
#pragma once

#include <array>
#include <cstdint>
#include <span>
#include <vector>

#include "geom/base/ids.h"
#include "geom/base/run_context.h"
#include "geom/base/vec3.h"

namespace sterna::tets {

inline constexpr std::uint32_t k_most_tets = 1u << 30;  ///< a face is 4 tet + corner in 32 bits

using Corners = std::array<std::uint32_t, 4>;

/// Corners of the face opposite to corner i of a positive tetrahedron, ordered so that the right-hand normal points to corner i.
inline constexpr std::array<std::array<std::uint8_t, 3>, 4> k_face = {{{1, 3, 2}, {0, 2, 3}, {0, 3, 1}, {0, 1, 2}}};

/// All tetrahedra are positive (exact orient3d). A face without neighbour is a boundary face: nothing ever crosses it. 32 bytes per tetrahedron.
struct TetMesh {
  std::vector<Vec3> points;
  std::vector<Corners> nodes;       ///< nodes[t][0] == k_none: the slot of a removed tetrahedron
  std::vector<Corners> neighbours;  ///< across the face opposite to each corner: 4 * neighbour + the corner of the neighbour; or k_none

  bool is_alive(std::uint32_t t) const { return nodes[t][0] != k_none; }
};

/// Finds the neighbours. Parallel, O(n).
/// \throws Error(tetra_result_invalid) with the locations where a tetrahedron is not positive, a node is out of range, or a face has more than two tetrahedra
/// or two on one side; Error(overflow) for k_most_tets tetrahedra and more.
TetMesh connect(std::vector<Vec3> points, std::span<const Corners> tetrahedra, const RunContext& context);

/// Removes empty slots of tetrahedra, and unused points from `first_removable` on; both keep their order. Serial, O(n).
void compact(TetMesh& mesh, std::uint32_t first_removable);

}  // namespace sterna::tets
