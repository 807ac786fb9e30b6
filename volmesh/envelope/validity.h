// Which macro-elements (the one wedge, pyramid or tet between a wall triangle and its envelope triangle) are valid with margin, and changes of the
// envelope that keep them so.
#pragma once

#include <vector>

#include "volmesh/envelope/edge_fold.h"
#include "volmesh/envelope/envelope.h"

namespace sterna::volmesh {

/// Corner data of a macro-element: height and direction at its three vertices.
struct MacroElement {
  std::array<Point, 3> wall;
  std::array<Vec3, 3> direction;
  std::array<double, 3> height;  ///< 0 = collapsed corner
};
MacroElement macro_element(const LayerBase& base, const EnvelopeShape& envelope, TriangleId t);

/// Valid by the exact test of its element type, and with margin: the envelope triangle keeps a share of the wall triangle's projected area (g_1 of
/// eq. (6)) and is not seen too flatly along any growth edge, unless the wall triangle itself is seen so.
bool is_macro_valid(const MacroElement& element);

/// A prism: no collapsed corner.
bool is_prism(const MacroElement& element);
/// Quality of a macro-element that is a prism (wedge_quality).
double scaled_jacobian(const MacroElement& element);
/// Triangles with a marked corner whose macro-element is not valid or, being a prism, of a lower quality than `least_quality`; ascending.
std::vector<TriangleId> low_quality_elements(const LayerBase& base, const EnvelopeShape& shape, double least_quality,
                                             const Column<VertexId, std::uint8_t>& marked, const RunContext& context);

/// The vertices at an edge between two triangles: its ends, the third corner of the triangle of the half-edge, that of the other one.
using EdgeDiamond = std::array<VertexId, 4>;
/// \pre the half-edge is none of the boundary.
EdgeDiamond edge_diamond(const LayerBase& base, HalfedgeId h);
FoldPoints wall_points(const LayerBase& base, const EdgeDiamond& diamond);
FoldPoints envelope_points(const LayerBase& base, const EnvelopeShape& shape, const EdgeDiamond& diamond);
/// The envelope leaves room for tetrahedra along the edge (edge_fold.h); true on the boundary.
bool is_fold_open(const LayerBase& base, const EnvelopeShape& shape, HalfedgeId h);

/// Triangles whose macro-element is not valid or whose envelope triangle is folded too sharply with a neighbour, ascending. With `around`, only triangles at
/// these vertices are looked at.
std::vector<TriangleId> invalid_macros(const LayerBase& base, const EnvelopeShape& shape, const RunContext& context,
                                       const std::vector<VertexId>* around = nullptr);

/// Other directions and heights for some vertices.
struct ShapeChange {
  std::vector<VertexId> vertices;  ///< ascending
  std::vector<Vec3> direction;
  std::vector<double> height;
};
/// The vertices at which `to` differs from `from`.
ShapeChange difference(const EnvelopeShape& from, const EnvelopeShape& to, const RunContext& context);

/// A change that is in force at the vertices where it has not been taken back. No copy of the shape is made: the change holds the other values.
class TrialChange {
 public:
  /// Puts the change in force wherever it is_inside(). `base` and `shape` must outlive this.
  TrialChange(const LayerBase& base, EnvelopeShape& shape, ShapeChange change, const RunContext& context);

  const Column<VertexId, std::uint8_t>& in_force() const { return is_in_force_; }
  std::vector<VertexId> vertices_in_force() const;
  /// False when the change is not in force there.
  bool take_back(VertexId v);
  /// Takes the change back at vertices of invalid elements, first among the elements at `around`, then around what went back, until none is invalid that
  /// was not so before. Returns the vertices.
  std::vector<VertexId> take_back_invalid(std::vector<VertexId> around);

 private:
  void exchange(std::size_t i);

  const LayerBase& base_;
  EnvelopeShape& shape_;
  const RunContext& context_;
  ShapeChange change_;
  Column<VertexId, std::uint8_t> is_in_force_;
  Column<VertexId, std::uint32_t> place_;  ///< of a vertex in the change
};

/// Moves `envelope` to `proposal` (direction and height) at every vertex where this leaves its macro-elements valid and itself is_inside(): all at once, then
/// vertices of invalid elements go back, until none is invalid that was not so before.
/// \pre same wall; vertices with proposal == envelope are not touched.
void apply_where_valid(const LayerBase& base, EnvelopeShape& envelope, const EnvelopeShape& proposal, const RunContext& context);

}  // namespace sterna::volmesh
