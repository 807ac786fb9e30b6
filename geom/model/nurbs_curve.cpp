#include "geom/model/nurbs_curve.h"

#include <cmath>
#include <string>

#include "geom/base/error.h"
#include "geom/model/nurbs_tools.h"

namespace sterna {
namespace {

constexpr std::string_view k_nurbs_curve_attempt = "making a NURBS curve";

NurbsCurveForm<Point> in_space(const NurbsCurveForm<Uv>& form) {
  NurbsCurveForm<Point> result{form.degree, form.knots, {}, form.weights};
  for (const Uv p : form.poles) result.poles.push_back({p.u, p.v, 0.0});
  return result;
}

}  // namespace

NurbsCurve::NurbsCurve(NurbsCurveForm<Point> form, bool is_periodic)
    : form_(std::move(form)),
      basis_(form_.degree, form_.knots, is_periodic, k_nurbs_curve_attempt),
      poles_(weighted_poles(form_.poles, form_.weights, basis_.n_functions(), k_nurbs_curve_attempt)) {}

Point NurbsCurve::point(double t) const {
  BasisValues basis;
  basis_.evaluate<false>(t, basis);
  const Lanes4* pole = poles_.data() + basis.first;
  Lanes4::Value sum{};
  for (int k = 0; k <= basis_.degree(); ++k) sum += basis.value[k] * pole[k].value;
  if (form_.weights.empty()) return {sum[0], sum[1], sum[2]};
  return Point{sum[0], sum[1], sum[2]} / sum[3];
}

CurveDerivatives NurbsCurve::derivatives(double t) const {
  BasisValues basis;
  basis_.evaluate<true>(t, basis);
  const Lanes4* pole = poles_.data() + basis.first;
  Lanes4::Value sum{}, sum1{}, sum2{};
  for (int k = 0; k <= basis_.degree(); ++k) {
    sum += basis.value[k] * pole[k].value;
    sum1 += basis.d1[k] * pole[k].value;
    sum2 += basis.d2[k] * pole[k].value;
  }
  CurveDerivatives d{{sum[0], sum[1], sum[2]}, {sum1[0], sum1[1], sum1[2]}, {sum2[0], sum2[1], sum2[2]}};
  if (form_.weights.empty()) return d;
  const double r = 1.0 / sum[3];
  d.point *= r;
  d.first = r * (d.first - sum1[3] * d.point);
  d.second = r * (d.second - 2.0 * sum1[3] * d.first - sum2[3] * d.point);
  return d;
}

NurbsParameterCurve::NurbsParameterCurve(NurbsCurveForm<Uv> form) : form_(std::move(form)), curve_(in_space(form_)) {}

Uv NurbsParameterCurve::point(double t) const {
  const Point p = curve_.point(t);
  return {p.x, p.y};
}

ParameterCurveDerivatives NurbsParameterCurve::derivatives(double t) const {
  const CurveDerivatives d = curve_.derivatives(t);
  return {{d.point.x, d.point.y}, {d.first.x, d.first.y}};
}

}  // namespace sterna
