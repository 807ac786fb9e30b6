// The borders of a model's face in (u, v): uses of edges brought into one piece over periods, as polygons.
#pragma once

#include <vector>

#include "geom/model/model.h"

namespace sterna::surfmesh {

/// One use of an edge in the order of its border, and what has to be added to its (u, v) so that the border is in one piece on a periodic surface.
struct OutlineUse {
  EdgeUsePlace place;
  Uv shift;
  double gap = 0.0;  ///< in (u, v), along one axis at most: from the end of the use before
};
struct FaceOutline {
  std::vector<std::vector<OutlineUse>> borders;
  std::vector<std::vector<Uv>>
      polygons;                      ///< one for each border, sampled finely enough to tell inside from outside; those that wind are one, at the first of them
  std::vector<std::size_t> winding;  ///< borders that run around a period instead of closing
};

FaceOutline outline_of(const Model& model, FaceId face);

/// (u, v) of a use at the edge's parameter t, shifted.
Uv parameters_at(const Model& model, const OutlineUse& use, double t);

}  // namespace sterna::surfmesh
