// Height of the curved surface above the edges of the given triangles.
#pragma once

#include "geom/base/run_context.h"
#include "surfmesh/remesh/reference.h"
#include "surfmesh/remesh/straight_parts.h"

namespace sterna::surfmesh {

/// Sets the bulges of lines and of all edges. \param flat true for triangles without bulge; empty if there are none
void find_bulges(Reference& reference, const Column<TriangleId, std::uint8_t>& flat, const StraightParts& parts, const RunContext& context);

}  // namespace sterna::surfmesh
