// From metres to pixels: a direction of view, orthographic or perspective.
#pragma once

#include "geom/base/vec3.h"

namespace sterna::draw {

/// A point on the picture. Depth is larger for what is nearer and linear over a plane's picture.
struct Projected {
  double x = 0.0, y = 0.0;  ///< pixels, y down
  double depth = 0.0;
};

struct Camera {
  Vec3 right{1, 0, 0}, up{0, 0, 1}, toward{0, -1, 0};  ///< unit, right-handed; `toward` points from what is seen to the eye
  Point target;
  double distance = 0.0;    ///< m from the target to the eye; 0: orthographic
  double scale = 1.0;       ///< pixels per metre at the target
  double x = 0.0, y = 0.0;  ///< pixels, where the target is seen

  bool is_perspective() const { return distance > 0.0; }
  /// How far in front of the eye, m; only for perspective.
  double ahead(const Point& p) const { return distance - dot(p - target, toward); }
  /// \pre perspective: ahead(p) > 0
  Projected project(const Point& p) const {
    const Vec3 v = p - target;
    const double zoom = is_perspective() ? scale * distance / ahead(p) : scale;
    return {x + zoom * dot(v, right), y - zoom * dot(v, up), is_perspective() ? 1.0 / ahead(p) : dot(v, toward)};
  }
  /// Unit vector from a point to the eye.
  Vec3 to_eye(const Point& p) const { return is_perspective() ? normalized(target + distance * toward - p) : toward; }
};

/// Looks along -toward, z upwards in the picture (y where it looks along z).
/// \pre toward is no zero vector
Camera camera_towards(const Vec3& toward);

}  // namespace sterna::draw
