// The wanted length of edges all over a model: the least of what sites ask for, growing with the distance from them.
#pragma once

#include <vector>

#include "geom/base/run_context.h"
#include "geom/mesh/size_sites.h"

namespace sterna::surfmesh {

/// size(p) = min over sites of size_i + growth |p - x_i|, through space: a lower bound of what SurfaceSizes carries along the surface.
/// Sites nearer to each other than half of their size are thinned to the least of them.
class BackgroundSizes {
 public:
  /// `growth`: change of length by distance, > 0. Only sites below `largest` matter.
  BackgroundSizes(const std::vector<SizeSite>& sites, double growth, double largest, const RunContext& context);
  /// Metres; `cap` where no site asks for less; the least within `reach` of p. From many threads.
  double operator()(const Point& p, double cap, double reach = 0.0) const { return sites_.smallest(p, {.cap = cap, .reach = reach}); }

 private:
  SizeSites sites_;
};

}  // namespace sterna::surfmesh
