// Periodic sides: the triangulation of one end surface, carried to its translated partner.
#pragma once

#include "volmesh/rims/end_surface.h"

namespace sterna::volmesh {

/// Largest distance of a point of a loop from its translated partner, of the body length.
inline constexpr double k_periodic_tolerance = 1e-10;

/// The triangles of `from` for `to`, whose loops are those of `from` moved by `translation` within k_periodic_tolerance * body_length: in the same sense, or
/// all in the opposite one (sides that face each other), then triangles are turned over. New points are moved exactly; in a plane along a coordinate axis they
/// have its coordinate to the bit. The n-th new points of both are partners.
/// \pre `triangles` are of `from`.
/// \throws Error(bad_argument) with the places where loops do not match
EndTriangles copy_translated(const EndRegion& from, const EndTriangles& triangles, const EndRegion& to, const Vec3& translation, double body_length);

}  // namespace sterna::volmesh
