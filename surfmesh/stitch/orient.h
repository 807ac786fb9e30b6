// Private to surfmesh/stitch: orients all facets of a component consistently, with normals out of the body.
#pragma once

#include "geom/base/run_context.h"
#include "surfmesh/stitch/edge_table.h"
#include "surfmesh/stitch/stitch_surface.h"
#include "surfmesh/stitch/working_surface.h"

namespace sterna::surfmesh {

/// Orientation found by flood fill, relative to the orientation in the file.
struct Orientation {
  std::vector<std::uint32_t> component;  ///< component of each facet; components are connected across edges with two facets, and numbered by first facet
  std::uint32_t n_components = 0;
  std::vector<char> is_flipped;  ///< per facet: true if it is oriented against the first facet of its component
  std::vector<Edge> conflicts;   ///< one edge for each component that has no consistent orientation
};
Orientation flood_orientation(const WorkingSurface& surface, const EdgeTable& edges);

/// Applies a consistent orientation. Closed components are oriented by signed volume and nesting depth. At depth 0 there is a body, whose normals point
/// outwards. At depth 1 there is a cavity in it, whose normals point into the cavity; at depth 2 a body in the cavity, and so on. Open components keep the
/// orientation of most of their area. Depths are found by winding numbers. If two nested bodies both have outward normals in the file, the inner one becomes a
/// cavity, with a warning. `names` are those of the patches.
/// \pre no crowded edge; orientation without conflicts
void orient_outward(WorkingSurface& surface, const EdgeTable& edges, const Orientation& orientation, bool is_fluid_inside,
                    const std::vector<std::string>& names, StitchReport& report, const RunContext& context);

}  // namespace sterna::surfmesh
