// Private to surfmesh/stitch: merges vertices that the files store several times.
#pragma once

#include "geom/base/run_context.h"
#include "surfmesh/stitch/stitch_surface.h"
#include "surfmesh/stitch/working_surface.h"

namespace sterna::surfmesh {

/// Joins the soups, welds vertices with equal coordinates (-0 = +0) and drops unused vertices. Vertices are numbered by first use. Facets with a repeated
/// vertex stay.
/// \throws Error(file_malformed) for an index out of range or a coordinate that is not finite; Error(empty_surface) if there is no facet
WorkingSurface weld_exact(const std::vector<SurfaceSoup>& soups, const StitchOptions& options, StitchReport& report);

/// Welds near vertices. With a given tolerance all vertices within it are welded, always. Automatic welding happens only if the surface is open, and only
/// between vertices of its boundary, within the rounding of the file's own numbers. It must close edges and must add no crowded edge and no pinched vertex, so
/// small features stay. A chain of near vertices becomes one vertex, at the location of the first.
/// \throws Error(bad_argument) for a tolerance above 2 % of the body length
/// \post no facet has a repeated vertex or a copy
void weld_near(WorkingSurface& surface, const StitchOptions& options, StitchReport& report, const RunContext& context);

/// Returns the tolerance in metres that weld_near uses.
double weld_tolerance_in_use(const WorkingSurface& surface, const StitchOptions& options);

/// Gives each edge-connected part its own copies of the vertices in which parts merely touch, so that a contact is detected as a crossing.
void separate_parts(WorkingSurface& surface);

}  // namespace sterna::surfmesh
