// Private to volmesh/domain: an open sheet (terrain) below the fluid, in a box whose vertical sides contain the open boundary of the sheet.
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
  std::size_t up = 2;                 ///< vertical axis
  Box box;                            ///< m; the upper end of the box along `up` is the lid
  std::array<EndPlane, 4> sides;      ///< vertical sides
  std::array<double, 6> edges{};      ///< m, longest edge on each side of the box
  std::vector<std::uint8_t> is_body;  ///< per triangle of the surface: 1 for closed parts, which are the bodies above the sheet
};

/// Finds the box above the sheet, and moves the open boundary of the sheet bit-exactly into the vertical sides. Each open-boundary vertex must lie within 1e-4
/// of the body length of a side. The sides are given by farfield_from and farfield_to; by default they are those of the box around the open boundary. The lid
/// is at farfield_to. By default its height above the highest point is half the longest side.
/// \pre `topology` is that of `mesh`
/// \throws Error(bad_argument) if the shape is not "box", if no patch is called farfield_floor, if the surface is closed, if the normals of the sheet point
/// away from the lid, if the lid is not above all points or the box begins above the lowest point, or if options belong to another shape; Error(open_surface)
/// with locations where an open boundary leaves the sides, or belongs to another part
FloorBox fit_floor(const Topology& topology, const FarfieldOptions& options, TriMesh& mesh);

/// Checks that closed parts lie within `boundary`. \throws Error(bad_argument) with the location of closed parts below the sheet or outside the sides
/// \pre the triangles of the surface are the first triangles of `boundary`
void check_bodies_above(const FloorBox& floor, const TriMesh& boundary, const RunContext& context);

}  // namespace sterna::volmesh
