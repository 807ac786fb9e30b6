// Approximates functions by splines to a tolerance that is checked between the samples. Used for surfaces and curves of scripts, and for refits for formats
// that support only NURBS.
#pragma once

#include <functional>
#include <vector>

#include "geom/model/nurbs_curve.h"
#include "geom/model/nurbs_surface.h"

namespace sterna {

struct SamplingOptions {
  double tolerance = 1e-5;       ///< metres between function and spline
  std::vector<double> breaks_u;  ///< parameters inside the box where the function has a kink, which the spline reproduces
  std::vector<double> breaks_v;
  bool is_periodic_u = false;  ///< the function is the same at both ends of u, and smooth across
  bool is_periodic_v = false;
  int max_intervals = 400;  ///< along u and along v
};

struct SampledSurface {
  std::shared_ptr<const NurbsSurface> surface;  ///< bicubic, over the given box
  double error = 0.0;            ///< metres: largest error found at 4 points in every cell and 2 on each of its sides; none of them is a sample of the spline
  Uv worst;                      ///< location of the largest error
  std::size_t n_u = 0, n_v = 0;  ///< samples
};
/// Fits a bicubic spline surface through samples of `f`, refined where the error is above the tolerance. `f` is called from this thread only, once for each
/// parameter pair.
/// \throws Error(bad_argument) with the location where the function is not finite, is not periodic although declared so, or where max_intervals do not reach
/// the tolerance
SampledSurface sample_surface(const std::function<Point(Uv)>& f, const ParameterBox& box, const SamplingOptions& options);
/// Approximates a surface without an exact NURBS form (of revolution, deformed ...) by a bicubic spline; its breaks and periods are kept.
SampledSurface sample_surface(const Surface& surface, double tolerance);

struct SampledCurve {
  std::shared_ptr<const NurbsCurve> curve;  ///< cubic, over the given range
  double error = 0.0;                       ///< metres: largest found error, at 4 points in every interval
  double worst = 0.0;                       ///< parameter of the largest error
  std::size_t n = 0;                        ///< samples
};
/// Fits a spline to a curve; uses breaks_u and is_periodic_u.
SampledCurve sample_curve(const std::function<Point(double)>& f, Interval range, const SamplingOptions& options);
SampledCurve sample_curve(const Curve& curve, double tolerance);

}  // namespace sterna
