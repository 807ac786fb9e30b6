// Splits a curved adjacent patch into triangles of the original that are kept, and parts that can each be meshed in one projection.
#pragma once

#include <vector>

#include "geom/base/run_context.h"
#include "volmesh/adjacent/adjacent_part.h"

namespace sterna::volmesh {

/// Splits the region. Kept triangles are added to `result`; their vertices become new points if they are not points of the region. The edges of the parts refer
/// to points of both.
/// \pre region.original is not null
/// \throws Error(geometry_failed) with the location for a footprint around which no part has a projection
std::vector<AdjacentPart> split_curved(const AdjacentRegion& region, AdjacentTriangles& result, const RunContext& context);

}  // namespace sterna::volmesh
