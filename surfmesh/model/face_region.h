// Test if a surface point belongs to a face: inside or outside of its borders, to the precision of the borders' own curves.
#pragma once

#include <vector>

#include "surfmesh/model/face_outline.h"

namespace sterna::surfmesh {

class FaceRegion {
 public:
  /// `model` must outlive the region.
  FaceRegion(const Model& model, FaceId face);

  /// Returns true if the point belongs to the face. On a periodic surface any period is accepted. Near the border the parameter curves decide, not their
  /// polygons.
  bool contains(Uv at) const;

 private:
  /// Part of a border between two points of its polygon.
  struct Piece {
    Uv from, to;
    double t_from, t_to;  ///< edge parameters; t_from > t_to where the border runs against the edge
    double sag;           ///< sag of the curve over the chord, in (u, v)
    std::uint32_t border, use;
  };
  bool contains_here(Uv at) const;
  bool is_left_of(const Piece& piece, Uv at) const;

  const Model* model_;
  FaceOutline outline_;
  std::vector<Piece> pieces_;
  Uv period_;  ///< zero: not periodic
};

}  // namespace sterna::surfmesh
