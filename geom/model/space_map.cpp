#include "geom/model/space_map.h"

#include <string>

#include "geom/base/error.h"
#include "geom/base/number_text.h"

namespace sterna {

FunctionMap::FunctionMap(std::function<Point(const Point&)> function, double step) : function_(std::move(function)), step_(step) {
  if (!(step > 0.0) || !std::isfinite(step))
    throw Error({.code = ErrorCode::bad_argument,
                 .attempted = "deforming by a function",
                 .problem = "the step of its derivatives is " + number_text(step) + " m, must be positive"});
}

Point FunctionMap::point(const Point& p) const {
  const Point q = function_(p);
  if (!is_finite(q))
    throw Error({.code = ErrorCode::bad_argument,
                 .attempted = "deforming by a function",
                 .problem = "the function returns numbers that are not finite here",
                 .locations = {{p, "argument"}}});
  return q;
}

SpaceMapDerivatives FunctionMap::derivatives(const Point& p) const {
  const double h = step_;
  SpaceMapDerivatives d;
  d.point = point(p);
  const Vec3 axes[3] = {{h, 0.0, 0.0}, {0.0, h, 0.0}, {0.0, 0.0, h}};
  Vec3* first[3] = {&d.dx, &d.dy, &d.dz};
  Vec3* second[3] = {&d.dxx, &d.dyy, &d.dzz};
  Vec3* mixed[3] = {&d.dyz, &d.dxz, &d.dxy};  // by the omitted axis
  for (int a = 0; a < 3; ++a) {
    const Point f1 = point(p + axes[a]), b1 = point(p - axes[a]), f2 = point(p + 2.0 * axes[a]), b2 = point(p - 2.0 * axes[a]);
    *first[a] = (8.0 * (f1 - b1) - (f2 - b2)) / (12.0 * h);
    *second[a] = (16.0 * ((f1 - d.point) + (b1 - d.point)) - ((f2 - d.point) + (b2 - d.point))) / (12.0 * h * h);
    const Vec3 &s = axes[(a + 1) % 3], &t = axes[(a + 2) % 3];
    *mixed[a] = (point(p + s + t) - point(p + s - t) - point(p - s + t) + point(p - s - t)) / (4.0 * h * h);
  }
  return d;
}

CurveDerivatives DeformedCurve::derivatives(double t) const {
  const CurveDerivatives c = base_->derivatives(t);
  const SpaceMapDerivatives d = map_->derivatives(c.point);
  return {d.point, d.first(c.first), d.first(c.second) + d.second(c.first, c.first)};
}

SurfaceDerivatives DeformedSurface::derivatives(Uv at) const {
  const SurfaceDerivatives s = base_->derivatives(at);
  const SpaceMapDerivatives d = map_->derivatives(s.point);
  return {d.point,
          d.first(s.du),
          d.first(s.dv),
          d.first(s.duu) + d.second(s.du, s.du),
          d.first(s.duv) + d.second(s.du, s.dv),
          d.first(s.dvv) + d.second(s.dv, s.dv)};
}

void DeformedSurface::points(std::span<const Uv> at, std::span<Point> points) const {
  base_->points(at, points);
  for (Point& p : points) p = map_->point(p);
}

}  // namespace sterna
