// A curved end surface, cut into what stays of the original and parts that one projection each can show.
#pragma once

#include <vector>

#include "geom/base/run_context.h"
#include "volmesh/rims/end_part.h"

namespace sterna::volmesh {

/// Kept triangles go to `result` (their vertices as new points where they are not points of the region); the parts' edges index both.
/// \pre region.original is there.
/// \throws Error(geometry_failed) for a footprint around which no part has a projection, with the place
std::vector<EndPart> split_curved(const EndRegion& region, EndTriangles& result, const RunContext& context);

}  // namespace sterna::volmesh
