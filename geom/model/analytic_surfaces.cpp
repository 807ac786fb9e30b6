#include "geom/model/analytic_surfaces.h"

#include <cmath>
#include <string>

#include "geom/base/error.h"

namespace sterna {
namespace {

/// Relative tolerance of a full turn. It covers the rounding of angles in files.
constexpr double k_whole_turn = 1e-12;

bool is_turn(Interval range) { return std::abs(range.length() - k_full_turn.to) <= k_whole_turn * k_full_turn.to; }

void check_box(const ParameterBox& box, const char* attempted) {
  for (const Interval& range : {box.u, box.v})
    if (!std::isfinite(range.from) || !std::isfinite(range.to) || !(range.from < range.to))
      throw_bad_argument(attempted, "the parameter range [" + std::to_string(range.from) + ", " + std::to_string(range.to) + "] has no length");
}

double checked_radius(double radius, const char* attempted) {
  if (!(radius > 0.0) || !std::isfinite(radius)) throw_bad_argument(attempted, "the radius is " + std::to_string(radius) + " m, must be positive");
  return radius;
}

}  // namespace

PlaneSurface::PlaneSurface(const Frame& frame, const ParameterBox& box) : frame_(frame), box_(box) { check_box(box, "making a plane"); }

std::optional<NurbsSurfaceForm> PlaneSurface::exact_nurbs() const {
  NurbsSurfaceForm form;
  form.knots_u = {box_.u.from, box_.u.from, box_.u.to, box_.u.to};
  form.knots_v = {box_.v.from, box_.v.from, box_.v.to, box_.v.to};
  form.n_u = form.n_v = 2;
  for (const double u : {box_.u.from, box_.u.to})
    for (const double v : {box_.v.from, box_.v.to}) form.poles.push_back(point({u, v}));
  return form;
}

RoundSurface::RoundSurface(const Frame& frame, const ParameterBox& box, const char* attempted) : frame_(frame), box_(box) {
  check_box(box, attempted);
  if (box.u.length() > k_full_turn.to && !is_turn(box.u))
    throw_bad_argument(attempted, "the surface covers more than one turn: " + std::to_string(box.u.length()) + " rad");
}

bool RoundSurface::is_periodic_u() const { return is_turn(box_.u); }

Point RoundSurface::point(Uv at) const {
  const Profile p = profile(at.v);
  return frame_.origin + p.a * (std::cos(at.u) * frame_.x + std::sin(at.u) * frame_.y) + p.b * frame_.z;
}

SurfaceDerivatives RoundSurface::derivatives(Uv at) const {
  const Profile p = profile(at.v);
  const double c = std::cos(at.u), s = std::sin(at.u);
  const Vec3 outward = c * frame_.x + s * frame_.y;
  const Vec3 around = c * frame_.y - s * frame_.x;
  SurfaceDerivatives d;
  d.point = frame_.origin + p.a * outward + p.b * frame_.z;
  d.du = p.a * around;
  d.dv = p.a1 * outward + p.b1 * frame_.z;
  d.duu = -p.a * outward;
  d.duv = p.a1 * around;
  d.dvv = p.a2 * outward + p.b2 * frame_.z;
  return d;
}

CylinderSurface::CylinderSurface(const Frame& frame, double radius, const ParameterBox& box)
    : RoundSurface(frame, box, "making a cylinder"), radius_(checked_radius(radius, "making a cylinder")) {}

ConeSurface::ConeSurface(const Frame& frame, double radius, double half_angle, const ParameterBox& box)
    : RoundSurface(frame, box, "making a cone"), radius_(radius), half_angle_(half_angle) {
  if (!(radius >= 0.0) || !std::isfinite(radius)) throw_bad_argument("making a cone", "the radius is " + std::to_string(radius) + " m, must not be negative");
  if (!(std::abs(half_angle) > 0.0 && std::abs(half_angle) < 0.5 * std::numbers::pi))
    throw_bad_argument("making a cone", "the half angle is " + std::to_string(half_angle) + " rad, must be between 0 and pi/2");
}

RoundSurface::Profile ConeSurface::profile(double v) const {
  const double s = std::sin(half_angle_), c = std::cos(half_angle_);
  return {radius_ + v * s, s, 0.0, v * c, c, 0.0};
}

SphereSurface::SphereSurface(const Frame& frame, double radius, const ParameterBox& box)
    : RoundSurface(frame, box, "making a sphere"), radius_(checked_radius(radius, "making a sphere")) {}

RoundSurface::Profile SphereSurface::profile(double v) const {
  const double c = radius_ * std::cos(v), s = radius_ * std::sin(v);
  return {c, -s, -c, s, c, -s};
}

TorusSurface::TorusSurface(const Frame& frame, double major, double minor, const ParameterBox& box)
    : RoundSurface(frame, box, "making a torus"), major_(checked_radius(major, "making a torus")), minor_(checked_radius(minor, "making a torus")) {}

bool TorusSurface::is_periodic_v() const { return is_turn(domain().v); }

RoundSurface::Profile TorusSurface::profile(double v) const {
  const double c = minor_ * std::cos(v), s = minor_ * std::sin(v);
  return {major_ + c, -s, -c, s, c, -s};
}

}  // namespace sterna
