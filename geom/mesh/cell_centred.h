// Mesh metrics relevant to cell-centred solvers: OpenFOAM's measures of faces and cells (docs/method/quality.md, "Cell-centred measures"). They use
// OpenFOAM's face and cell centres, so that the values agree with checkMesh.
#pragma once

#include <cstdint>
#include <span>

#include "geom/mesh/check_parts.h"

namespace sterna::check_parts {

/// Statistics over all faces and cells. Ids of faces inside columns: 8 * cell + local number (corner 0..2 for a side, 7 for a top). Ids of other faces:
/// k_of_slot + slot. Ids of cells: cell numbers.
struct CellCentredScan {
  static constexpr std::uint64_t k_of_slot = std::uint64_t{1} << 63;
  explicit CellCentredScan(const GateTable& limits);
  GateScan non_orthogonality, skewness, face_weight, volume_ratio, face_flatness, cell_aspect_ratio, cell_openness, face_tets, stacked_orthogonality,
      stacked_skewness, cell_determinant;
  void merge(const CellCentredScan& other);
};

/// Runs the part of scan_cell_centred() that needs only the columns: their cells and the faces between them. Determinants of cells that may have a face
/// elsewhere are left out. Parallel; stores nothing per cell.
/// \param neighbours result of find_open_sides()
/// \pre valid indices, finite points
CellCentredScan scan_column_centres(const HybridMesh& mesh, std::span<const std::uint32_t> neighbours, const GateTable& limits, const RunContext& context);
/// Adds all other faces and cells to the scan of the columns. Parallel; holds one byte per cell, and 32 per explicit cell that is not a tetrahedron.
/// \pre no G1 violation; `match` was computed with pairs
CellCentredScan scan_cell_centred(CellCentredScan columns, const HybridMesh& mesh, const CellNumbers& cells, const FaceSlots& slots, const FaceMatch& match,
                                  std::span<const std::uint32_t> neighbours, const GateTable& limits, const RunContext& context);
/// Evaluates the gates and adds them to the report.
void judge_cell_centred(const CellCentredScan& scan, const HybridMesh& mesh, const CellNumbers& cells, const FaceSlots& slots,
                        std::span<const std::uint32_t> neighbours, const GateTable& limits, LazyGivenLayer& given, CheckReport& report);

}  // namespace sterna::check_parts
