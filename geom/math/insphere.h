// The exact sphere predicate; see predicates.h.
#pragma once

#include "geom/base/vec3.h"

namespace sterna {

/// Returns +1 if e lies inside the sphere through a, b, c, d given as a positive tetrahedron, 0 if on it (the sign flips with the orientation). About 20 ns;
/// about 50 us if exact arithmetic is required.
int insphere(const Vec3& a, const Vec3& b, const Vec3& c, const Vec3& d, const Vec3& e);

}  // namespace sterna
