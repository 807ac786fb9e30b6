// SU2's median dual mesh and its three quality metrics (docs/method/quality.md, "Median dual"), node by node, without storing the dual mesh.
//
// Each cell is cut into sub-tets (node, edge midpoint, face centroid, cell centroid; centroids are means of nodes). The control volume of a node is the sum
// of its sub-tets. The dual face of an edge is the sum of the triangles (edge midpoint, face centroid, cell centroid) over its cells, two in each. At the
// boundary the control volume is closed by pieces (node, edge midpoint, face centroid), one dual face per patch.
#pragma once

#include <cstdint>
#include <vector>

#include "geom/base/parallel.h"
#include "geom/base/run_context.h"
#include "geom/mesh/gates.h"
#include "geom/mesh/hybrid_mesh.h"

namespace sterna {

/// Metrics of one node's control volume; NaN for a metric that is not defined.
struct NodeMetrics {
  double orthogonality = 0.0;             ///< radians: mean of pi/2 minus the angle between dual face and edge, weighted by dual face area
  double face_area_ratio = 0.0;           ///< largest over smallest dual face, including boundary faces; infinite if one has no area
  double relative_face_area_ratio = 0.0;  ///< face_area_ratio over l_t / H, where l_t is the longest edge along the layer and H the height of the control
                                          ///< volume along its line; only for nodes of lines below the line's top. 1.5 for straight stacks on a regular
                                          ///< triangulation
  double sub_volume_ratio = 0.0;          ///< largest over smallest sub-tet; infinite if one is not positive
  double edge_ratio = 0.0;                ///< longest over shortest edge, without edges along the stack (growth lines, growth edges of prisms); NaN at
                                          ///< hexahedra
  double closure = 0.0;                   ///< length of the sum of all dual face normals over the sum of their areas
  double volume = 0.0;                    ///< m^3, sum of the sub-tets
};

/// Returns the metrics of every node; NaN for a node without cells. For pictures and tests: `check` does not need this table.
/// \pre conforming (no G1 violation), points finite.
Column<NodeId, NodeMetrics> dual_metrics(const HybridMesh& mesh, const RunContext& context);

/// Statistics of all nodes; ids are node numbers.
struct DualScan {
  explicit DualScan(const GateTable& limits);
  GateScan closure, orthogonality, sub_volume_ratio, face_area_ratio, relative_face_area_ratio, edge_ratio;
  CompensatedSum volume;
  std::vector<std::uint64_t> suspects;  ///< cells (numbers of check_parts::CellNumbers) with a sub-tet that may not be positive in double precision
  void add(std::uint64_t node, const NodeMetrics& metrics);
  void merge(DualScan&& other);
};

/// Scans all nodes in one pass. Nodes of columns are scanned along their lines, four layers at a time; all other nodes are scanned cell by cell around each
/// node. Runs in parallel and needs about 12 bytes per node that is not inside a column and 4 per corner of an explicit cell.
/// \pre as dual_metrics
/// \param lines result of scan_lines(); not used if explicit cells or boundary faces touch nodes inside columns.
DualScan scan_dual(const HybridMesh& mesh, const GateTable& limits, const RunContext& context, const DualScan* lines = nullptr);
/// Runs the part of scan_dual() for nodes inside columns; accesses no other part of the mesh.
DualScan scan_lines(const HybridMesh& mesh, const GateTable& limits, const RunContext& context);

/// Returns true if every sub-tet of a cell is positive. Exact.
bool are_sub_volumes_positive(const HybridMesh& mesh, const Cell& cell);

}  // namespace sterna
