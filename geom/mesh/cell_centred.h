// What cell-centred solvers feel of a mesh: OpenFOAM's measures of faces and cells (docs/method/quality.md, "Cell-centred measures"), with its face and cell
// centres, so that the figures are checkMesh's.
#pragma once

#include <cstdint>
#include <span>

#include "geom/mesh/check_parts.h"

namespace sterna::check_parts {

/// Statistics over all faces and cells. Ids of faces: 8 cell + local number for sides of columns (corner 0..2) and tops (7) inside columns; k_of_slot + slot
/// for others. Of cells: their numbers.
struct CellCentredScan {
  static constexpr std::uint64_t k_of_slot = std::uint64_t{1} << 63;
  explicit CellCentredScan(const GateTable& limits);
  GateScan non_orthogonality, skewness, face_weight, volume_ratio, face_flatness, cell_aspect_ratio, cell_openness, face_tets, stacked_orthogonality,
      stacked_skewness, cell_determinant;
  void merge(const CellCentredScan& other);
};

/// The part of scan_cell_centred() that needs the columns alone: their cells and the faces between them, but for the determinants of cells that may have a face
/// elsewhere. Parallel; holds nothing for each cell.
/// \param neighbours of find_open_sides
/// \pre indices can be used, points are finite
CellCentredScan scan_column_centres(const HybridMesh& mesh, std::span<const std::uint32_t> neighbours, const GateTable& limits, const RunContext& context);
/// Adds all the rest to what was found in the columns. Parallel; holds a byte for each cell, and 32 for each explicit one that is no tetrahedron.
/// \pre no G1 violation; `match` was made with pairs
CellCentredScan scan_cell_centred(CellCentredScan columns, const HybridMesh& mesh, const CellNumbers& cells, const FaceSlots& slots, const FaceMatch& match,
                                  std::span<const std::uint32_t> neighbours, const GateTable& limits, const RunContext& context);
/// The gates into the report.
void judge_cell_centred(const CellCentredScan& scan, const HybridMesh& mesh, const CellNumbers& cells, const FaceSlots& slots,
                        std::span<const std::uint32_t> neighbours, const GateTable& limits, LazyGivenLayer& given, CheckReport& report);

}  // namespace sterna::check_parts
