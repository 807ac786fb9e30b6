// Finds intersections of the top of the layer with itself, the wall or the outer boundary. Triangles are tested exactly, over a hierarchy that is built once
// and refitted where the top has moved.
#pragma once

#include <compare>
#include <cstdint>
#include <vector>

#include "geom/base/borrowed.h"
#include "volmesh/envelope/box_pairs.h"
#include "volmesh/envelope/envelope.h"

namespace sterna::volmesh {

/// Surfaces around the volume that will be filled with tetrahedra. Sides stand on the wall's boundary. Each side is a quadrilateral between a wall edge and an
/// envelope edge, stored as two triangles.
enum class BoundaryPart : std::uint8_t { top, side, wall, outer };
std::string_view to_string(BoundaryPart part);

struct BoundaryTriangle {
  BoundaryPart part = BoundaryPart::top;
  /// Top and wall: number of the wall triangle; outer: number of the triangle of the outer boundary; side: 2 * boundary edge + 0 or 1.
  std::uint32_t index = 0;
  friend auto operator<=>(const BoundaryTriangle&, const BoundaryTriangle&) = default;
};
using BoundaryCrossing = std::array<BoundaryTriangle, 2>;

/// A point of one part of the boundary that lies within a macro-element of another part's layer.
struct Swallowing {
  Point location;
  std::vector<VertexId> vertices;  ///< vertices whose heights cause the overlap
  double clear_share = 0.0;        ///< largest fraction of these heights, to 0.1 %, at which the point is outside
};

/// Entities of an outer boundary that coincide with the wall.
struct OuterLinks {
  Column<VertexId, VertexId> line;           ///< per outer vertex: the wall vertex at the same location; invalid if there is none
  Column<TriangleId, std::int32_t> surface;  ///< per outer triangle: number of its constraint surface, or -1
  bool empty() const { return line.empty(); }
};

class Collider {
 public:
  /// `outer` and `links` may be null; the caller keeps both like the base. With `links`, the outer boundary begins at the open boundary of the wall. Outer
  /// triangles on a constraint surface are then not tested against triangles of top and sides that have a vertex on that surface, because these outer triangles
  /// will be re-meshed around the layer. Memory: about 150 bytes per wall triangle.
  Collider(Borrowed<const LayerBase> base, const TriMesh* outer, const RunContext& context, const OuterLinks* links = nullptr);

  /// Moves the top to the points of `shape`. With `stretched`, marked vertices move to `stretch` times their height. The cost is small where nothing moved.
  void move_top(const EnvelopeShape& shape, const RunContext& context, double stretch = 1.0, const Column<VertexId, std::uint8_t>* stretched = nullptr);

  /// Returns crossing pairs, sorted (triangles_cross; corners are shared if they have the same wall vertex). At least one triangle of a pair belongs to top or
  /// sides and, with `around`, has one of these vertices. With `against`, the other triangle must be a triangle of top or sides at a marked vertex. If all
  /// three corners of a top triangle are collapsed, the wall triangle replaces it.
  /// \pre move_top() was called
  std::vector<BoundaryCrossing> crossings(const RunContext& context, const std::vector<VertexId>* around = nullptr,
                                          const Column<VertexId, std::uint8_t>* against = nullptr);
  /// Returns crossing pairs among triangles of wall and outer boundary. No layer height can repair these.
  std::vector<BoundaryCrossing> fixed_crossings(const RunContext& context);
  /// Returns parts of the boundary that lie within the layer of another part, which is possible although nothing crosses. Parts are connected parts of wall and
  /// top, and the outer boundary. There is one entry per part.
  /// \pre crossings() is empty for `shape`, and move_top() was called for it
  std::vector<Swallowing> swallowings(const EnvelopeShape& shape) const;
  /// Returns the number of pairs with overlapping boxes, which were tested exactly, in the last call of crossings() or fixed_crossings().
  std::int64_t n_pairs() const { return n_pairs_; }

  /// Returns the largest fraction, to 0.1 %, at which the pair is clear. The heights of each triangle are cut to that fraction of its tallest height. Returns 0
  /// if there is no such fraction.
  double clear_share(const BoundaryCrossing& pair, const EnvelopeShape& shape) const;
  /// Returns the height of the tallest vertex that moves the triangle, m.
  double tallest(const BoundaryTriangle& triangle, const EnvelopeShape& shape) const;

  /// Returns the vertices whose heights move the triangle; none for triangles of wall and outer boundary.
  std::vector<VertexId> moving_vertices(const BoundaryTriangle& triangle) const;
  std::array<Point, 3> corners_of(const BoundaryTriangle& triangle) const;
  /// Returns the number of triangles of all parts. Counted are triangles of the top that differ from those of the wall, and sides with an area.
  std::int64_t n_triangles() const;

  /// These functions append the triangles whose box overlaps the given box to `found`, in a fixed order: wall triangles (find_walls), wall triangles whose
  /// macro-element overlaps it (find_cells), outer triangles (find_outer).
  void find_walls(const Box& box, std::vector<std::uint32_t>& found) const;
  void find_cells(const Box& box, std::vector<std::uint32_t>& found) const;
  void find_outer(const Box& box, std::vector<std::uint32_t>& found) const;
  const TriMesh* outer() const { return outer_; }
  /// Returns true if an outer triangle is part of a constraint surface on which the wall vertex lies.
  bool holds(std::uint32_t outer_triangle, VertexId v) const;

 private:
  using Corners = std::array<std::uint32_t, 3>;  ///< indices in points_
  bool is_down(VertexId v) const { return is_collapsed_[v] != 0; }
  std::uint32_t top_point(VertexId v) const;
  Corners points_of(const BoundaryTriangle& triangle) const;
  bool is_held(const BoundaryTriangle& moving, std::uint32_t outer_triangle) const;
  /// Returns true if a wall triangle has a growth line of an opened ridge in the surface of an outer triangle that is not re-meshed. The two triangles then
  /// touch.
  bool has_multi_normal_on(TriangleId wall_triangle, std::uint32_t outer_triangle) const;
  template <class F>
  void for_each_moving(TriangleId t, const F& f) const;
  template <class RoleOf>
  void assign_roles(const RoleOf& role_of, bool refit, const RunContext& context);

  const LayerBase& base_;
  const TriMesh* outer_;
  const OuterLinks* links_;
  std::vector<Vec3> points_;  ///< points of the wall, then of the top, then of the outer boundary
  Column<VertexId, std::uint8_t> is_collapsed_;
  std::vector<HalfedgeId> border_;  ///< boundary half-edges of the wall, ascending
  BoxHierarchy tree_;               ///< hierarchy over the wall, which is also used for the boxes of the top
  BoxHierarchy outer_tree_;
  FittedBoxes wall_, top_, outer_boxes_;
  Column<TriangleId, std::uint32_t> component_;  ///< connected part of the wall to which each triangle belongs
  std::uint32_t n_components_ = 0;
  bool has_top_ = false;
  std::int64_t n_pairs_ = 0;
};

}  // namespace sterna::volmesh
