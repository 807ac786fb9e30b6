// Section of a volume mesh by a plane: one polygon per cell that the plane crosses, with what colours it. For pictures and reports.
#pragma once

#include <cstdint>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "geom/base/run_context.h"
#include "geom/mesh/hybrid_mesh.h"

namespace sterna {

/// Only polygons that reach into this sphere are wanted.
struct CutLimits {
  Point center;
  double radius = 0.0;  ///< m
};

struct CutPlane {
  Point origin;
  Vec3 normal{0.0, 1.0, 0.0};  ///< of any length but zero
  std::optional<CutLimits> limits;
};

/// The cell of one polygon.
struct CutPolygon {
  CellKind kind = CellKind::tetrahedron;
  bool is_in_layer = false;  ///< any cell of a column; in a mesh without columns every cell but the tetrahedra
  std::int32_t layer = -1;   ///< 0 = at the wall; -1 for cells that are not in columns
  std::uint64_t cell = 0;    ///< counts cells of its kind in file order, so it is the same for columns and explicit cells
  double quality = 0.0;      ///< prisms: wedge_quality; tetrahedra: smallest dihedral angle, degrees; NaN for others
  double shape = 0.0;        ///< 1 = ideal, at most 0 = inverted: prisms wedge_quality, tetrahedra smallest dihedral over a regular one's, others worst corner
  double volume = 0.0;       ///< m^3
};

struct MeshCut {
  std::vector<Point> corners;           ///< of all polygons, one after the other; right-handed about the plane's normal
  std::vector<std::uint64_t> first{0};  ///< corner of each polygon, and the end
  std::vector<CutPolygon> polygons;

  std::size_t size() const { return polygons.size(); }
  std::span<const Point> corners_of(std::size_t polygon) const { return {corners.data() + first[polygon], first[polygon + 1] - first[polygon]}; }
};

/// A node in the plane counts as above it, as if the plane lay a hair towards its negative side: faces in the plane are drawn once, by the cell below them, and
/// the polygons tile the section without gaps or overlaps. Side faces of four nodes are bilinear; where the plane crosses all four edges of one, the bilinear
/// surface's saddle says which corners belong together, the same for both cells. Polygons come in file order of their cells (one cell may have two where its
/// sides are warped); those without area, where a cell touches the plane with an edge or node only, are left out.
/// Costs one pass over nodes and cells, 1 byte per node; columns whose lines lie on one side are skipped whole.
/// \pre indices in range, finite points
/// \throws Error(bad_argument) when the normal has no length
MeshCut cut_mesh(const HybridMesh& mesh, const CutPlane& plane, const RunContext& context);

/// For messages: "the plane is at 100 m along (1, 0, 0), the mesh reaches from -5 m to 6 m".
std::string clear_plane_text(const HybridMesh& mesh, const CutPlane& plane);

}  // namespace sterna
