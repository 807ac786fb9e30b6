// SU2's median dual mesh and its three quality metrics (docs/method/quality.md, "Median dual"), node by node, without storing the dual mesh.
//
// Each cell is cut into sub-tets (node, edge midpoint, face centroid, cell centroid; centroids are means of nodes). A node's control volume is the sum of its
// sub-tets; the dual face of an edge is the sum of the triangles (edge midpoint, face centroid, cell centroid) over its cells, two in each; at the boundary
// the control volume ends on pieces (node, edge midpoint, face centroid), one dual face for each patch.
#pragma once

#include <cstdint>
#include <vector>

#include "geom/base/parallel.h"
#include "geom/base/run_context.h"
#include "geom/mesh/gates.h"
#include "geom/mesh/hybrid_mesh.h"

namespace sterna {

/// Of one node's control volume. NaN where a figure does not exist.
struct NodeMetrics {
  double orthogonality = 0.0;             ///< radians: mean of pi/2 less the angle between dual face and edge, weighted by dual face area
  double face_area_ratio = 0.0;           ///< largest over smallest dual face, boundary faces included; infinite when one has no area
  double relative_face_area_ratio = 0.0;  ///< the same over l_t / H: longest edge along the layer over height of the control volume along its line; lines only,
                                          ///< below their top. 1.5 for a regular triangulation, stacked straight
  double sub_volume_ratio = 0.0;          ///< largest over smallest sub-tet; infinite when one is not positive
  double edge_ratio = 0.0;                ///< longest over shortest edge, edges along the stack (lines, growth edges of prisms) left out; NaN at hexahedra
  double closure = 0.0;                   ///< length of the sum of all dual face normals over the sum of their areas
  double volume = 0.0;                    ///< m^3, sum of the sub-tets
};

/// Metrics of every node; a node without cells has NaN. For pictures and tests: `check` needs no such table.
/// \pre conforming (no G1 violation), points finite.
Column<NodeId, NodeMetrics> dual_metrics(const HybridMesh& mesh, const RunContext& context);

/// Statistics of all nodes; ids are nodes.
struct DualScan {
  explicit DualScan(const GateTable& limits);
  GateScan closure, orthogonality, sub_volume_ratio, face_area_ratio, relative_face_area_ratio, edge_ratio;
  CompensatedSum volume;
  std::vector<std::uint64_t> suspects;  ///< cells (numbers of check_parts::CellNumbers) with a sub-tet that may not be positive in double precision
  void add(std::uint64_t node, const NodeMetrics& metrics);
  void merge(DualScan&& other);
};

/// One pass over all nodes: columns along their lines, four layers at a time, everything else cell by cell around each node. Parallel; needs about 12 bytes for
/// each node that is not inside a column and 4 for each corner of an explicit cell.
/// \pre as dual_metrics `lines`: what scan_lines() has found; not used when explicit cells or boundary faces touch nodes inside columns.
DualScan scan_dual(const HybridMesh& mesh, const GateTable& limits, const RunContext& context, const DualScan* lines = nullptr);
/// The part of it for nodes inside columns; nothing else of the mesh is looked at.
DualScan scan_lines(const HybridMesh& mesh, const GateTable& limits, const RunContext& context);

/// Whether every sub-tet of a cell is positive. Exact.
bool are_sub_volumes_positive(const HybridMesh& mesh, const Cell& cell);

}  // namespace sterna
