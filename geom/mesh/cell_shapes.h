// Faces and cells as cell-centred solvers see them, one at a time: OpenFOAM's centres and measures (docs/method/quality.md, "Cell-centred measures").
//
// Face centre: of a triangle the mean of its corners; of a quadrilateral the mean of the triangles around its middle, weighted by area. Cell centre: the mean
// of the pyramids from the mean of its face centres to its faces, weighted by volume.
#pragma once

#include <array>
#include <cstdint>
#include <span>

#include "geom/mesh/hybrid_mesh.h"

namespace sterna::check_parts {

/// Keeps quotients finite where a length, an area or a product of them vanishes (OpenFOAM's ROOTVSMALL).
inline constexpr double k_tiny = 1e-150;
/// Share of the distance between centres (for a boundary face of the distance to its plane) that counts as the face's reach where the face itself is smaller.
inline constexpr double k_inner_reach = 0.2, k_boundary_reach = 0.4;
/// A sphere's radius that is as good as none, for flat tets (OpenFOAM's GREAT).
inline constexpr double k_great = 1e15;
inline constexpr double k_least_power = 1e-250;  ///< powers of volumes below this have lost digits

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

/// What faces need of a cell.
struct Place {
  Point centre;
  double volume = 0.0;  ///< m^3
};

/// Of a face between two cells.
struct InnerFace {
  double non_orthogonality = 0.0;  ///< radians
  double skewness = 0.0, weight = 0.0, volume_ratio = 0.0;
  double flatness = 1.0;
  double tets = 0.0;
};
/// \pre 3 or 4 corners, normal from a to b
InnerFace inner_face(std::span<const Point> corners, const Place& a, const Place& b);

/// Of a face of one cell, without what needs two.
struct OuterFace {
  double skewness = 0.0, flatness = 1.0, tets = 0.0;
};
/// \pre 3 or 4 corners, normal out of the cell
OuterFace outer_face(std::span<const Point> corners, const Place& cell);

/// checkMesh's decomposition of a face for tracking: all tets around its centre, and those of the best of its cuts into triangles, must be the right way round
/// on both sides. Of a triangle the second are as good as the first. `other`: null at the boundary.
double exact_face_tet_quality(const FaceShape& face, std::span<const Point> corners, const Point& cell, const Point* other);

}  // namespace sterna::check_parts
