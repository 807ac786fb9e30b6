// Private to surfmesh/stitch: merges vertices that the files store several times.
#pragma once

#include "geom/base/run_context.h"
#include "surfmesh/stitch/stitch_surface.h"
#include "surfmesh/stitch/working_surface.h"

namespace sterna::surfmesh {

/// Joins the soups, welds vertices whose coordinates are equal (-0 = +0) and drops unused ones; numbered by first use. Facets with a repeated vertex stay.
/// \throws Error(file_malformed) for an index out of range or a coordinate that is not finite, Error(empty_surface) when there is no facet.
WorkingSurface weld_exact(const std::vector<SurfaceSoup>& soups, const StitchOptions& options, StitchReport& report);

/// Welds near vertices. With a given tolerance: all vertices within it, always. Automatic: only if the surface is open, only vertices of its boundary, within
/// the rounding of the file's own numbers, and only if that closes edges and adds no crowded edge and no pinched vertex; so small features survive. A chain
/// of near vertices becomes one vertex, at the location of the first.
/// \throws Error(bad_argument) for a tolerance above 2 % of the body length.
/// \post no facet has a repeated vertex or a copy.
void weld_near(WorkingSurface& surface, const StitchOptions& options, StitchReport& report, const RunContext& context);

/// Returns the tolerance used by weld_near, metres.
double weld_tolerance_in_use(const WorkingSurface& surface, const StitchOptions& options);

/// Gives each edge-connected part its own copy of the vertices in which parts merely touch, so that contact is detected as a crossing.
void separate_parts(WorkingSurface& surface);

}  // namespace sterna::surfmesh
