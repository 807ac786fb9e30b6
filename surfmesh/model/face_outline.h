// Borders of a model's face in (u, v) as polygons: edge uses shifted by periods so that each border is continuous.
#pragma once

#include <vector>

#include "geom/model/model.h"

namespace sterna::surfmesh {

/// One use of an edge in the order of its border, with the (u, v) shift that makes the border continuous on a periodic surface.
struct OutlineUse {
  EdgeUsePlace place;
  Uv shift;
  double gap = 0.0;  ///< in (u, v), largest along one axis: from the end of the previous use
};
struct FaceOutline {
  std::vector<std::vector<OutlineUse>> borders;
  std::vector<std::vector<Uv>> polygons;  ///< one per border, sampled finely enough to separate inside from outside; winding borders are merged into one
                                          ///< polygon, at the first of them
  std::vector<std::size_t> winding;       ///< borders that run around a period instead of closing
};

FaceOutline outline_of(const Model& model, FaceId face);

/// Returns (u, v) of a use at the edge's parameter t, shifted.
Uv parameters_at(const Model& model, const OutlineUse& use, double t);

}  // namespace sterna::surfmesh
