// Cell-centred measures of the prisms of columns and of the faces between them, four layers at a time.
#pragma once

#include <array>
#include <cstdint>
#include <span>
#include <vector>

#include "geom/mesh/cell_shapes.h"
#include "geom/mesh/lanes.h"

namespace sterna::check_parts {

/// As cell_shape() and inner_face() have them, to the bit but for the angle (two roundings). What it returns is valid until the next call of the same member.
class ColumnShapes {
 public:
  explicit ColumnShapes(const HybridMesh& mesh) : mesh_(mesh) {}

  /// The column that the members below are about.
  /// \pre none of its lines is collapsed
  void read(std::size_t column);
  /// Its prisms from the wall up; their determinants as if no face were on the boundary.
  std::span<const CellShape> cells();
  /// Their centres and volumes alone, into `places`, one for each layer.
  void places(Place* places) const;
  /// Faces between its prisms, the lowest first. \param places of its prisms; three more may be read
  std::span<const InnerFace> tops(const Place* places);
  /// Faces between its prisms and those of the column across a side.
  std::span<const InnerFace> side(std::size_t corner, const Place* places, const Place* places_beyond);

 private:
  using Side = std::array<lanes::Vec3x4, 4>;
  Side side_at(std::size_t corner, std::size_t layer) const;

  const HybridMesh& mesh_;
  std::size_t n_ = 0;  ///< layers
  std::array<lanes::LineVectors, 3> lines_;
  std::vector<CellShape> cells_;
  std::vector<InnerFace> tops_, sides_;
};

}  // namespace sterna::check_parts
