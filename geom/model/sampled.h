// Functions made splines to a tolerance that is checked between the samples: surfaces and curves of scripts, and refits for formats that know
// only NURBS.
#pragma once

#include <functional>
#include <vector>

#include "geom/model/nurbs_curve.h"
#include "geom/model/nurbs_surface.h"

namespace sterna {

struct SamplingOptions {
  double tolerance = 1e-5;       ///< metres between function and spline
  std::vector<double> breaks_u;  ///< parameters inside the box where the function has a kink: the spline has one there
  std::vector<double> breaks_v;
  bool is_periodic_u = false;  ///< the function is the same at both ends of u, and smooth across
  bool is_periodic_v = false;
  int max_intervals = 400;  ///< along u and along v
};

struct SampledSurface {
  std::shared_ptr<const NurbsSurface> surface;  ///< bicubic, over the given box
  double error = 0.0;            ///< metres: largest found: 4 places in every cell and 2 on every side of it, none of them a sample of the spline
  Uv worst;                      ///< where
  std::size_t n_u = 0, n_v = 0;  ///< samples
};
/// Bicubic spline surface through samples of `f`, refined where the error is above the tolerance. `f` is called from this thread only, once for each place.
/// \throws Error(bad_argument) with the place: not finite, not periodic as said, tolerance not reached with max_intervals
SampledSurface sample_surface(const std::function<Point(Uv)>& f, const ParameterBox& box, const SamplingOptions& options);
/// A surface without an exact NURBS form (of revolution, deformed ...) as a bicubic spline; its breaks and periods are kept.
SampledSurface sample_surface(const Surface& surface, double tolerance);

struct SampledCurve {
  std::shared_ptr<const NurbsCurve> curve;  ///< cubic, over the given range
  double error = 0.0;                       ///< metres: largest found, at 4 places in every interval
  double worst = 0.0;                       ///< where
  std::size_t n = 0;                        ///< samples
};
/// The same for curves; breaks_u, is_periodic_u count.
SampledCurve sample_curve(const std::function<Point(double)>& f, Interval range, const SamplingOptions& options);
SampledCurve sample_curve(const Curve& curve, double tolerance);

}  // namespace sterna
