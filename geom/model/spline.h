// Cubic and linear splines as curves through points and as surfaces through grids of points (docs/method/surface.md, "Parametric surfaces": bicubic and
// linear-cubic splines). NURBS represent them exactly. The parameter runs over [0, 1] unless the parameters of the points are given.
#pragma once

#include <cstddef>
#include <span>
#include <vector>

#include "geom/model/curve.h"
#include "geom/model/surface.h"

namespace sterna {

/// Rule for the tangents at the points.
enum class SplineTangents {
  natural,     ///< twice continuously differentiable, no curvature at the ends
  clamped,     ///< twice continuously differentiable, given tangents at the ends
  not_a_knot,  ///< twice continuously differentiable, third derivative continuous at the second and the last but one point
  periodic,    ///< twice continuously differentiable, also across the seam; the last point repeats the first
  akima,       ///< Akima (1970): keeps straight segments straight; once continuously differentiable
  bessel,      ///< tangent of the parabola through three points; once continuously differentiable
  monotone,    ///< Fritsch and Butland (1984), separately for each coordinate: never overshoots the two points of a segment; once continuously differentiable
  linear,      ///< straight segments
};

enum class SplineParameters {
  uniform,
  chord_length,  ///< proportional to the distance between the points
  centripetal,   ///< proportional to the square root of the distance: less overshoot where distances change suddenly
};

/// Options of a spline in one direction.
struct SplineOptions {
  SplineTangents tangents = SplineTangents::not_a_knot;
  SplineParameters parameters = SplineParameters::chord_length;
  std::vector<double> at;            ///< parameters of the points, ascending; empty: computed by `parameters`
  std::vector<Vec3> start_tangents;  ///< clamped: dC/dt at the first point, one for each row of a surface; empty: natural there
  std::vector<Vec3> end_tangents;    ///< the same at the last point
  std::vector<std::size_t> corners;  ///< inner points where the curve may have a kink: it is splined piece by piece with the same end conditions
  bool is_closed = false;            ///< akima and bessel: smooth across the seam; the last point repeats the first
};

/// Points in rows: point(i, j) = points[i * n_v + j], i along u.
struct PointGrid {
  std::size_t n_u = 0;
  std::size_t n_v = 0;
  std::vector<Point> points;
  const Point& operator()(std::size_t i, std::size_t j) const { return points[i * n_v + j]; }
};

/// Returns the parameters of the points of a curve in [0, 1].
/// \throws Error(bad_argument) with the location where two neighbours coincide
std::vector<double> spline_parameters(std::span<const Point> points, SplineParameters kind);

/// Returns the spline through at least two points.
/// \throws Error(bad_argument) with the location of the fault
NurbsCurveForm<Point> spline_form(std::span<const Point> points, const SplineOptions& options);
CurvePtr spline_curve(std::span<const Point> points, const SplineOptions& options);

/// Returns the spline surface through a grid. It is splined along u first, then along v through the resulting poles, so S(u, v_j) is exactly the spline of
/// column j. All columns share their parameters, which are the means of the parameters of the columns; columns of zero length (poles) are ignored. If u and v
/// are clamped, the twist at the corners is zero.
/// \throws Error(bad_argument) with the location of the fault
NurbsSurfaceForm spline_surface_form(const PointGrid& grid, const SplineOptions& u, const SplineOptions& v);
/// Returns that surface; its kind() is "bicubic spline", "linear-cubic spline" or "bilinear spline".
SurfacePtr spline_surface(const PointGrid& grid, const SplineOptions& u, const SplineOptions& v);

}  // namespace sterna
