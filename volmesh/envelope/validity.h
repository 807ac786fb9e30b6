// Validity with margin of macro-elements, and changes of the envelope that preserve validity. A macro-element is the single wedge, pyramid or tetrahedron
// between a wall triangle and its envelope triangle.
#pragma once

#include <vector>

#include "geom/base/borrowed.h"
#include "volmesh/envelope/edge_fold.h"
#include "volmesh/envelope/envelope.h"

namespace sterna::volmesh {

/// Corner data of a macro-element: height and direction at its three wall vertices.
struct MacroElement {
  std::array<Point, 3> wall;
  std::array<Vec3, 3> direction;
  std::array<double, 3> height;  ///< 0: the corner is collapsed
};
MacroElement macro_element(const LayerBase& base, const EnvelopeShape& envelope, TriangleId t);

/// Returns true if the element is valid by the exact test of its element type, and with margin. The envelope triangle must keep a fraction of the wall
/// triangle's projected area (g_1 of eq. (6)). Its angle to each growth edge must not be too flat, unless the angle at the wall triangle itself is as flat.
bool is_macro_valid(const MacroElement& element);

/// Returns true for a prism, which has no collapsed corner.
bool is_prism(const MacroElement& element);
/// Returns the quality of a macro-element that is a prism (wedge_quality).
double scaled_jacobian(const MacroElement& element);
/// Returns the triangles with a marked corner whose macro-element is invalid, or is a prism of lower quality than `least_quality`; ascending.
std::vector<TriangleId> low_quality_elements(const LayerBase& base, const EnvelopeShape& shape, double least_quality,
                                             const Column<VertexId, std::uint8_t>& marked, const RunContext& context);

/// Vertices at an edge between two triangles: the two ends of the edge, the third corner of the half-edge's triangle, the third corner of the other triangle.
using EdgeDiamond = std::array<VertexId, 4>;
/// \pre the half-edge is not on the boundary
EdgeDiamond edge_diamond(const LayerBase& base, HalfedgeId h);
FoldPoints wall_points(const LayerBase& base, const EdgeDiamond& diamond);
FoldPoints envelope_points(const LayerBase& base, const EnvelopeShape& shape, const EdgeDiamond& diamond);
/// Returns true if the envelope leaves room for tetrahedra along the edge (edge_fold.h); always true on the boundary.
bool is_fold_open(const LayerBase& base, const EnvelopeShape& shape, HalfedgeId h);

/// Returns the triangles whose macro-element is invalid, or whose envelope triangle is folded too sharply with a neighbour; ascending. With `around`, only
/// triangles at these vertices are tested.
std::vector<TriangleId> invalid_macros(const LayerBase& base, const EnvelopeShape& shape, const RunContext& context,
                                       const std::vector<VertexId>* around = nullptr);

/// New directions and heights for some vertices.
struct ShapeChange {
  std::vector<VertexId> vertices;  ///< ascending
  std::vector<Vec3> direction;
  std::vector<double> height;
};
/// Returns the vertices at which `to` differs from `from`, and the values of `to` there.
ShapeChange difference(const EnvelopeShape& from, const EnvelopeShape& to, const RunContext& context);

/// A change that is applied at all vertices at which it has not been taken back. The shape is not copied: this object stores the values that are not applied.
class TrialChange {
 public:
  /// Applies the change at the vertices where the result is_inside().
  TrialChange(Borrowed<const LayerBase> base, Borrowed<EnvelopeShape> shape, ShapeChange change, const RunContext& context);

  const Column<VertexId, std::uint8_t>& in_force() const { return is_in_force_; }
  std::vector<VertexId> vertices_in_force() const;
  /// Takes the change back at v. Returns false if the change is not applied there.
  bool take_back(VertexId v);
  /// Takes the change back at vertices of invalid elements until no element is invalid that was valid before. Tests the elements at `around` first, then those
  /// around vertices taken back. Returns the vertices taken back.
  std::vector<VertexId> take_back_invalid(std::vector<VertexId> around);

 private:
  void exchange(std::size_t i);

  const LayerBase& base_;
  EnvelopeShape& shape_;
  RunContext context_;
  ShapeChange change_;
  Column<VertexId, std::uint8_t> is_in_force_;
  Column<VertexId, std::uint32_t> location_;  ///< for each vertex its index in the change
};

/// Moves `envelope` to `proposal` (direction and height) at every vertex where macro-elements stay valid and the vertex itself is_inside(). All vertices move
/// at once. Then vertices of invalid elements are moved back until no element is invalid that was valid before.
/// \pre both envelopes have the same wall; vertices with proposal == envelope are unchanged
void apply_where_valid(const LayerBase& base, EnvelopeShape& envelope, const EnvelopeShape& proposal, const RunContext& context);

}  // namespace sterna::volmesh
