#include "geom/model/flattened_curve.h"

namespace sterna {

Point FlattenedCurve::point(double t) const {
  Point p = base_->point(t);
  p[axis_] = at_;
  return p;
}

CurveDerivatives FlattenedCurve::derivatives(double t) const {
  CurveDerivatives d = base_->derivatives(t);
  d.point[axis_] = at_;
  d.first[axis_] = 0.0;
  d.second[axis_] = 0.0;
  return d;
}

std::optional<NurbsCurveForm<Point>> FlattenedCurve::exact_nurbs() const {
  std::optional<NurbsCurveForm<Point>> form = base_->exact_nurbs();
  if (form)
    for (Point& pole : form->poles) pole[axis_] = at_;
  return form;
}

}  // namespace sterna
