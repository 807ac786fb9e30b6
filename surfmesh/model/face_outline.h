// Borders of a model's face in (u, v), as polygons. Edge uses are shifted by periods so that each border is continuous.
#pragma once

#include <vector>

#include "geom/model/model.h"

namespace sterna::surfmesh {

/// One use of an edge in the order of its border, with the (u, v) shift that makes the border continuous on a periodic surface.
struct OutlineUse {
  EdgeUseLocation location;
  Uv shift;
  double gap = 0.0;  ///< in (u, v), the larger component of the distance from the end of the previous use
};
struct FaceOutline {
  std::vector<std::vector<OutlineUse>> borders;
  std::vector<std::vector<Uv>> polygons;  ///< one per border, sampled finely enough to separate inside from outside. Borders that wind around a period are
                                          ///< merged into one polygon, stored at the first of them
  std::vector<std::size_t> winding;       ///< numbers of the borders that run around a period instead of closing
};

FaceOutline outline_of(const Model& model, FaceId face);

/// Returns the shifted (u, v) of a use at the edge's parameter t.
Uv parameters_at(const Model& model, const OutlineUse& use, double t);

}  // namespace sterna::surfmesh
