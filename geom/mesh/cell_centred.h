// What cell-centred solvers feel of a mesh: OpenFOAM's measures of faces and cells (quality.md §3), with its face and cell centres, so that the figures are
// checkMesh's.
//
// Face centre: of a triangle the mean of its corners; of a quadrilateral the mean of the triangles around its middle, weighted by area. Cell centre: the mean
// of the pyramids from the mean of its face centres to its faces, weighted by volume.
#pragma once

#include <array>
#include <cstdint>
#include <span>
#include <vector>

#include "geom/mesh/check_parts.h"

namespace sterna::check_parts {

/// Size, middle and flatness of a face as OpenFOAM has them.
struct FaceShape {
  Vec3 area;  ///< m^2, along the normal
  Point centre;
  double flatness = 1.0;  ///< |area| over the sum of the areas of its triangles around its centre; 1 for triangles
};
/// \pre 3 or 4 corners
FaceShape face_shape(std::span<const Point> corners);

struct CellShape {
  Point centre;
  double volume = 0.0;        ///< m^3
  double aspect_ratio = 1.0;  ///< larger of: largest over smallest sum of face areas seen along an axis; a sixth of all areas over volume^(2/3)
  double openness = 0.0;
  double determinant = 0.0;  ///< of the sum of a a^T over the inner faces' areas a, each over their mean size; over 8, which a cube has
};
/// `inner`: bit f is set where face f of the kind's table is no boundary face.
CellShape cell_shape(const HybridMesh& mesh, const Cell& cell, unsigned inner = ~0u);

/// Statistics over all faces and cells. Ids of faces: 8 cell + local number for sides of columns (corner 0..2) and tops (7) inside columns; k_of_slot + slot
/// for others. Of cells: their numbers.
struct CellCentredScan {
  static constexpr std::uint64_t k_of_slot = std::uint64_t{1} << 63;
  explicit CellCentredScan(const GateTable& limits);
  GateScan non_orthogonality, skewness, face_weight, volume_ratio, face_flatness, cell_aspect_ratio, cell_openness, face_tets, cell_determinant;
  void merge(const CellCentredScan& other);
};

/// Parallel; holds 32 bytes for each cell that is no explicit tetrahedron.
/// \param neighbours of find_open_sides
/// \pre no G1 violation; `match` was made with pairs
CellCentredScan scan_cell_centred(const HybridMesh& mesh, const CellNumbers& cells, const FaceSlots& slots, const FaceMatch& match,
                                  std::span<const std::uint32_t> neighbours, const GateTable& limits, const RunContext& context);
/// The gates into the report.
void judge_cell_centred(const CellCentredScan& scan, const HybridMesh& mesh, const CellNumbers& cells, const FaceSlots& slots,
                        std::span<const std::uint32_t> neighbours, const GateTable& limits, LazyGivenLayer& given, CheckReport& report);

}  // namespace sterna::check_parts
