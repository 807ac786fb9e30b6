#include "geom/model/swept_surfaces.h"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <string>

#include "geom/base/error.h"
#include "geom/model/curves.h"
#include "geom/model/nurbs_tools.h"

namespace sterna {
namespace {

constexpr double k_sweep_turn = 2.0 * std::numbers::pi;
/// Relative tolerance of a full period. It covers the rounding of angles in files.
constexpr double k_whole_period = 1e-12;

void check_range(Interval range, const char* attempted) {
  if (!std::isfinite(range.from) || !std::isfinite(range.to) || !(range.from < range.to))
    throw_bad_argument(attempted, "the parameter range [" + std::to_string(range.from) + ", " + std::to_string(range.to) + "] has no length");
}

/// A vector whose length differs from 1 by less counts as a unit vector and is unchanged: dividing it again would change its last digits.
constexpr double k_unit_length = 1e-15;

Vec3 unit(const Vec3& v) { return std::abs(dot(v, v) - 1.0) <= k_unit_length ? v : normalized(v); }

/// Returns a surface with a curve's poles as the row v = const, with two rows.
NurbsSurfaceForm rows_of(const NurbsCurveForm<Point>& a, const NurbsCurveForm<Point>& b, Interval range) {
  NurbsSurfaceForm form;
  form.degree_u = a.degree;
  form.knots_u = a.knots;
  form.knots_v = {range.from, range.from, range.to, range.to};
  form.n_u = a.poles.size();
  form.n_v = 2;
  for (std::size_t i = 0; i < form.n_u; ++i) {
    form.poles.push_back(a.poles[i]);
    form.poles.push_back(b.poles[i]);
    if (!a.weights.empty()) form.weights.insert(form.weights.end(), {a.weights[i], b.weights[i]});
  }
  return form;
}

}  // namespace

// ---------------------------------------------------------------- revolution

RevolutionSurface::RevolutionSurface(CurvePtr profile, const Point& axis_point, const Vec3& axis, Interval angles)
    : profile_(std::move(profile)), axis_point_(axis_point), axis_(unit(axis)), angles_(angles) {
  check_range(angles, "making a surface of revolution");
  if (!(norm(axis_) > 0.0)) throw_bad_argument("making a surface of revolution", "the axis has no direction");
  if (angles.length() > k_sweep_turn * (1.0 + k_whole_period))
    throw_bad_argument("making a surface of revolution", "the surface covers more than one turn: " + std::to_string(angles.length()) + " rad");
}

bool RevolutionSurface::is_periodic_u() const { return std::abs(angles_.length() - k_sweep_turn) <= k_whole_period * k_sweep_turn; }

Point RevolutionSurface::point(Uv at) const { return axis_point_ + turned(profile_->point(at.v) - axis_point_, std::cos(at.u), std::sin(at.u)); }

SurfaceDerivatives RevolutionSurface::derivatives(Uv at) const {
  const CurveDerivatives c = profile_->derivatives(at.v);
  const double cosine = std::cos(at.u), sine = std::sin(at.u);
  const Vec3 arm = turned(c.point - axis_point_, cosine, sine);
  SurfaceDerivatives d;
  d.point = axis_point_ + arm;
  d.du = cross(axis_, arm);
  d.dv = turned(c.first, cosine, sine);
  d.duu = cross(axis_, d.du);
  d.duv = cross(axis_, d.dv);
  d.dvv = turned(c.second, cosine, sine);
  return d;
}

// ---------------------------------------------------------------- extrusion

ExtrusionSurface::ExtrusionSurface(CurvePtr curve, const Vec3& direction, Interval range) : curve_(std::move(curve)), direction_(direction), range_(range) {
  check_range(range, "making an extrusion");
  if (!(norm(direction) > 0.0)) throw_bad_argument("making an extrusion", "the direction has no length");
}

SurfaceDerivatives ExtrusionSurface::derivatives(Uv at) const {
  const CurveDerivatives c = curve_->derivatives(at.u);
  return {c.point + at.v * direction_, c.first, direction_, c.second, {}, {}};
}

std::optional<NurbsSurfaceForm> ExtrusionSurface::exact_nurbs() const {
  const std::optional<NurbsCurveForm<Point>> form = curve_->exact_nurbs();
  if (!form) return std::nullopt;
  NurbsCurveForm<Point> from = *form, to = *form;
  for (Point& p : from.poles) p += range_.from * direction_;
  for (Point& p : to.poles) p += range_.to * direction_;
  return rows_of(from, to, range_);
}

// ---------------------------------------------------------------- ruled

RuledSurface::RuledSurface(CurvePtr a, CurvePtr b) : a_(reparametrised(a, {0.0, 1.0})), b_(reparametrised(b, {0.0, 1.0})) {}

SurfaceDerivatives RuledSurface::derivatives(Uv at) const {
  const CurveDerivatives a = a_->derivatives(at.u), b = b_->derivatives(at.u);
  const auto mean = [&](const Vec3& x, const Vec3& y) { return (1.0 - at.v) * x + at.v * y; };
  return {mean(a.point, b.point), mean(a.first, b.first), b.point - a.point, mean(a.second, b.second), b.first - a.first, {}};
}

std::vector<double> RuledSurface::breaks_u() const {
  const std::vector<double> a = a_->breaks(), b = b_->breaks();
  std::vector<double> result;
  std::set_union(a.begin(), a.end(), b.begin(), b.end(), std::back_inserter(result));
  return result;
}

std::optional<NurbsSurfaceForm> RuledSurface::exact_nurbs() const {
  std::optional<NurbsCurveForm<Point>> a = a_->exact_nurbs(), b = b_->exact_nurbs();
  if (!a || !b) return std::nullopt;
  const bool is_rational = !a->weights.empty() || !b->weights.empty();
  // The form (1 - v) A / w_a + v B / w_b has one denominator of the same degree only if the weights are equal.
  if (is_rational && (a->weights != b->weights || a->knots != b->knots)) return std::nullopt;
  const int degree = std::max(a->degree, b->degree);
  // Elevate each curve's knots to the common degree, then unite both.
  const std::vector<double> knots = united_knots(elevated_knots(a->knots, degree - a->degree), elevated_knots(b->knots, degree - b->degree));
  if (!is_rational) {
    a = on_knots(*a, degree, knots);
    b = on_knots(*b, degree, knots);
  }
  return rows_of(*a, *b, {0.0, 1.0});
}

// ---------------------------------------------------------------- views

namespace {

constexpr const char* k_view = "taking a part of a surface";
/// A view may exceed its domain by this fraction of it: rounding of its own limits.
constexpr double k_swept_overreach = 1e-9;

Interval image(const SurfaceView::Map& map, Interval range) {
  const double a = map(range.from), b = map(range.to);
  return {std::min(a, b), std::max(a, b)};
}

bool reaches_beyond(Interval part, Interval all) {
  return part.from < all.from - k_swept_overreach * all.length() || part.to > all.to + k_swept_overreach * all.length();
}

Interval within(Interval part, Interval all) { return {std::max(part.from, all.from), std::min(part.to, all.to)}; }

std::vector<double> mapped_breaks(const std::vector<double>& breaks, const SurfaceView::Map& map, Interval own, bool is_periodic, double period) {
  std::vector<double> result;
  for (const double b : breaks) {
    for (const double turn : {-1.0, 0.0, 1.0}) {
      if (turn != 0.0 && !is_periodic) continue;
      const double t = (b + turn * period - map.shift) / map.scale;
      if (t > own.from && t < own.to) result.push_back(t);
    }
  }
  std::sort(result.begin(), result.end());
  return result;
}

bool is_whole(const SurfaceView::Map& map, Interval own, Interval all) {
  return std::abs(std::abs(map.scale) * own.length() - all.length()) <= k_whole_period * all.length();
}

}  // namespace

SurfaceView::SurfaceView(SurfacePtr base, const ParameterBox& domain, Map u, Map v, bool is_exchanged)
    : base_(std::move(base)), domain_(domain), u_(u), v_(v), is_exchanged_(is_exchanged) {
  check_range(domain.u, k_view);
  check_range(domain.v, k_view);
  if (!(std::abs(u.scale) > 0.0) || !(std::abs(v.scale) > 0.0)) throw_bad_argument(k_view, "a parameter is scaled by 0");
  const ParameterBox all = base_->domain();
  const Interval part_u = image(u, is_exchanged ? domain.v : domain.u), part_v = image(v, is_exchanged ? domain.u : domain.v);
  const auto complain = [](const char* name, Interval part, Interval whole) {
    throw_bad_argument(k_view, std::string(name) + " in [" + std::to_string(part.from) + ", " + std::to_string(part.to) +
                                   "] is not within the parameter range [" + std::to_string(whole.from) + ", " + std::to_string(whole.to) + "]");
  };
  if (!base_->is_periodic_u() && reaches_beyond(part_u, all.u)) complain("u", part_u, all.u);
  if (!base_->is_periodic_v() && reaches_beyond(part_v, all.v)) complain("v", part_v, all.v);
}

bool SurfaceView::is_periodic_u() const {
  return is_exchanged_ ? base_->is_periodic_v() && is_whole(v_, domain_.u, base_->domain().v)
                       : base_->is_periodic_u() && is_whole(u_, domain_.u, base_->domain().u);
}

bool SurfaceView::is_periodic_v() const {
  return is_exchanged_ ? base_->is_periodic_u() && is_whole(u_, domain_.v, base_->domain().u)
                       : base_->is_periodic_v() && is_whole(v_, domain_.v, base_->domain().v);
}

SurfaceDerivatives SurfaceView::derivatives(Uv at) const {
  SurfaceDerivatives d = base_->derivatives(base_uv(at));
  d.du *= u_.scale;
  d.dv *= v_.scale;
  d.duu *= u_.scale * u_.scale;
  d.duv *= u_.scale * v_.scale;
  d.dvv *= v_.scale * v_.scale;
  if (is_exchanged_) {
    std::swap(d.du, d.dv);
    std::swap(d.duu, d.dvv);
  }
  return d;
}

void SurfaceView::points(std::span<const Uv> at, std::span<Point> points) const {
  std::vector<Uv> mapped;
  mapped.reserve(at.size());
  for (const Uv p : at) mapped.push_back(base_uv(p));
  base_->points(mapped, points);
}

std::vector<double> SurfaceView::breaks_u() const {
  const ParameterBox all = base_->domain();
  return is_exchanged_ ? mapped_breaks(base_->breaks_v(), v_, domain_.u, base_->is_periodic_v(), all.v.length())
                       : mapped_breaks(base_->breaks_u(), u_, domain_.u, base_->is_periodic_u(), all.u.length());
}

std::vector<double> SurfaceView::breaks_v() const {
  const ParameterBox all = base_->domain();
  return is_exchanged_ ? mapped_breaks(base_->breaks_u(), u_, domain_.v, base_->is_periodic_u(), all.u.length())
                       : mapped_breaks(base_->breaks_v(), v_, domain_.v, base_->is_periodic_v(), all.v.length());
}

std::optional<NurbsSurfaceForm> SurfaceView::exact_nurbs() const {
  const std::optional<NurbsSurfaceForm> base = base_->exact_nurbs();
  if (!base) return std::nullopt;
  const ParameterBox all = base_->domain();
  const Interval part_u = image(u_, is_exchanged_ ? domain_.v : domain_.u), part_v = image(v_, is_exchanged_ ? domain_.u : domain_.v);
  if (reaches_beyond(part_u, all.u) || reaches_beyond(part_v, all.v)) return std::nullopt;  // across a seam
  NurbsSurfaceForm form = restricted(*base, within(part_u, all.u), within(part_v, all.v));
  if (u_.scale < 0.0) form = reversed_u(form);
  if (v_.scale < 0.0) form = reversed_v(form);
  if (is_exchanged_) form = exchanged(form);
  form.knots_u = stretched_knots(form.knots_u, domain_.u);
  form.knots_v = stretched_knots(form.knots_v, domain_.v);
  return form;
}

SurfacePtr part_of(const SurfacePtr& surface, const ParameterBox& box) {
  if (box == surface->domain()) return surface;
  return std::make_shared<SurfaceView>(surface, box, SurfaceView::Map{}, SurfaceView::Map{});
}

SurfacePtr reparametrised(const SurfacePtr& surface, const ParameterBox& box) {
  const ParameterBox old = surface->domain();
  if (old == box) return surface;
  check_range(box.u, k_view);
  check_range(box.v, k_view);
  const auto map = [](Interval from, Interval to) {
    const double scale = from.length() / to.length();
    return SurfaceView::Map{scale, from.from - scale * to.from};
  };
  return std::make_shared<SurfaceView>(surface, box, map(old.u, box.u), map(old.v, box.v));
}

SurfacePtr reversed_u(const SurfacePtr& surface) {
  const ParameterBox box = surface->domain();
  return std::make_shared<SurfaceView>(surface, box, SurfaceView::Map{-1.0, box.u.from + box.u.to}, SurfaceView::Map{});
}

SurfacePtr reversed_v(const SurfacePtr& surface) {
  const ParameterBox box = surface->domain();
  return std::make_shared<SurfaceView>(surface, box, SurfaceView::Map{}, SurfaceView::Map{-1.0, box.v.from + box.v.to});
}

SurfacePtr exchanged(const SurfacePtr& surface) {
  const ParameterBox box = surface->domain();
  return std::make_shared<SurfaceView>(surface, ParameterBox{box.v, box.u}, SurfaceView::Map{}, SurfaceView::Map{}, true);
}

}  // namespace sterna
