// Element type numbers, element names and boundary condition names of CGNS (SIDS).
#pragma once

#include <cstdint>
#include <string_view>

#include "geom/mesh/hybrid_mesh.h"

namespace sterna::io {

inline constexpr std::int64_t k_cgns_node = 2;
inline constexpr std::int64_t k_cgns_bar = 3;
inline constexpr std::int64_t k_cgns_triangle = 5;
inline constexpr std::int64_t k_cgns_quad = 7;
inline constexpr std::int64_t k_cgns_mixed = 20;

/// Returns the element type number: 10 TETRA_4, 12 PYRA_5, 14 PENTA_6, 17 HEXA_8.
constexpr std::int64_t cgns_type(CellKind kind) {
  constexpr std::int64_t k_types[] = {10, 12, 14, 17};
  return k_types[static_cast<std::size_t>(kind)];
}
constexpr std::string_view cgns_name(CellKind kind) {
  constexpr std::string_view k_names[] = {"TETRA_4", "PYRA_5", "PENTA_6", "HEXA_8"};
  return k_names[static_cast<std::size_t>(kind)];
}

constexpr std::string_view cgns_condition(PatchKind kind) {
  switch (kind) {
    case PatchKind::wall: return "BCWallViscous";
    case PatchKind::slip: return "BCWallInviscid";
    case PatchKind::symmetry: return "BCSymmetryPlane";
    case PatchKind::inflow: return "BCInflow";
    case PatchKind::outflow: return "BCOutflow";
    case PatchKind::farfield: return "BCFarfield";
    case PatchKind::interface: break;
  }
  return "UserDefined";
}

/// Name of a node below a family; it holds the full patch name if that is not a valid CGNS node name.
inline constexpr std::string_view k_cgns_name_note = "PatchName";

}  // namespace sterna::io
