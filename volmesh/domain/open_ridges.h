// Multiple normals at sharp convex edges of walls with layers. The wall is opened at these edges, and thin virtual triangles close the opening.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "geom/base/run_context.h"
#include "volmesh/case/ridge_options.h"
#include "volmesh/domain/domain_parts.h"

namespace sterna::volmesh {

/// Opens the ridges of the domain's wall: chains of convex edges that turn by more than open_angle.
///
/// A vertex inside a chain becomes a multi-normal fan: growth lines on one ridge base vertex, at equal angles of at most fan_angle from the normal of the wall
/// on one side to that on the other. All vertices of a chain get the same number of lines. Where chains meet or bend by more than 60 degrees there is a corner.
/// It has a growth line for each side between two chains, the growth lines of their fans, and one in the middle.
///
/// A chain ends at the first vertex that can be neither a fan nor a corner. Such vertices are: vertices where one side is not visible from one normal; vertices
/// in notches; vertices at layer boundaries that are not in one plane; vertices where edges are longer than 1e5 first heights; vertices where the opened wall
/// would intersect itself; and vertices of `closed` (of the given wall). Single vertices between two ends stay closed.
///
/// In a plane in which the wall ends (on one patch), a chain continues in its mirror image. On a periodic side it continues at the other side, and
/// Domain::partners contains the growth lines of both. The fan at such a vertex lies in the plane. Domain::border gets its edges, and its growth lines have the
/// constraint of their ridge base vertex. The outer boundary keeps a single vertex there. Vertices and triangles of the wall keep their numbers; new ones
/// follow. \pre the domain is complete, without disc cuts
/// \post the wall is closed and manifold as before. Domain::ridges describes the changes; without ridges nothing has changed
/// \throws Error(bad_argument) if the first height is too small for the coordinates, or if the wall does not have a vertex of `closed`
/// \param is_open for each patch of the wall: ridges between patches with this flag are opened
void open_ridges(const RidgeOptions& options, const Column<PatchId, std::uint8_t>& is_open, double first_height, std::span<const VertexId> closed,
                 Domain& domain, const RunContext& context);

}  // namespace sterna::volmesh
