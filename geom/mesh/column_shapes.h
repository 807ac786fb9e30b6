// Cell-centred measures of the prisms of columns and of the faces between them, four layers at a time.
#pragma once

#include <array>
#include <cstdint>
#include <span>
#include <vector>

#include "geom/base/borrowed.h"
#include "geom/mesh/cell_shapes.h"
#include "geom/mesh/lanes.h"

namespace sterna::check_parts {

/// Computes the results of cell_shape() and inner_face(). They are equal to the bit, except for the angle, which differs by two roundings. Returned values are
/// valid until the next call of the same member.
class ColumnShapes {
 public:
  explicit ColumnShapes(Borrowed<const HybridMesh> mesh) : mesh_(mesh) {}

  /// Sets the column for the members below.
  /// \pre none of its lines is collapsed
  void read(std::size_t column);
  /// Returns the shapes of the column's prisms from the wall up. Determinants are those without any face on the boundary.
  std::span<const CellShape> cells();
  /// Writes the centres and volumes of the column's prisms to `locations`, one per layer.
  void locations(CellCentre* locations) const;
  /// Returns the faces between the column's prisms, lowest first. \param places the places of the column's prisms; three more may be read
  std::span<const InnerFace> tops(const CellCentre* locations);
  /// Returns the faces between the column's prisms and those of the column across a side.
  std::span<const InnerFace> side(std::size_t corner, const CellCentre* locations, const CellCentre* locations_beyond);

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
