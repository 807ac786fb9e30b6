// Cells of columns: exact validity of a whole column, and the certificate of a whole layer.
#pragma once

#include <algorithm>
#include <array>
#include <cstdint>
#include <functional>

#include "geom/base/run_context.h"
#include "geom/mesh/hybrid_mesh.h"

namespace sterna::volmesh {

/// Nodes of a column's three growth lines, from the wall up, and the number of cells along each: zero for a collapsed growth line.
struct ColumnLines {
  std::array<const Point*, 3> nodes;
  std::array<int, 3> n_steps;
  int n_cells() const { return std::max({n_steps[0], n_steps[1], n_steps[2]}); }
  int n_prisms() const { return std::min({n_steps[0], n_steps[1], n_steps[2]}); }
};
ColumnLines column_lines(const LayerBlock& layers, std::span<const Point> points, std::size_t column);

/// Returns true if every cell of a column is valid (exact wedge, pyramid or tet test, G3) and has positive dual sub-volumes (exact, G4).
bool is_column_certain(const ColumnLines& lines);

/// Growth lines around a side of the layer, from the wall up: the two growth lines of the side, the third one of the column that has the sense of the side,
/// and the third one of the column beyond (null: no column beyond).
struct SideLines {
  const Point *from, *to, *own, *beyond;
};
/// Quality of the quadrilaterals of a side for cell-centred solvers: the worst of some layers.
struct SideShape {
  /// Quality of the decomposition into tetrahedra with the centres of the prisms on both sides, around the side's own centre and along one and the same
  /// diagonal (decomposition tets of checkMesh): the smallest of these over the mean one, for the better diagonal; negative: no valid decomposition.
  double cut_share = 1.0;
  double weight = 0.5;  ///< share of the nearer prism's centre in the distance of both from the side's plane
};
/// Limits of good sides: both values must be reached; centres of cells are approximate here.
inline constexpr double k_good_cut_share = 0.05, k_good_side_weight = 0.06;
inline bool is_good(const SideShape& shape) { return shape.cut_share >= k_good_cut_share && shape.weight >= k_good_side_weight; }

/// Returns the centre of a column's prism in a layer, m.
using PrismCentre = std::function<Point(int layer)>;
/// Returns the shape of a side in layers from `first` on, below n_layers. Empty functions: the means of the corners are used, which are close to the centres.
/// \pre no growth line ends below n_layers
SideShape side_shape(const SideLines& lines, int first, int n_layers, const PrismCentre& own_centre = {}, const PrismCentre& centre_beyond = {});

/// Returns the first layer from which on sides of a column's prisms have to be evaluated: the first of the top layers, or the first narrow layer below them.
int first_layer_to_look_at(const ColumnLines& lines);

/// Result of the exact tests of all cells of a layer.
struct LayerCertificate {
  std::int64_t n_cells = 0;
  std::int64_t n_proved = 0;       ///< number of cells that are valid
  double min_quality = 1.0;        ///< smallest wedge_quality of the prisms (scaled Jacobian, positive iff valid up to rounding)
  Point worst_place;               ///< centre of that prism
  std::int64_t worst_column = -1;  ///< location of this prism: column = wall triangle, layer from the wall
  int worst_layer = -1;
};

/// \post n_proved == n_cells iff the layer is valid everywhere. Parallel, about 6 M prisms/s/core.
LayerCertificate certify_layer(const LayerBlock& layers, std::span<const Point> points, const RunContext& context);

}  // namespace sterna::volmesh
