// Splines: NURBS curves in space and in parameter planes, with a fast evaluator.
#pragma once

#include "geom/model/curve.h"
#include "geom/model/knot_basis.h"

namespace sterna {

/// Any NURBS curve, degree 1 .. 25.
class NurbsCurve final : public Curve {
 public:
  /// `is_periodic`: the end equals the start, and parameters outside the domain are wrapped.
  /// \throws Error(bad_argument) if the form is invalid
  explicit NurbsCurve(NurbsCurveForm<Point> form, bool is_periodic = false);
  Interval domain() const override { return basis_.domain(); }
  bool is_periodic() const override { return basis_.is_periodic(); }
  Point point(double t) const override;
  CurveDerivatives derivatives(double t) const override;
  std::vector<double> breaks() const override { return basis_.breaks(); }
  std::optional<NurbsCurveForm<Point>> exact_nurbs() const override { return form_; }
  const NurbsCurveForm<Point>& form() const { return form_; }

 private:
  NurbsCurveForm<Point> form_;
  KnotBasis basis_;
  std::vector<Lanes4> poles_;  ///< w * (x, y, z, 1)
};

/// Any NURBS curve in a parameter plane.
class NurbsParameterCurve final : public ParameterCurve {
 public:
  /// \throws Error(bad_argument) if the form is invalid
  explicit NurbsParameterCurve(NurbsCurveForm<Uv> form);
  Interval domain() const override { return curve_.domain(); }
  Uv point(double t) const override;
  ParameterCurveDerivatives derivatives(double t) const override;
  std::optional<NurbsCurveForm<Uv>> exact_nurbs() const override { return form_; }
  const NurbsCurveForm<Uv>& form() const { return form_; }

 private:
  NurbsCurveForm<Uv> form_;
  NurbsCurve curve_;  ///< the same curve with z = 0
};

}  // namespace sterna
