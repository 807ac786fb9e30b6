// What an engine must never see: it accepts such boundaries and crashes or answers nonsense.
#pragma once

#include "geom/base/error.h"
#include "geom/base/run_context.h"
#include "volmesh/tetra/tetra.h"

namespace sterna::volmesh {

/// Indices in range, corners different and not collinear (exact), coordinates finite, every point used, no two points at one place, every edge of exactly two
/// triangles of opposite sense. Not: self-intersections. Of sheets, facets inside the domain, all but the last. Parallel, O(n log n).
/// \throws Error as fill() says.
void check_boundary(const TetraBoundary& boundary, const RunContext& context, std::span<const std::array<std::uint32_t, 3>> sheets = {});

/// "boundary triangle 12 of patch "wing" <what>" and its centroid.
ErrorPlace place_of_triangle(const TetraBoundary& boundary, std::size_t triangle, const std::string& what);
/// Adds a triangle with points of its own to the geometry of a failure.
void add_triangle(TroubleGeometry& geometry, const TetraBoundary& boundary, std::size_t triangle);

}  // namespace sterna::volmesh
