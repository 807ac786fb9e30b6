// Exact operations on NURBS data: the same curve or surface with other knots, another parameter, or another degree.
#pragma once

#include <span>
#include <string_view>
#include <vector>

#include "geom/model/knot_basis.h"
#include "geom/model/nurbs_form.h"

namespace sterna {

/// Returns w * (x, y, z, 1) of every pole.
/// \throws Error(bad_argument) unless there are `n` poles and no weights or `n` positive weights, all finite
std::vector<Lanes4> weighted_poles(const std::vector<Point>& poles, const std::vector<double>& weights, std::size_t n, std::string_view attempted);

/// Returns the same curve on other knots of the same or a higher degree.
/// \pre the new knots are clamped, lie inside the domain (restriction is allowed) and have every old knot at least as often as the new degree exceeds the old
/// one plus its old multiplicity (insertion, elevation).
NurbsCurveForm<Point> on_knots(const NurbsCurveForm<Point>& form, int degree, const std::vector<double>& knots);
NurbsSurfaceForm on_knots_u(const NurbsSurfaceForm& form, int degree, const std::vector<double>& knots);
NurbsSurfaceForm on_knots_v(const NurbsSurfaceForm& form, int degree, const std::vector<double>& knots);

/// Returns the knots of the part `range` of a spline, clamped at both ends.
/// \pre range lies in the domain and has a positive length
std::vector<double> restricted_knots(int degree, const std::vector<double>& knots, Interval range);
/// Returns the knots of the same curve at a higher degree: the multiplicity of every distinct knot increases by `by`.
std::vector<double> elevated_knots(const std::vector<double>& knots, int by);
/// Returns the ascending union of two clamped knot vectors of one degree and domain, each knot with the larger of its two multiplicities. Knots of `b` that
/// differ from one of `a` only by rounding (1e-14 of the domain) are identified with it.
std::vector<double> united_knots(const std::vector<double>& a, const std::vector<double>& b);
/// Returns the knots mapped linearly so that they begin and end at the ends of `domain`.
std::vector<double> stretched_knots(const std::vector<double>& knots, Interval domain);

/// Returns a part of a curve.
/// \pre range lies in the domain
NurbsCurveForm<Point> restricted(const NurbsCurveForm<Point>& form, Interval range);
/// Returns a part of a surface.
NurbsSurfaceForm restricted(const NurbsSurfaceForm& form, Interval range_u, Interval range_v);
/// Returns C(-t): the domain becomes [-to, -from].
NurbsCurveForm<Point> reversed(const NurbsCurveForm<Point>& form);
NurbsSurfaceForm reversed_u(const NurbsSurfaceForm& form);
NurbsSurfaceForm reversed_v(const NurbsSurfaceForm& form);
/// Returns S(v, u).
NurbsSurfaceForm exchanged(const NurbsSurfaceForm& form);

}  // namespace sterna
