// Maps metres to pixels: a view direction, orthographic or perspective.
#pragma once

#include "geom/base/vec3.h"

namespace sterna::draw {

/// A projected point. Depth is larger for nearer points and linear over the projection of a plane.
struct Projected {
  double x = 0.0, y = 0.0;  ///< pixels, y down
  double depth = 0.0;
};

struct Camera {
  Vec3 right{1, 0, 0}, up{0, 0, 1}, toward{0, -1, 0};  ///< unit vectors, right-handed; `toward` points from the object to the eye
  Point target;
  double distance = 0.0;    ///< m from the target to the eye; 0: orthographic
  double scale = 1.0;       ///< pixels per metre at the target
  double x = 0.0, y = 0.0;  ///< pixels, position of the target in the picture

  bool is_perspective() const { return distance > 0.0; }
  /// Returns the distance in front of the eye, m; only for perspective.
  double ahead(const Point& p) const { return distance - dot(p - target, toward); }
  /// \pre perspective: ahead(p) > 0
  Projected project(const Point& p) const {
    const Vec3 v = p - target;
    const double zoom = is_perspective() ? scale * distance / ahead(p) : scale;
    return {x + zoom * dot(v, right), y - zoom * dot(v, up), is_perspective() ? 1.0 / ahead(p) : dot(v, toward)};
  }
  /// Returns the unit vector from a point to the eye.
  Vec3 to_eye(const Point& p) const { return is_perspective() ? normalized(target + distance * toward - p) : toward; }
};

/// Returns a camera that looks along -toward, z upwards in the picture (y if it looks along z).
/// \pre toward is not zero
Camera camera_towards(const Vec3& toward);

}  // namespace sterna::draw
