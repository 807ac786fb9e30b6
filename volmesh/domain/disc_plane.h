// The plane of an actuator disc.
#pragma once

#include <cmath>

#include "geom/base/vec3.h"
#include "volmesh/case/actuator_disc.h"

namespace sterna::volmesh {

/// Plane of a disc. If the plane is normal to a coordinate axis, its points have bit-exactly the coordinate of the centre on that axis.
class DiscPlane {
 public:
  /// \pre the disc's numbers are valid (require_sane)
  explicit DiscPlane(const ActuatorDisc& disc) : center_(disc.center), normal_(normalized(disc.axis)), inner_(disc.inner_radius), outer_(disc.radius) {
    for (int k = 0; k < 3; ++k)
      if (std::abs(normal_[static_cast<std::size_t>(k)]) == 1.0) axis_ = k;
  }
  const Vec3& normal() const { return normal_; }  ///< unit, downstream
  const Point& center() const { return center_; }
  double inner() const { return inner_; }
  double outer() const { return outer_; }
  /// Returns the distance from the plane in metres, positive downstream.
  double height(const Point& p) const {
    if (axis_ < 0) return dot(p - center_, normal_);
    const auto k = static_cast<std::size_t>(axis_);
    return normal_[k] * (p[k] - center_[k]);
  }
  Point onto(Point p) const {
    if (axis_ < 0) return p - height(p) * normal_;
    p[static_cast<std::size_t>(axis_)] = center_[static_cast<std::size_t>(axis_)];
    return p;
  }
  /// Returns the distance from the axis in metres.
  double radius(const Point& p) const { return norm(onto(p) - center_); }

 private:
  Point center_;
  Vec3 normal_;
  double inner_, outer_;
  int axis_ = -1;  ///< number of the coordinate axis normal to the plane; -1: none
};

}  // namespace sterna::volmesh
