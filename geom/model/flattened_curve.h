// A curve moved into a plane of constant x, y or z. Used for the symmetry boundary of a half model, which must lie exactly in its plane.
#pragma once

#include "geom/model/curve.h"

namespace sterna {

/// The curve C(t) with one coordinate set to a value; it returns exactly that value for any t.
class FlattenedCurve final : public Curve {
 public:
  FlattenedCurve(CurvePtr base, std::size_t axis, double at) : base_(std::move(base)), axis_(axis), at_(at) {}
  Interval domain() const override { return base_->domain(); }
  bool is_periodic() const override { return base_->is_periodic(); }
  Point point(double t) const override;
  CurveDerivatives derivatives(double t) const override;
  std::vector<double> breaks() const override { return base_->breaks(); }
  std::optional<NurbsCurveForm<Point>> exact_nurbs() const override;
  const CurvePtr& base() const { return base_; }
  std::size_t axis() const { return axis_; }
  double at() const { return at_; }

 private:
  CurvePtr base_;
  std::size_t axis_;
  double at_;
};

}  // namespace sterna
