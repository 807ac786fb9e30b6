// Checks for defects of boundaries with which an engine must never run, because it would crash or return an invalid result.
#pragma once

#include "geom/base/error.h"
#include "geom/base/run_context.h"
#include "volmesh/tetra/tetra.h"

namespace sterna::volmesh {

/// Checks that indices are in range, corners are different and not collinear (exact), coordinates are finite, every point is used, no two points coincide, and
/// every edge has exactly two triangles of opposite orientation. Self-intersections are not checked. For sheets (facets inside the domain) all these checks
/// apply except the last. Parallel, O(n log n).
/// \throws the errors documented at fill()
void check_boundary(const TetraBoundary& boundary, const RunContext& context, std::span<const std::array<std::uint32_t, 3>> baffles = {});

/// Returns the location of a triangle: the text "boundary triangle 12 of patch "wing" <what>" and its centroid.
ErrorLocation location_of_triangle(const TetraBoundary& boundary, std::size_t triangle, const std::string& what);
/// Adds a triangle with its own points to the drawing of a failure.
void add_triangle(TroubleGeometry& geometry, const TetraBoundary& boundary, std::size_t triangle);

}  // namespace sterna::volmesh
