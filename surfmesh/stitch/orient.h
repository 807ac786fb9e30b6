// Private to surfmesh/stitch: consistent orientation of all facets of a component, with normals out of the body.
#pragma once

#include "geom/base/run_context.h"
#include "surfmesh/stitch/edge_table.h"
#include "surfmesh/stitch/stitch_surface.h"
#include "surfmesh/stitch/working_surface.h"

namespace sterna::surfmesh {

/// Orientation found by flood fill, relative to that of the file.
struct Orientation {
  std::vector<std::uint32_t> component;  ///< per facet; connected over edges with two facets, numbered by first facet
  std::uint32_t n_components = 0;
  std::vector<char> is_flipped;  ///< per facet: opposite to the first facet of its component
  std::vector<Edge> conflicts;   ///< one edge for each component that has no consistent orientation
};
Orientation flood_orientation(const WorkingSurface& surface, const EdgeTable& edges);

/// Applies a consistent orientation: closed components by signed volume and nesting depth (0 = a body, normals out; 1 = a cavity in it, normals into the
/// cavity; 2 = a body in the cavity ...), open ones by the majority of their area. Depths are found by winding numbers.
/// A body inside another whose normals both point outwards in the file becomes a cavity with a warning. `names`: of the patches.
/// \pre no crowded edge, orientation without conflicts.
void orient_outward(WorkingSurface& surface, const EdgeTable& edges, const Orientation& orientation, bool is_fluid_inside,
                    const std::vector<std::string>& names, StitchReport& report, const RunContext& context);

}  // namespace sterna::surfmesh
