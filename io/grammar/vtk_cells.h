// Cell type numbers and node order of VTK, also used by SU2. docs/method/formats.md, "Conventions".
#pragma once

#include <array>
#include <cstdint>
#include <optional>

#include "geom/mesh/hybrid_mesh.h"

namespace sterna::io {

inline constexpr int k_vtk_vertex = 1;
inline constexpr int k_vtk_line = 3;
inline constexpr int k_vtk_triangle = 5;
inline constexpr int k_vtk_quad = 9;

/// Returns the VTK type of a volume cell: 10 tetrahedron, 14 pyramid, 13 wedge, 12 hexahedron.
constexpr int vtk_type(CellKind kind) {
  constexpr std::array<int, 4> k_types = {10, 14, 13, 12};
  return k_types[static_cast<std::size_t>(kind)];
}
constexpr std::optional<CellKind> kind_of_vtk_type(std::int64_t type) {
  switch (type) {
    case 10: return CellKind::tetrahedron;
    case 14: return CellKind::pyramid;
    case 13: return CellKind::prism;
    case 12: return CellKind::hexahedron;
    default: return std::nullopt;
  }
}

/// Returns the permutation vtk_node[i] = cgns_node[order[i]]. VTK reverses both triangles of the wedge. The permutation is its own inverse, so readers use it,
/// too.
constexpr std::array<std::uint8_t, 8> vtk_order(CellKind kind) {
  if (kind == CellKind::prism) return {0, 2, 1, 3, 5, 4};
  return {0, 1, 2, 3, 4, 5, 6, 7};
}

}  // namespace sterna::io
