// Nearest points on surfaces and curves: damped Newton iteration from a seed, or from every sample cell that may contain the nearest point.
#pragma once

#include <span>
#include <vector>

#include "geom/base/run_context.h"
#include "geom/mesh/bvh.h"
#include "geom/model/curve.h"
#include "geom/model/surface.h"

namespace sterna {

struct SurfaceProjection {
  Uv at;
  Point point;            ///< on the surface
  double distance = 0.0;  ///< metres
};

/// Projects points onto one surface, within a box of its parameters; constructed once, usable from many threads.
class SurfaceProjector {
 public:
  /// `box` must lie within the domain; a box of a full period may be crossed at the seam. The constructor samples the surface, which takes about 1 ms.
  /// \throws Error(bad_argument) for a box of zero size
  explicit SurfaceProjector(SurfacePtr surface);
  SurfaceProjector(SurfacePtr surface, const ParameterBox& box);

  /// Finds the local minimum of the distance reached from `seed` (moved into the box). The result is never farther away than the seed's point. Base points on
  /// the border are found; at poles all directions are tried. Points are accurate to about 1e-12 of the surface's extent.
  SurfaceProjection seeded(const Point& p, Uv seed) const;
  /// Finds the nearest point by testing every cell of samples that could contain a nearer point. The bound of a cell is that of its samples plus a margin, so a
  /// feature much thinner than a cell may be missed.
  SurfaceProjection nearest(const Point& p) const;
  /// Computes projections[i] = seeded(points[i], seeds[i]), or nearest(points[i]) if `seeds` is empty. Parallel.
  /// \pre equal sizes
  void project(std::span<const Point> points, std::span<const Uv> seeds, std::span<SurfaceProjection> projections, const RunContext& context) const;

  const SurfacePtr& surface() const { return surface_; }
  const ParameterBox& box() const { return box_; }
  /// Returns the diagonal of the samples' box, metres.
  double extent() const { return extent_; }

 private:
  SurfaceProjection descend(const Point& p, Uv start) const;
  SurfaceProjection leave_pole(const Point& p, const SurfaceProjection& projection) const;
  void move_inside(Uv& at) const;

  SurfacePtr surface_;
  ParameterBox box_;
  bool wraps_u_ = false, wraps_v_ = false;  ///< the box is a full period
  double extent_ = 0.0;
  std::vector<double> stations_u_, stations_v_;
  std::vector<Point> middles_;  ///< middles of the cells, along v first
  BoxTree cells_;
};

struct CurveProjection {
  double t = 0.0;
  Point point;
  double distance = 0.0;
};

/// Projects points onto one curve, within a range of its parameter.
class CurveProjector {
 public:
  explicit CurveProjector(CurvePtr curve);
  /// \throws Error(bad_argument) for a range of zero length
  CurveProjector(CurvePtr curve, Interval range);
  CurveProjection seeded(const Point& p, double seed) const;
  CurveProjection nearest(const Point& p) const;

 private:
  CurvePtr curve_;
  Interval range_;
  bool wraps_ = false;
  double extent_ = 0.0;
  std::vector<double> stations_;
  std::vector<Point> points_;
  std::vector<double> reach_;  ///< per interval: largest distance by which the curve may leave the sphere over the interval's ends
};

}  // namespace sterna
