// The exact sphere predicate; see predicates.h.
#pragma once

#include "geom/base/vec3.h"

namespace sterna {

/// +1 when e lies inside the sphere through a, b, c, d given as a positive tetrahedron, 0 on it (the sign flips with the orientation). About 20 ns; where only
/// exact arithmetic can decide, some 50 us.
int insphere(const Vec3& a, const Vec3& b, const Vec3& c, const Vec3& d, const Vec3& e);

}  // namespace sterna
