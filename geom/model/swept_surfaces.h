// Surfaces built from curves: of revolution, extruded, ruled. Views of any surface: a part, other parameters, reversed, exchanged.
#pragma once

#include "geom/model/curve.h"
#include "geom/model/frame.h"
#include "geom/model/surface.h"

namespace sterna {

/// A profile rotated about an axis. u is the angle (right-hand rule, 0 at the profile), v the profile's parameter. It has no exact NURBS form, because a
/// rational form has a different parameter along the circles.
class RevolutionSurface final : public Surface {
 public:
  /// \throws Error(bad_argument) for an axis of zero length, or an angle range of zero length or more than a full turn
  RevolutionSurface(CurvePtr profile, const Point& axis_point, const Vec3& axis, Interval angles);
  ParameterBox domain() const override { return {angles_, profile_->domain()}; }
  bool is_periodic_u() const override;
  bool is_periodic_v() const override { return profile_->is_periodic(); }
  Point point(Uv at) const override;
  SurfaceDerivatives derivatives(Uv at) const override;
  std::vector<double> breaks_v() const override { return profile_->breaks(); }
  std::string kind() const override { return "surface of revolution"; }
  const CurvePtr& profile() const { return profile_; }
  const Point& axis_point() const { return axis_point_; }
  const Vec3& axis() const { return axis_; }

 private:
  Vec3 turned(const Vec3& v, double cosine, double sine) const { return cosine * v + sine * cross(axis_, v) + (1.0 - cosine) * dot(axis_, v) * axis_; }
  CurvePtr profile_;
  Point axis_point_;
  Vec3 axis_;
  Interval angles_;
};

/// The surface C(u) + v * direction.
class ExtrusionSurface final : public Surface {
 public:
  /// \throws Error(bad_argument) for a direction or a range of zero length
  ExtrusionSurface(CurvePtr curve, const Vec3& direction, Interval range);
  ParameterBox domain() const override { return {curve_->domain(), range_}; }
  bool is_periodic_u() const override { return curve_->is_periodic(); }
  Point point(Uv at) const override { return curve_->point(at.u) + at.v * direction_; }
  SurfaceDerivatives derivatives(Uv at) const override;
  std::vector<double> breaks_u() const override { return curve_->breaks(); }
  std::optional<NurbsSurfaceForm> exact_nurbs() const override;
  std::string kind() const override { return "extrusion"; }
  const CurvePtr& curve() const { return curve_; }
  const Vec3& direction() const { return direction_; }

 private:
  CurvePtr curve_;
  Vec3 direction_;
  Interval range_;
};

/// The surface (1 - v) A(u) + v B(u) for u and v in [0, 1]; the domain of each curve is mapped to [0, 1]. It has an exact NURBS form if both curves have one,
/// and at most one of them is rational or both have equal weights on equal knots.
class RuledSurface final : public Surface {
 public:
  RuledSurface(CurvePtr a, CurvePtr b);
  ParameterBox domain() const override { return {}; }
  bool is_periodic_u() const override { return a_->is_periodic() && b_->is_periodic(); }
  Point point(Uv at) const override { return (1.0 - at.v) * a_->point(at.u) + at.v * b_->point(at.u); }
  SurfaceDerivatives derivatives(Uv at) const override;
  std::vector<double> breaks_u() const override;
  std::optional<NurbsSurfaceForm> exact_nurbs() const override;
  std::string kind() const override { return "ruled surface"; }
  const CurvePtr& a() const { return a_; }  ///< over [0, 1]
  const CurvePtr& b() const { return b_; }

 private:
  CurvePtr a_, b_;
};

/// The surface base(scale_u * p + shift_u, scale_v * q + shift_v), where (p, q) is the view's (u, v), or its (v, u) when exchanged.
class SurfaceView final : public Surface {
 public:
  struct Map {
    double scale = 1.0;
    double shift = 0.0;
    double operator()(double t) const { return scale * t + shift; }
    friend bool operator==(const Map&, const Map&) = default;
  };
  /// `domain` is that of the view.
  /// \throws Error(bad_argument) for a scale of 0, or a part that is not within the base (to 1e-9) where the base is not periodic
  SurfaceView(SurfacePtr base, const ParameterBox& domain, Map u, Map v, bool is_exchanged = false);
  ParameterBox domain() const override { return domain_; }
  bool is_periodic_u() const override;
  bool is_periodic_v() const override;
  Point point(Uv at) const override { return base_->point(base_uv(at)); }
  SurfaceDerivatives derivatives(Uv at) const override;
  void points(std::span<const Uv> at, std::span<Point> points) const override;
  std::vector<double> breaks_u() const override;
  std::vector<double> breaks_v() const override;
  std::optional<NurbsSurfaceForm> exact_nurbs() const override;
  std::string kind() const override { return base_->kind(); }
  const SurfacePtr& base() const { return base_; }
  /// Returns the base's parameters for parameters of the view.
  Uv base_uv(Uv at) const { return is_exchanged_ ? Uv{u_(at.v), v_(at.u)} : Uv{u_(at.u), v_(at.v)}; }
  Map map_u() const { return u_; }
  Map map_v() const { return v_; }
  bool is_exchanged() const { return is_exchanged_; }

 private:
  SurfacePtr base_;
  ParameterBox domain_;
  Map u_, v_;
  bool is_exchanged_;
};
/// Returns the part of a surface over `box`, with the same parameters.
SurfacePtr part_of(const SurfacePtr& surface, const ParameterBox& box);
/// Returns the same surface with its parameters mapped linearly to `box`.
SurfacePtr reparametrised(const SurfacePtr& surface, const ParameterBox& box);
/// Returns the surface reversed along u (the normal is reversed) over the same domain.
SurfacePtr reversed_u(const SurfacePtr& surface);
SurfacePtr reversed_v(const SurfacePtr& surface);
/// Returns S(v, u) (the normal is reversed).
SurfacePtr exchanged(const SurfacePtr& surface);

}  // namespace sterna
