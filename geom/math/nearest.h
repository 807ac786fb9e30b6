// Nearest points on segments and triangles.
#pragma once

#include <algorithm>
#include <array>

#include "geom/base/vec3.h"

namespace sterna {

/// Returns the point of the segment nearest to p. A segment of zero length is treated as its first end. Source: C. Ericson, "Real-Time Collision Detection"
/// (2005), section 5.1.
inline Point nearest_on_segment(const Point& p, const Point& a, const Point& b) {
  const Vec3 e = b - a;
  const double length2 = norm2(e);
  return length2 > 0.0 ? a + std::clamp(dot(p - a, e) / length2, 0.0, 1.0) * e : a;
}

/// Returns the point of the triangle nearest to p. A triangle of zero area is treated as its edges. Source: as above.
inline Point nearest_on_triangle(const Point& p, const std::array<Point, 3>& t) {
  const Vec3 u = t[1] - t[0];
  const Vec3 v = t[2] - t[0];
  const Vec3 normal = cross(u, v);
  const double n2 = norm2(normal);
  const Vec3 w = p - t[0];
  const double beta = dot(cross(w, v), normal);
  const double gamma = dot(cross(u, w), normal);
  if (n2 > 0.0 && beta >= 0.0 && gamma >= 0.0 && beta + gamma <= n2) return t[0] + (beta / n2) * u + (gamma / n2) * v;
  Point best = nearest_on_segment(p, t[0], t[1]);
  for (const Point& q : {nearest_on_segment(p, t[1], t[2]), nearest_on_segment(p, t[2], t[0])}) {
    if (norm2(q - p) < norm2(best - p)) best = q;
  }
  return best;
}

}  // namespace sterna
