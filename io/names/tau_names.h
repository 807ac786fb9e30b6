// TAU's German names of the arrays of a primary grid, by kind of element.
#pragma once

#include <array>
#include <string_view>

#include "geom/mesh/hybrid_mesh.h"

namespace sterna::io {

struct TauElement {
  std::string_view singular;  ///< points_per_<singular>
  std::string_view plural;    ///< no_of_<plural>, points_of_<plural>
};
constexpr TauElement tau_element(CellKind kind) {
  constexpr std::array<TauElement, 4> k_elements = {{{"tetraeder", "tetraeders"}, {"pyramid", "pyramids"}, {"prism", "prisms"}, {"hexaeder", "hexaeders"}}};
  return k_elements[static_cast<std::size_t>(kind)];
}
inline constexpr TauElement k_tau_triangle = {"surfacetriangle", "surfacetriangles"};
inline constexpr TauElement k_tau_quad = {"surfacequadrilateral", "surfacequadrilaterals"};
/// Cell kinds in the order of TAU files.
inline constexpr std::array<CellKind, 4> k_tau_kinds = {CellKind::tetrahedron, CellKind::prism, CellKind::pyramid, CellKind::hexahedron};

}  // namespace sterna::io
