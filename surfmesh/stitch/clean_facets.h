// Private to surfmesh/stitch: facets that say nothing - with a repeated vertex, written twice, or without area.
#pragma once

#include "surfmesh/stitch/edge_table.h"
#include "surfmesh/stitch/stitch_surface.h"
#include "surfmesh/stitch/working_surface.h"

namespace sterna::surfmesh {

/// Drops facets with a repeated vertex; neighbours keep each other, for their edges fall together.
void drop_degenerate_facets(WorkingSurface& surface, StitchReport& report);

/// Of facets with the same three vertices one stays; but a connected patch of such facets is dropped altogether when the rest of the surface is closed without
/// it: when at every edge where the patch meets other facets their number is even (a doubled membrane inside a body, a fin without thickness).
/// \pre no facet has a repeated vertex.
void drop_doubled_facets(WorkingSurface& surface, StitchReport& report);

/// Removes facets of exactly zero area (three different vertices on a line) without moving the surface: the middle vertex lies on the long edge, so flipping
/// that edge hands it to the neighbour, which is split there. Such facets are what fills T-junctions.
/// \pre at most two facets at each edge, consistent orientation. \return facets for which no flip was possible.
std::vector<std::uint32_t> flip_flat_facets(WorkingSurface& surface, StitchReport& report);

struct ThinParts {
  std::vector<char> is_thin;  ///< per facet
  std::int64_t count = 0;     ///< of the parts
};

/// Closed parts that are flat or as thin as a line: a thousand millionth of their own length, or of `length` where that is more. That is rounding. None where
/// those would be all.
ThinParts find_thin_parts(const std::vector<Vec3>& points, const std::vector<Facet>& facets, const EdgeTable& edges, double length = 0.0);

/// Drops them, with a message: they have no inside, so no engine can fill what is around them. What cutting leaves, often four facets in one plane.
/// \pre no facet has a repeated vertex. \return whether there were any: `edges` are of the surface before
bool drop_parts_without_thickness(WorkingSurface& surface, const EdgeTable& edges, StitchReport& report);

/// Whether three points lie on one line; exact.
bool is_collinear(const Vec3& a, const Vec3& b, const Vec3& c);

}  // namespace sterna::surfmesh
