// Private to surfmesh/stitch: removes redundant facets, which have a repeated vertex, no area, or a duplicate.
#pragma once

#include "surfmesh/stitch/edge_table.h"
#include "surfmesh/stitch/stitch_surface.h"
#include "surfmesh/stitch/working_surface.h"

namespace sterna::surfmesh {

/// Drops facets with a repeated vertex. Their neighbours stay connected, because their edges coincide.
void drop_degenerate_facets(WorkingSurface& surface, StitchReport& report);

/// Keeps one of several facets with the same three vertices. A connected patch of such facets is dropped completely if the rest of the surface is closed
/// without it, that is, if the number of other facets is even at every edge where the patch meets them. Examples are a doubled membrane inside a body, and a
/// fin without thickness.
/// \pre no facet has a repeated vertex.
void drop_doubled_facets(WorkingSurface& surface, StitchReport& report);

/// Removes facets of exactly zero area (three different vertices on a line) without moving the surface. The middle vertex lies on the long edge, so a flip of
/// that edge passes the vertex to the neighbour, which is split there. Such facets typically fill T-junctions.
/// \pre at most two facets at each edge, consistent orientation. \return facets for which no flip was possible
std::vector<std::uint32_t> flip_flat_facets(WorkingSurface& surface, StitchReport& report);

struct ThinParts {
  std::vector<char> is_thin;  ///< flag of each facet
  std::int64_t count = 0;     ///< number of thin parts
};

/// Finds closed parts that are flat or as thin as a line. Their thickness is below 1e-9 of their own length, or of `length` if that is more; such a thickness
/// is due to rounding. Returns none if all parts would be thin.
ThinParts find_thin_parts(const std::vector<Vec3>& points, const std::vector<Facet>& facets, const EdgeTable& edges, double length = 0.0);

/// Drops parts without thickness and adds a message. Such parts have no inside, so no engine can fill the volume around them. Cutting leaves such parts, often
/// four facets in one plane.
/// \pre no facet has a repeated vertex. \return true if there were any; `edges` then describe the surface before the call
bool drop_parts_without_thickness(WorkingSurface& surface, const EdgeTable& edges, StitchReport& report);

/// Returns true if three points lie on one line (exact test).
bool is_collinear(const Vec3& a, const Vec3& b, const Vec3& c);

}  // namespace sterna::surfmesh
