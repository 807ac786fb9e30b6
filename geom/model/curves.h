// Lines, circles and ellipses in space and in parameter planes; sub-curves and reparametrisations of any curve.
#pragma once

#include "geom/model/curve.h"
#include "geom/model/frame.h"

namespace sterna {

/// The line origin + t * direction; the direction's length is the speed.
class LineCurve final : public Curve {
 public:
  /// \throws Error(bad_argument) for a direction or a domain of zero length
  LineCurve(const Point& origin, const Vec3& direction, Interval domain);
  Interval domain() const override { return domain_; }
  Point point(double t) const override { return origin_ + t * direction_; }
  CurveDerivatives derivatives(double t) const override { return {point(t), direction_, {}}; }
  std::optional<NurbsCurveForm<Point>> exact_nurbs() const override;
  const Point& origin() const { return origin_; }
  const Vec3& direction() const { return direction_; }

 private:
  Point origin_;
  Vec3 direction_;
  Interval domain_;
};
/// Returns the line segment from a to b with t in [0, distance].
/// \throws Error(bad_argument) when they coincide
CurvePtr segment(const Point& a, const Point& b);

/// The circle or ellipse centre + cos t * x + sin t * y, or an arc of it; periodic if the domain is a full turn. x and y are the half axes. It has no exact
/// NURBS form, because a rational form has a different parameter.
class EllipseCurve final : public Curve {
 public:
  /// \throws Error(bad_argument) if x and y are not orthogonal (to 1e-9) or have zero length, or the domain has zero length or is more than a full turn
  EllipseCurve(const Point& centre, const Vec3& x, const Vec3& y, Interval domain);
  Interval domain() const override { return domain_; }
  bool is_periodic() const override { return is_periodic_; }
  Point point(double t) const override;
  CurveDerivatives derivatives(double t) const override;
  const Point& centre() const { return centre_; }
  const Vec3& x() const { return x_; }
  const Vec3& y() const { return y_; }

 private:
  Point centre_;
  Vec3 x_, y_;
  Interval domain_;
  bool is_periodic_;
};
/// Returns the circle about frame.z.
/// \throws Error(bad_argument) unless radius > 0
CurvePtr circle(const Frame& frame, double radius, Interval angles);

/// The curve base(scale * t + shift) with its own domain: a part of the base, a rescaled parameter, or the reversed curve (scale < 0).
class CurveView final : public Curve {
 public:
  /// \throws Error(bad_argument) for scale 0, or if the image of the domain is not within that of the base (to 1e-9 of its length) and the base is not periodic
  CurveView(CurvePtr base, Interval domain, double scale, double shift);
  Interval domain() const override { return domain_; }
  bool is_periodic() const override;
  Point point(double t) const override { return base_->point(scale_ * t + shift_); }
  CurveDerivatives derivatives(double t) const override;
  std::vector<double> breaks() const override;
  std::optional<NurbsCurveForm<Point>> exact_nurbs() const override;
  const CurvePtr& base() const { return base_; }
  double scale() const { return scale_; }
  double shift() const { return shift_; }

 private:
  CurvePtr base_;
  Interval domain_;
  double scale_, shift_;
};
/// Returns the part `range` of a curve, with the same parameter.
CurvePtr part_of(const CurvePtr& curve, Interval range);
/// Returns the same curve with its parameter mapped linearly to `domain`.
CurvePtr reparametrised(const CurvePtr& curve, Interval domain);
/// Returns the reversed curve over the same domain.
CurvePtr reversed(const CurvePtr& curve);

/// The line origin + t * direction in a parameter plane.
class ParameterLine final : public ParameterCurve {
 public:
  /// \throws Error(bad_argument) for a direction or a domain of zero length
  ParameterLine(Uv origin, Uv direction, Interval domain);
  Interval domain() const override { return domain_; }
  Uv point(double t) const override { return origin_ + t * direction_; }
  ParameterCurveDerivatives derivatives(double t) const override { return {point(t), direction_}; }
  std::optional<NurbsCurveForm<Uv>> exact_nurbs() const override;
  Uv origin() const { return origin_; }
  Uv direction() const { return direction_; }

 private:
  Uv origin_, direction_;
  Interval domain_;
};
/// Returns the line from a at the domain's start to b at its end.
/// \throws Error(bad_argument) when they coincide
ParameterCurvePtr parameter_segment(Uv a, Uv b, Interval domain = {0.0, 1.0});

/// The circle or ellipse centre + cos t * x + sin t * y in a parameter plane, or an arc of it. It has no exact NURBS form, as EllipseCurve.
class ParameterArc final : public ParameterCurve {
 public:
  /// \throws Error(bad_argument) if x and y are parallel or the domain has zero length
  ParameterArc(Uv centre, Uv x, Uv y, Interval domain);
  Interval domain() const override { return domain_; }
  Uv point(double t) const override;
  ParameterCurveDerivatives derivatives(double t) const override;
  Uv centre() const { return centre_; }
  Uv x() const { return x_; }
  Uv y() const { return y_; }

 private:
  Uv centre_, x_, y_;
  Interval domain_;
};

}  // namespace sterna
