// Sharp convex edges of walls with layers get several normals: the wall is opened there, and what is open is closed by thin virtual triangles.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "geom/base/run_context.h"
#include "volmesh/case/ridge_options.h"
#include "volmesh/domain/domain_parts.h"

namespace sterna::volmesh {

/// Opens the ridges of the domain's wall: chains of convex edges that turn by more than open_angle. A vertex inside a chain becomes a fan of lines on one foot,
/// at equal angles of at most fan_angle from the normal of the wall on one side to that on the other; all vertices of a chain get as many. Where chains meet or
/// bend by more than 60 degrees there is a corner: a line for each side between two chains, those of their fans, and one in the middle. A chain ends at the
/// first vertex that can be neither: where one side is not seen from one normal, in notches, at rims of the wall that are not in one plane, where edges are
/// longer than 1e5 first heights, where the opened wall would cross itself, and at vertices of `closed` (of the given wall). Single vertices between two ends
/// stay closed. In a plane on which the wall ends (on one patch) a chain goes on in its mirror image, on a periodic side at the other one, where
/// Domain::partners gets the lines of both: the fan there lies in the plane, Domain::rim gets its edges, and its lines have the constraint of their foot; the
/// outer boundary keeps one vertex there. Vertices and triangles of the wall keep their numbers, new ones follow. \pre domain made, no slits
/// \post wall closed and manifold as before, Domain::ridges says what was done; without ridges nothing has changed
/// \throws Error(bad_argument) where the first height is too small for the coordinates, and for vertices of `closed` that the wall has not
/// \param is_open of each patch of the wall: ridges between patches that are
void open_ridges(const RidgeOptions& options, const Column<PatchId, std::uint8_t>& is_open, double first_height, std::span<const VertexId> closed,
                 Domain& domain, const RunContext& context);

}  // namespace sterna::volmesh
