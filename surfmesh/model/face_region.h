// Tests if a surface point belongs to a face, that is, lies inside its borders, with the precision of the curves of the borders.
#pragma once

#include <vector>

#include "geom/base/borrowed.h"
#include "surfmesh/model/face_outline.h"

namespace sterna::surfmesh {

class FaceRegion {
 public:
  FaceRegion(Borrowed<const Model> model, FaceId face);

  /// Returns true if the point belongs to the face. On a periodic surface any period is accepted. Near the border the test uses the parameter curves, not their
  /// polygons.
  bool contains(Uv at) const;

 private:
  /// Part of a border between two points of its polygon.
  struct Piece {
    Uv from, to;
    double t_from, t_to;  ///< parameters of the edge; t_from > t_to if the border runs against the edge
    double sag;           ///< in (u, v), largest distance of the curve from its chord
    std::uint32_t border, use;
  };
  bool contains_here(Uv at) const;
  bool is_left_of(const Piece& piece, Uv at) const;

  const Model* model_;
  FaceOutline outline_;
  std::vector<Piece> pieces_;
  Uv period_;  ///< periods in u and v; zero: not periodic
};

}  // namespace sterna::surfmesh
