// Private to surfmesh/stitch: errors for surface defects, with locations and remedies.
#pragma once

#include "geom/base/run_context.h"
#include "geom/mesh/find_crossings.h"
#include "surfmesh/stitch/edge_table.h"
#include "surfmesh/stitch/orient.h"
#include "surfmesh/stitch/stitch_surface.h"
#include "surfmesh/stitch/working_surface.h"

namespace sterna::surfmesh {

/// Throws for the first of the following defects that applies. The error text names the other ones:
///   1. crowded edges: non_manifold_surface, places = crowded edges + pinched vertices;
///   2. boundary edges (unless open surfaces are allowed): open_surface, places = boundary edges;
///   3. pinched vertices: non_manifold_surface, places = pinched vertices;
///   4. no consistent orientation: not_orientable, places = components.
void throw_on_defects(const WorkingSurface& surface, const EdgeTable& edges, const Defects& defects, const Orientation& orientation,
                      const StitchOptions& options, const RunContext& context);

/// \throws Error(self_intersection), places = crossing pairs + facets of zero area that could not be removed.
[[noreturn]] void throw_self_intersection(const WorkingSurface& surface, const CrossingPairs& crossings, const std::vector<std::uint32_t>& flat);

/// \throws Error(empty_surface)
[[noreturn]] void throw_empty(const WorkingSurface& surface, const StitchReport& report);

}  // namespace sterna::surfmesh
