// Periodic sides: copies the triangulation of one adjacent patch to its translated partner.
#pragma once

#include "volmesh/rims/end_surface.h"

namespace sterna::volmesh {

/// Largest distance of a loop's point from its translated partner, as a share of the body length.
inline constexpr double k_periodic_tolerance = 1e-10;

/// Returns the triangles of `from` for `to`, whose loops are those of `from` moved by `translation` within k_periodic_tolerance * body_length: in the same
/// sense, or all in the opposite sense (opposing sides), in which case triangles are reversed. New points are moved exactly; in a plane along a coordinate
/// axis they have the plane's coordinate to the bit. The n-th new points of both are partners.
/// \pre `triangles` belong to `from`.
/// \throws Error(bad_argument) with the locations where loops do not match
EndTriangles copy_translated(const EndRegion& from, const EndTriangles& triangles, const EndRegion& to, const Vec3& translation, double body_length);

}  // namespace sterna::volmesh
