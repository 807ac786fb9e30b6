// Copies the triangulation of an adjacent patch to its translated partner, for periodic sides.
#pragma once

#include "volmesh/adjacent/adjacent_surface.h"

namespace sterna::volmesh {

/// Largest distance of a loop's point from its translated partner, as a fraction of the body length.
inline constexpr double k_periodic_tolerance = 1e-10;

/// Returns the triangles of `from` for `to`. The loops of `to` must be those of `from`, moved by `translation` within k_periodic_tolerance * body_length. They
/// have the same direction, or all have the opposite direction (opposing sides); in that case triangles are reversed. New points are moved exactly. In a plane
/// along a coordinate axis they have bit-exactly the coordinate of the plane. The n-th new points of both regions are partners.
/// \pre `triangles` belong to `from`
/// \throws Error(bad_argument) with the locations where loops do not match
AdjacentTriangles copy_translated(const AdjacentRegion& from, const AdjacentTriangles& triangles, const AdjacentRegion& to, const Vec3& translation,
                                  double body_length);

}  // namespace sterna::volmesh
