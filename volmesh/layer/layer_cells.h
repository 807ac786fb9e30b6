// The cells of columns: exact validity of a whole column, and the certificate of a whole layer.
#pragma once

#include <array>
#include <cstdint>
#include <functional>

#include "geom/base/run_context.h"
#include "geom/mesh/hybrid_mesh.h"

namespace sterna::volmesh {

/// Nodes of a column's three lines, from the wall up; a collapsed line has its wall node alone.
struct ColumnLines {
  std::array<const Point*, 3> nodes;
  std::array<bool, 3> is_collapsed;
};
ColumnLines column_lines(const LayerBlock& layers, std::span<const Point> points, std::size_t column);

/// Whether every cell of a column is valid (exact wedge, pyramid or tet test, G3) and has positive dual sub-volumes (exact, G4).
bool is_column_certain(const ColumnLines& lines, int n_layers);

/// The lines around a side of the layer, from the wall up: its own two, the third one of the column whose sense it has, and that of the column beyond (null: it
/// has none).
struct SideLines {
  const Point *from, *to, *own, *beyond;
};
/// Of the mean tetrahedron of a side, that each keeps: centres of cells are approximate here.
inline constexpr double k_cut_reserve = 0.05;
/// Whether the quadrilaterals of a side at the top of the layer can be cut into tetrahedra with the centres of the prisms on both sides, around their own
/// centre and along one and the same diagonal, as cell-centred solvers cut them (checkMesh's decomposition tets); with a reserve. \pre no line is collapsed
bool can_side_be_cut(const SideLines& lines, int n_layers);

/// How good a side's quadrilaterals are for cell-centred solvers, at the layer's top, by the worst.
struct SideShape {
  double cut_share = 1.0;  ///< of the smallest tetrahedron of the best cut (can_side_be_cut: at least k_cut_reserve), in the mean one; negative: none is valid
  double weight = 0.5;     ///< share of the nearer prism's centre in the distance of both from the side's plane
};
/// The centre of a column's prism in a layer, m.
using PrismCentre = std::function<Point(int layer)>;
/// Empty functions: the means of the corners, which is near.
SideShape side_shape(const SideLines& lines, int n_layers, const PrismCentre& own_centre, const PrismCentre& centre_beyond);

/// Every cell of a layer, tested by the exact test of its kind.
struct LayerCertificate {
  std::int64_t n_cells = 0;
  std::int64_t n_proved = 0;       ///< of them
  double min_quality = 1.0;        ///< smallest wedge_quality of the prisms (scaled Jacobian, positive iff valid up to rounding)
  Point worst_place;               ///< centre of that prism
  std::int64_t worst_column = -1;  ///< and where it is: column = wall triangle, layer from the wall
  int worst_layer = -1;
};

/// \post n_proved == n_cells iff the layer is valid everywhere. Parallel, about 6 M prisms/s/core.
LayerCertificate certify_layer(const LayerBlock& layers, std::span<const Point> points, const RunContext& context);

}  // namespace sterna::volmesh
