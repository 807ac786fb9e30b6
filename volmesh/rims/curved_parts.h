// Splits a curved adjacent patch into triangles of the original that stay and parts that can each be meshed in one projection.
#pragma once

#include <vector>

#include "geom/base/run_context.h"
#include "volmesh/rims/end_part.h"

namespace sterna::volmesh {

/// Splits the region. Triangles that stay go to `result` (their vertices as new points where they are not points of the region); the edges of the parts index
/// points of both.
/// \pre region.original is not null.
/// \throws Error(geometry_failed) for a footprint around which no part has a projection, with the location
std::vector<EndPart> split_curved(const EndRegion& region, EndTriangles& result, const RunContext& context);

}  // namespace sterna::volmesh
