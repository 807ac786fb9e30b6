// Plane, cylinder, cone, sphere and torus with OpenCASCADE's parameters. Only the plane has an exact NURBS form: a rational form of the others has a different
// parameter along the circles.
#pragma once

#include <numbers>

#include "geom/model/frame.h"
#include "geom/model/surface.h"

namespace sterna {

inline constexpr Interval k_full_turn{0.0, 2.0 * std::numbers::pi};

/// The plane origin + u x + v y.
class PlaneSurface final : public Surface {
 public:
  /// \throws Error(bad_argument) for a box of zero size
  PlaneSurface(const Frame& frame, const ParameterBox& box);
  ParameterBox domain() const override { return box_; }
  Point point(Uv at) const override { return frame_.origin + at.u * frame_.x + at.v * frame_.y; }
  SurfaceDerivatives derivatives(Uv at) const override { return {point(at), frame_.x, frame_.y, {}, {}, {}}; }
  std::optional<NurbsSurfaceForm> exact_nurbs() const override;
  std::string kind() const override { return "plane"; }
  const Frame& frame() const { return frame_; }

 private:
  Frame frame_;
  ParameterBox box_;
};

/// The surface origin + a(v) (cos u x + sin u y) + b(v) z: base class of all surfaces of revolution below. Periodic in u if the box is a full turn.
class RoundSurface : public Surface {
 public:
  ParameterBox domain() const final { return box_; }
  bool is_periodic_u() const final;
  Point point(Uv at) const final;
  SurfaceDerivatives derivatives(Uv at) const final;
  const Frame& frame() const { return frame_; }

 protected:
  RoundSurface(const Frame& frame, const ParameterBox& box, const char* attempted);

 private:
  struct Profile {
    double a, a1, a2;  ///< distance a(v) from the axis, with first and second derivative
    double b, b1, b2;  ///< height b(v) along the axis, with first and second derivative
  };
  virtual Profile profile(double v) const = 0;
  friend class CylinderSurface;
  friend class ConeSurface;
  friend class SphereSurface;
  friend class TorusSurface;
  Frame frame_;
  ParameterBox box_;
};

/// Surface of revolution with a = radius, b = v.
class CylinderSurface final : public RoundSurface {
 public:
  /// \throws Error(bad_argument) unless radius > 0 and the box has a size, at most a full turn in u; the same condition applies to the classes below
  CylinderSurface(const Frame& frame, double radius, const ParameterBox& box);
  std::string kind() const override { return "cylinder"; }
  double radius() const { return radius_; }

 private:
  Profile profile(double v) const override { return {radius_, 0.0, 0.0, v, 1.0, 0.0}; }
  double radius_;
};

/// Surface of revolution with a = radius + v sin(half_angle), b = v cos(half_angle).
class ConeSurface final : public RoundSurface {
 public:
  /// \throws Error(bad_argument) also unless radius >= 0 and 0 < |half_angle| < pi/2
  ConeSurface(const Frame& frame, double radius, double half_angle, const ParameterBox& box);
  std::string kind() const override { return "cone"; }
  double radius() const { return radius_; }
  double half_angle() const { return half_angle_; }

 private:
  Profile profile(double v) const override;
  double radius_, half_angle_;
};

/// Surface of revolution with a = radius cos v, b = radius sin v. It has poles at v = +-pi/2.
class SphereSurface final : public RoundSurface {
 public:
  SphereSurface(const Frame& frame, double radius, const ParameterBox& box = {k_full_turn, {-0.5 * std::numbers::pi, 0.5 * std::numbers::pi}});
  std::string kind() const override { return "sphere"; }
  double radius() const { return radius_; }

 private:
  Profile profile(double v) const override;
  double radius_;
};

/// Surface of revolution with a = major + minor cos v, b = minor sin v. It is also periodic in v if the box is a full turn.
class TorusSurface final : public RoundSurface {
 public:
  TorusSurface(const Frame& frame, double major, double minor, const ParameterBox& box = {k_full_turn, k_full_turn});
  bool is_periodic_v() const override;
  std::string kind() const override { return "torus"; }
  double major_radius() const { return major_; }
  double minor_radius() const { return minor_; }

 private:
  Profile profile(double v) const override;
  double major_, minor_;
};

}  // namespace sterna
