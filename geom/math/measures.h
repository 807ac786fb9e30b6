// Measures of triangles, tetrahedra and wedges (prisms with bilinear sides).
#pragma once

#include <array>

#include "geom/base/vec3.h"

namespace sterna {

/// Returns the area vector: half the cross product, right-hand normal times area, m^2.
inline Vec3 area_vector(const Vec3& a, const Vec3& b, const Vec3& c) { return 0.5 * cross(b - a, c - a); }
inline double triangle_area(const Vec3& a, const Vec3& b, const Vec3& c) { return norm(area_vector(a, b, c)); }
/// Returns the angle at `a` in radians.
inline double corner_angle(const Vec3& a, const Vec3& b, const Vec3& c) { return angle_between(b - a, c - a); }
/// Returns the signed volume, m^3; positive if d lies on the normal's side of (a, b, c).
inline double tet_volume(const Vec3& a, const Vec3& b, const Vec3& c, const Vec3& d) { return dot(cross(b - a, c - a), d - a) / 6.0; }
/// Returns the smallest and largest dihedral angle of a tetrahedron in radians.
std::array<double, 2> tet_dihedral_range(const std::array<Vec3, 4>& p);

/// A wedge in CGNS order: base 0 1 2, top 3 4 5, growth edges 0-3, 1-4, 2-5; sides are bilinear.
using WedgePoints = std::array<Vec3, 6>;

/// Returns the exact volume of a wedge with bilinear sides (flux through each side = mean of its two triangulations), m^3. Accurate to the rounding of the
/// terms height times base area, also for very flat wedges.
double wedge_volume(const WedgePoints& p);
/// Returns the flux of x/3 relative to `origin` through the bilinear quad a b c d (right-hand normal), m^3; summed over all faces of a cell it is the volume.
double bilinear_flux(const Vec3& origin, const Vec3& a, const Vec3& b, const Vec3& c, const Vec3& d);

/// Exact wedge test of docs/method/validity.md, "Exact wedge test". The Jacobian of the trilinear map is linear over the triangle and quadratic along the
/// height. It is positive everywhere iff along each growth edge k, with b0 = J_k(0), b2 = J_k(1), b1 = 2 J_k(1/2) - (b0 + b2)/2: b0 > 0, b2 > 0 and b1 >
/// -sqrt(b0 b2). Uses a floating-point filter with a forward error bound (about 14 M wedges/s/core) and decides the remaining cases in exact arithmetic (3 us).
/// Returns false if a coordinate is not finite. Coordinates must be zero or of magnitude 1e-36 .. 1e48.
bool is_wedge_valid(const WedgePoints& p);
/// Returns the smallest of the nine numbers b0, b1', b2 over the three edges (b1' = b1 + sqrt(b0 b2) if b0, b2 > 0), each divided by the product of the lengths
/// of the three edges that meet there (for b1': twice the geometric mean of the products at both ends). This is a scaled Jacobian in (-inf, 1]: positive iff
/// valid (up to rounding), at most 0 if an edge has zero length. For reports and heuristics.
double wedge_quality(const WedgePoints& p);

/// Tests a pyramid with bilinear base 0123 and apex 4 (CGNS). The Jacobian is bilinear over the base, so the pyramid is valid iff the four tets (corner, its
/// two base neighbours, apex) have positive volume. Exact.
bool is_pyramid_valid(const std::array<Vec3, 5>& p);
double pyramid_volume(const std::array<Vec3, 5>& p);
/// Returns true if the volume is positive. Exact sign test.
bool is_tet_valid(const std::array<Vec3, 4>& p);
/// The next two functions take a hexahedron with bilinear faces (CGNS order). The volume is computed from the exact flux. The validity is tested with the 27
/// Bernstein coefficients of the Jacobian and subdivision; the test is conservative: false if positivity could not be proved within the subdivision limit.
double hexahedron_volume(const std::array<Vec3, 8>& p);
bool is_hexahedron_valid(const std::array<Vec3, 8>& p);

}  // namespace sterna
