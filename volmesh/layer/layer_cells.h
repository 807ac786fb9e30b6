// Cells of columns: exact validity of a whole column, and the certificate of a whole layer.
#pragma once

#include <algorithm>
#include <array>
#include <cstdint>
#include <functional>

#include "geom/base/run_context.h"
#include "geom/mesh/hybrid_mesh.h"

namespace sterna::volmesh {

/// Nodes of a column's three growth lines, from the wall up, and the number of cells along each; zero for a collapsed growth line.
struct ColumnLines {
  std::array<const Point*, 3> nodes;
  std::array<int, 3> n_steps;
  int n_cells() const { return std::max({n_steps[0], n_steps[1], n_steps[2]}); }
  int n_prisms() const { return std::min({n_steps[0], n_steps[1], n_steps[2]}); }
};
ColumnLines column_lines(const LayerBlock& layers, std::span<const Point> points, std::size_t column);

/// Returns true if every cell of a column is valid (exact wedge, pyramid or tetrahedron test, G3) and has positive dual sub-volumes (exact test, G4).
bool is_column_certain(const ColumnLines& lines);

/// Growth lines around a side of the layer, from the wall up: the two growth lines of the side, the third growth line of the column in whose direction the side
/// runs, and that of the column beyond (null if there is none).
struct SideLines {
  const Point *from, *to, *own, *beyond;
};
/// Quality of the quadrilaterals of a side for cell-centred solvers. The values are the worst of some layers.
struct SideShape {
  /// Quality of the decomposition into tetrahedra with the centres of the prisms on both sides (decomposition tets of checkMesh). The tetrahedra lie around the
  /// side's own centre, and along one diagonal that is the same for both prisms. The value is the ratio of the smallest to the mean tetrahedron, for the better
  /// diagonal. It is negative if there is no valid decomposition.
  double cut_share = 1.0;
  double weight = 0.5;  ///< distance of the nearer prism's centre from the side's plane, as a fraction of the sum of both distances
};
/// Limits of good sides. Both values must be reached; centres of cells are approximate here.
inline constexpr double k_good_cut_share = 0.05, k_good_side_weight = 0.06;
inline bool is_good(const SideShape& shape) { return shape.cut_share >= k_good_cut_share && shape.weight >= k_good_side_weight; }

/// Returns the centre of a column's prism in a layer.
using PrismCentre = std::function<Point(int layer)>;
/// Returns the shape of a side in the layers from `first` up to n_layers - 1. If functions are empty, the means of the corners are used, which are close to the
/// centres.
/// \pre no growth line ends below n_layers
SideShape side_shape(const SideLines& lines, int first, int n_layers, const PrismCentre& own_centre = {}, const PrismCentre& centre_beyond = {});

/// Returns the first layer in which sides of a column's prisms have to be evaluated: the first of the top layers, or the first narrow layer below them.
int first_layer_to_look_at(const ColumnLines& lines);

/// Result of the exact tests of all cells of a layer.
struct LayerCertificate {
  std::int64_t n_cells = 0;
  std::int64_t n_proved = 0;       ///< number of cells that are valid
  double min_quality = 1.0;        ///< smallest wedge_quality of the prisms (scaled Jacobian, positive if and only if the prism is valid, except for rounding)
  Point worst_location;            ///< centre of that prism
  std::int64_t worst_column = -1;  ///< location of this prism: number of the column (= wall triangle), and layer counted from the wall
  int worst_layer = -1;
};

/// \post n_proved == n_cells if and only if the layer is valid everywhere. Parallel, about 6 million prisms per second and core
LayerCertificate certify_layer(const LayerBlock& layers, std::span<const Point> points, const RunContext& context);

}  // namespace sterna::volmesh
