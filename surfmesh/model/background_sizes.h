// Target edge length everywhere in a model: the minimum over the targets at given points. Each target grows with the distance from its point.
#pragma once

#include <vector>

#include "geom/base/run_context.h"
#include "geom/mesh/size_points.h"

namespace sterna::surfmesh {

/// size(p) = min over size points of size_i + growth |p - x_i|, with distances through space. This is a lower bound of the sizes that SurfaceSizes carries
/// along the surface. Size points closer to each other than half of their size are thinned to the smallest of them.
class BackgroundSizes {
 public:
  /// `growth`: change of length per distance, > 0. Only size points below `largest` matter.
  BackgroundSizes(const std::vector<SizePoint>& size_points, double growth, double largest, const RunContext& context);
  /// Returns the size in metres: the smallest one within `reach` of p, or `cap` where no size point requires less. Thread-safe.
  double operator()(const Point& p, double cap, double reach = 0.0) const { return size_points_.smallest(p, {.cap = cap, .reach = reach}); }

 private:
  SizePointTree size_points_;
};

}  // namespace sterna::surfmesh
