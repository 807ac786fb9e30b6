// Section of a volume mesh by a plane: one polygon per crossed cell, with values for colouring. For pictures and reports.
#pragma once

#include <cstdint>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "geom/base/run_context.h"
#include "geom/mesh/hybrid_mesh.h"

namespace sterna {

/// Limits the section to polygons that reach into this sphere.
struct CutLimits {
  Point center;
  double radius = 0.0;  ///< m
};

struct CutPlane {
  Point origin;
  Vec3 normal{0.0, 1.0, 0.0};  ///< any non-zero length
  std::optional<CutLimits> limits;
};

/// Properties of the cell of one polygon.
struct CutPolygon {
  CellKind kind = CellKind::tetrahedron;
  bool is_in_layer = false;  ///< any cell of a column; in a mesh without columns every cell except tetrahedra
  std::int32_t layer = -1;   ///< 0 = at the wall; -1 for cells outside columns
  std::uint64_t cell = 0;    ///< number among the cells of this kind in file order, so it is the same for columns and explicit cells
  double quality = 0.0;      ///< prisms: wedge_quality; tetrahedra: smallest dihedral angle, degrees; other cells: NaN
  double shape = 0.0;        ///< 1 = ideal, at most 0 = inverted; prisms: wedge_quality; tetrahedra: smallest dihedral angle over that of the regular one;
                             ///< other cells: worst corner
  double volume = 0.0;       ///< m^3
};

struct MeshCut {
  std::vector<Point> corners;           ///< corners of all polygons, consecutively; right-handed about the plane's normal
  std::vector<std::uint64_t> first{0};  ///< first corner of each polygon, and the end
  std::vector<CutPolygon> polygons;

  std::size_t size() const { return polygons.size(); }
  std::span<const Point> corners_of(std::size_t polygon) const { return {corners.data() + first[polygon], first[polygon + 1] - first[polygon]}; }
};

/// Cuts a mesh by a plane.
/// A node in the plane counts as above it, as if the plane were shifted slightly towards its negative side. Faces in the plane are therefore drawn once, by
/// the cell below them, and the polygons tile the section without gaps or overlaps. Side faces of four nodes are bilinear. If the plane crosses all four
/// edges of such a face, the saddle of the bilinear surface decides which corners are connected, in the same way for both cells. Polygons come in file order
/// of their cells (a cell with warped sides may have two). Polygons without area, where a cell touches the plane with an edge or node only, are left out.
/// Costs one pass over nodes and cells and 1 byte per node; columns whose lines lie on one side are skipped whole.
/// \pre indices in range, finite points
/// \throws Error(bad_argument) if the normal has zero length
MeshCut cut_mesh(const HybridMesh& mesh, const CutPlane& plane, const RunContext& context);

/// Returns a text for messages: "the plane is at 100 m along (1, 0, 0), the mesh reaches from -5 m to 6 m".
std::string clear_plane_text(const HybridMesh& mesh, const CutPlane& plane);

}  // namespace sterna
