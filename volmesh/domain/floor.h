// Private to volmesh/domain: an open sheet (terrain) that the fluid stands on, in a box whose vertical sides pass through the rim of the sheet.
#pragma once

#include <array>
#include <cstdint>
#include <vector>

#include "geom/base/run_context.h"
#include "geom/mesh/topology.h"
#include "geom/mesh/tri_mesh.h"
#include "volmesh/case/farfield_options.h"
#include "volmesh/domain/farfield.h"

namespace sterna::volmesh {

struct FloorBox {
  std::size_t up = 2;                 ///< axis
  Box box;                            ///< m; its upper end along `up` is the lid
  std::array<EndPlane, 4> sides;      ///< vertical
  std::array<double, 6> edges{};      ///< m, longest edge on each side of the box
  std::vector<std::uint8_t> is_body;  ///< by triangle of the surface: 1 for closed parts, the bodies above the sheet
};

/// Finds the box above the sheet, and moves the rim of the sheet into the vertical sides to the bit. Each rim vertex has to lie within 1e-4 of the body length
/// of a side. The sides are those of farfield_from and farfield_to, where they are not given those of the box around the rim. The lid is at farfield_to; where
/// that is not given, half the longest side above the highest point.
/// \pre `topology` is that of `mesh`
/// \throws Error(bad_argument) when the shape is not "box", when no patch is called farfield_floor, when the surface is closed, when the normals of the sheet
/// point away from the lid, when the lid is not above all points or the box begins above the lowest one, when options belong
/// to another shape; Error(open_surface) with places when a rim leaves the sides, or belongs to another part
FloorBox fit_floor(const Topology& topology, const FarfieldOptions& options, TriMesh& mesh);

/// \throws Error(bad_argument) with the place of closed parts that are not within `boundary`: below the sheet, or outside the sides
/// \pre the triangles of the surface are the first of `boundary`
void check_bodies_above(const FloorBox& floor, const TriMesh& boundary, const RunContext& context);

}  // namespace sterna::volmesh
