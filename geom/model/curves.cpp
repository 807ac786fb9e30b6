#include "geom/model/curves.h"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <string>

#include "geom/base/error.h"
#include "geom/model/nurbs_tools.h"

namespace sterna {
namespace {

constexpr double k_turn = 2.0 * std::numbers::pi;
/// Relative tolerance of a full turn. It covers the rounding of angles in files.
constexpr double k_same_turn = 1e-12;
/// Cosine of the angle between the axes of an ellipse below which they count as orthogonal.
constexpr double k_right_angle = 1e-9;
/// A view may exceed its domain by this fraction of it, because its own limits are rounded.
constexpr double k_overreach = 1e-9;

void check_domain(Interval domain, const char* attempted) {
  if (!std::isfinite(domain.from) || !std::isfinite(domain.to) || !(domain.from < domain.to))
    throw_bad_argument(attempted, "the parameter range [" + std::to_string(domain.from) + ", " + std::to_string(domain.to) + "] has no length");
}

}  // namespace

LineCurve::LineCurve(const Point& origin, const Vec3& direction, Interval domain) : origin_(origin), direction_(direction), domain_(domain) {
  check_domain(domain, "making a line");
  if (!is_finite(origin) || !is_finite(direction) || !(norm(direction) > 0.0))
    throw_bad_argument("making a line", "the direction " + format_point(direction) + " has no length or is not finite");
}

std::optional<NurbsCurveForm<Point>> LineCurve::exact_nurbs() const {
  return NurbsCurveForm<Point>{1, {domain_.from, domain_.from, domain_.to, domain_.to}, {point(domain_.from), point(domain_.to)}, {}};
}

CurvePtr segment(const Point& a, const Point& b) {
  const double length = distance(a, b);
  if (!(length > 0.0)) throw_bad_argument("making a segment", "the ends coincide at " + format_point(a));
  return std::make_shared<LineCurve>(a, (b - a) / length, Interval{0.0, length});
}

EllipseCurve::EllipseCurve(const Point& centre, const Vec3& x, const Vec3& y, Interval domain)
    : centre_(centre), x_(x), y_(y), domain_(domain), is_periodic_(std::abs(domain.length() - k_turn) <= k_same_turn * k_turn) {
  check_domain(domain, "making a circle or an ellipse");
  if (!(norm(x) > 0.0) || !(norm(y) > 0.0) || !is_finite(centre) || !(std::abs(dot(x, y)) <= k_right_angle * norm(x) * norm(y)))
    throw_bad_argument("making a circle or an ellipse",
                       "the half axes " + format_point(x) + " and " + format_point(y) + " have no length or are not at right angles");
  if (domain.length() > k_turn && !is_periodic_)
    throw_bad_argument("making a circle or an ellipse", "the parameter range is longer than one turn: " + std::to_string(domain.length()) + " rad");
}

Point EllipseCurve::point(double t) const { return centre_ + std::cos(t) * x_ + std::sin(t) * y_; }

CurveDerivatives EllipseCurve::derivatives(double t) const {
  const double c = std::cos(t), s = std::sin(t);
  const Vec3 outward = c * x_ + s * y_;
  return {centre_ + outward, c * y_ - s * x_, -outward};
}

CurvePtr circle(const Frame& frame, double radius, Interval angles) {
  if (!(radius > 0.0)) throw_bad_argument("making a circle", "the radius is " + std::to_string(radius) + " m, must be positive");
  return std::make_shared<EllipseCurve>(frame.origin, radius * frame.x, radius * frame.y, angles);
}

CurveView::CurveView(CurvePtr base, Interval domain, double scale, double shift) : base_(std::move(base)), domain_(domain), scale_(scale), shift_(shift) {
  check_domain(domain, "taking a part of a curve");
  if (!(std::abs(scale) > 0.0)) throw_bad_argument("taking a part of a curve", "the parameter is scaled by 0");
  const Interval all = base_->domain();
  const double a = scale * domain.from + shift, b = scale * domain.to + shift;
  const double slack = k_overreach * all.length();
  if (!base_->is_periodic() && (std::min(a, b) < all.from - slack || std::max(a, b) > all.to + slack))
    throw_bad_argument("taking a part of a curve", "[" + std::to_string(a) + ", " + std::to_string(b) + "] is not within the parameter range [" +
                                                       std::to_string(all.from) + ", " + std::to_string(all.to) + "]");
}

bool CurveView::is_periodic() const {
  const double period = base_->domain().length();
  return base_->is_periodic() && std::abs(std::abs(scale_) * domain_.length() - period) <= k_same_turn * period;
}

CurveDerivatives CurveView::derivatives(double t) const {
  CurveDerivatives d = base_->derivatives(scale_ * t + shift_);
  d.first *= scale_;
  d.second *= scale_ * scale_;
  return d;
}

std::vector<double> CurveView::breaks() const {
  std::vector<double> result;
  const double period = base_->domain().length();
  for (const double b : base_->breaks()) {
    for (const double turn : {-1.0, 0.0, 1.0}) {
      if (turn != 0.0 && !base_->is_periodic()) continue;
      const double t = (b + turn * period - shift_) / scale_;
      if (t > domain_.from && t < domain_.to) result.push_back(t);
    }
  }
  std::sort(result.begin(), result.end());
  return result;
}

std::optional<NurbsCurveForm<Point>> CurveView::exact_nurbs() const {
  std::optional<NurbsCurveForm<Point>> form = base_->exact_nurbs();
  if (!form) return std::nullopt;
  const double a = scale_ * domain_.from + shift_, b = scale_ * domain_.to + shift_;
  const Interval all{form->knots.front(), form->knots.back()};
  if (std::min(a, b) < all.from - k_overreach * all.length() || std::max(a, b) > all.to + k_overreach * all.length()) return std::nullopt;  // across a seam
  NurbsCurveForm<Point> part = restricted(*form, {std::max(std::min(a, b), all.from), std::min(std::max(a, b), all.to)});
  if (scale_ < 0.0) part = reversed(part);
  part.knots = stretched_knots(part.knots, domain_);
  return part;
}

CurvePtr part_of(const CurvePtr& curve, Interval range) {
  if (range == curve->domain()) return curve;
  return std::make_shared<CurveView>(curve, range, 1.0, 0.0);
}

CurvePtr reparametrised(const CurvePtr& curve, Interval domain) {
  const Interval old = curve->domain();
  if (old == domain) return curve;
  check_domain(domain, "reparametrising a curve");
  const double scale = old.length() / domain.length();
  return std::make_shared<CurveView>(curve, domain, scale, old.from - scale * domain.from);
}

CurvePtr reversed(const CurvePtr& curve) {
  const Interval domain = curve->domain();
  return std::make_shared<CurveView>(curve, domain, -1.0, domain.from + domain.to);
}

ParameterLine::ParameterLine(Uv origin, Uv direction, Interval domain) : origin_(origin), direction_(direction), domain_(domain) {
  check_domain(domain, "making a line in a parameter plane");
  if (!(std::hypot(direction.u, direction.v) > 0.0)) throw_bad_argument("making a line in a parameter plane", "the direction has no length");
}

std::optional<NurbsCurveForm<Uv>> ParameterLine::exact_nurbs() const {
  return NurbsCurveForm<Uv>{1, {domain_.from, domain_.from, domain_.to, domain_.to}, {point(domain_.from), point(domain_.to)}, {}};
}

ParameterCurvePtr parameter_segment(Uv a, Uv b, Interval domain) {
  check_domain(domain, "making a line in a parameter plane");
  const Uv direction = 1.0 / domain.length() * (b - a);
  return std::make_shared<ParameterLine>(a - domain.from * direction, direction, domain);
}

ParameterArc::ParameterArc(Uv centre, Uv x, Uv y, Interval domain) : centre_(centre), x_(x), y_(y), domain_(domain) {
  check_domain(domain, "making an arc in a parameter plane");
  if (!(std::abs(x.u * y.v - x.v * y.u) > 0.0)) throw_bad_argument("making an arc in a parameter plane", "the half axes are parallel or have no length");
}

Uv ParameterArc::point(double t) const { return centre_ + std::cos(t) * x_ + std::sin(t) * y_; }

ParameterCurveDerivatives ParameterArc::derivatives(double t) const { return {point(t), std::cos(t) * y_ - std::sin(t) * x_}; }

}  // namespace sterna
