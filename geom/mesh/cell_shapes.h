// Single faces and cells as evaluated by cell-centred solvers: OpenFOAM's centres and measures (docs/method/quality.md, "Cell-centred measures").
//
// Face centre: for a triangle the mean of its corners; for a quadrilateral the area-weighted mean of the triangles around the mean of its corners. Cell
// centre: volume-weighted mean of the pyramids from the mean of its face centres to its faces.
#pragma once

#include <array>
#include <cstdint>
#include <span>

#include "geom/mesh/hybrid_mesh.h"

namespace sterna::check_parts {

/// Keeps quotients finite where a length, an area or a product of them vanishes (OpenFOAM's ROOTVSMALL).
inline constexpr double k_tiny = 1e-150;
/// Lower bound of the face extent, as a fraction of the distance between centres (for a boundary face, of the distance to its plane).
inline constexpr double k_inner_reach = 0.2, k_boundary_reach = 0.4;
/// Practically infinite sphere radius, for flat tets (OpenFOAM's GREAT).
inline constexpr double k_great = 1e15;
inline constexpr double k_least_power = 1e-250;  ///< powers of volumes below this value have lost digits

/// Area, centre and flatness of a face in OpenFOAM's definition.
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
  double aspect_ratio = 1.0;  ///< the larger of two values: largest over smallest sum of face areas projected along an axis, and a sixth of the total area over
                              ///< volume^(2/3)
  double openness = 0.0;
  double determinant = 0.0;  ///< determinant of the sum of a a^T over the areas a of the inner faces, each divided by their mean size; then divided by 8, the
                             ///< value of a cube
};
/// Returns the measures of a cell. `inner`: bit f is set if face f of the kind's table is not a boundary face.
CellShape cell_shape(const HybridMesh& mesh, const Cell& cell, unsigned inner = ~0u);

/// Centre and volume of a cell, as needed for its faces.
struct CellCentre {
  Point centre;
  double volume = 0.0;  ///< m^3
};

/// Measures of a face between two cells.
struct InnerFace {
  double non_orthogonality = 0.0;  ///< radians
  double skewness = 0.0, weight = 0.0, volume_ratio = 0.0;
  double flatness = 1.0;
  double tets = 0.0;
};
/// \pre 3 or 4 corners, normal from a to b
InnerFace inner_face(std::span<const Point> corners, const CellCentre& a, const CellCentre& b);

/// Measures of a face of one cell; measures that need two cells are left out.
struct OuterFace {
  double skewness = 0.0, flatness = 1.0, tets = 0.0;
};
/// \pre 3 or 4 corners, normal out of the cell
OuterFace outer_face(std::span<const Point> corners, const CellCentre& cell);

/// Returns the quality of checkMesh's face decomposition for tracking. On both sides of the face, all tets around the face centre must be positive, and so must
/// the tets of the best of its cuts into triangles. For a triangle both sets have the same quality. `other`: null at the boundary.
double exact_face_tet_quality(const FaceShape& face, std::span<const Point> corners, const Point& cell, const Point* other);

}  // namespace sterna::check_parts
