// Where the top of the layer meets itself, the wall or the outer boundary: exact triangle tests over a hierarchy that is built once and refitted
// where the top has moved.
#pragma once

#include <compare>
#include <cstdint>
#include <vector>

#include "volmesh/envelope/box_pairs.h"
#include "volmesh/envelope/envelope.h"

namespace sterna::volmesh {

/// The surfaces around the volume that the tetrahedra fill. Sides stand on the wall's boundary: a quadrilateral between wall edge and envelope edge,
/// as two triangles.
enum class BoundaryPart : std::uint8_t { top, side, wall, outer };
std::string_view to_string(BoundaryPart part);

struct BoundaryTriangle {
  BoundaryPart part = BoundaryPart::top;
  std::uint32_t index = 0;  ///< top, wall: wall triangle; outer: triangle of the outer boundary; side: 2 * boundary edge + 0 or 1
  friend auto operator<=>(const BoundaryTriangle&, const BoundaryTriangle&) = default;
};
using BoundaryCrossing = std::array<BoundaryTriangle, 2>;

/// A point of one part of the boundary within a macro-element of another part's layer.
struct Swallowing {
  Point place;
  std::vector<VertexId> vertices;  ///< whose heights do it
  double clear_share = 0.0;        ///< largest share of these heights, to 0.1 %, at which the point is outside
};

/// What an outer boundary shares with the wall.
struct OuterLinks {
  Column<VertexId, VertexId> line;           ///< of each outer vertex: the wall vertex at the same place; invalid away from the wall
  Column<TriangleId, std::int32_t> surface;  ///< of each outer triangle: number of the constraint surface that it is part of, or -1
  bool empty() const { return line.empty(); }
};

class Collider {
 public:
  /// `outer` may be null; all must outlive this. With `links`, the outer boundary begins at the wall's rim; its triangles on a constraint surface do not count
  /// against triangles of top and sides that have a vertex on that surface: they will be made anew around the layer. Memory: about 150 bytes per wall triangle.
  Collider(const LayerBase& base, const TriMesh* outer, const RunContext& context, const OuterLinks* links = nullptr);

  /// Brings the top to where `shape` has it; with `stretched`, marked vertices to `stretch` times their height. Cheap where nothing moved.
  void move_top(const EnvelopeShape& shape, const RunContext& context, double stretch = 1.0, const Column<VertexId, std::uint8_t>* stretched = nullptr);

  /// Crossing pairs (triangles_cross; corners are shared by wall vertex) of which at least one triangle belongs to top or sides and, with `around`, to one of
  /// these vertices; sorted. With `against`, only pairs of such a triangle and one of top or sides at a marked vertex. Where all three corners are collapsed,
  /// the wall triangle stands for the top's.
  /// \pre move_top() was called.
  std::vector<BoundaryCrossing> crossings(const RunContext& context, const std::vector<VertexId>* around = nullptr,
                                          const Column<VertexId, std::uint8_t>* against = nullptr);
  /// Crossing pairs among wall and outer boundary: no height can repair them.
  std::vector<BoundaryCrossing> fixed_crossings(const RunContext& context);
  /// Parts of the boundary (connected parts of wall and top, the outer boundary) that lie within the layer of another part, which can be although nothing
  /// crosses. One entry per part.
  /// \pre crossings() is empty at `shape`, to which move_top() was called.
  std::vector<Swallowing> swallowings(const EnvelopeShape& shape) const;
  /// Pairs with overlapping boxes, tested exactly, of the last call of one of the two.
  std::int64_t n_pairs() const { return n_pairs_; }

  /// Largest share, to 0.1 %, such that the pair is clear when each triangle's heights are cut to that share of its tallest; 0 when there is none.
  double clear_share(const BoundaryCrossing& pair, const EnvelopeShape& shape) const;
  /// Height of the tallest vertex that moves the triangle, m.
  double tallest(const BoundaryTriangle& triangle, const EnvelopeShape& shape) const;

  /// Vertices whose height moves the triangle: none for wall and outer boundary.
  std::vector<VertexId> moving_vertices(const BoundaryTriangle& triangle) const;
  std::array<Point, 3> corners_of(const BoundaryTriangle& triangle) const;
  /// Triangles of all parts that are there: those of the top that are not the wall's, and sides with an area.
  std::int64_t n_triangles() const;

  /// Triangles whose box overlaps the given one, appended to `found` in a fixed order: of the wall; wall triangles whose macro-element does; of the outer
  /// boundary.
  void find_walls(const Box& box, std::vector<std::uint32_t>& found) const;
  void find_cells(const Box& box, std::vector<std::uint32_t>& found) const;
  void find_outer(const Box& box, std::vector<std::uint32_t>& found) const;
  const TriMesh* outer() const { return outer_; }
  /// Whether an outer triangle is part of a constraint surface that the wall vertex is on.
  bool holds(std::uint32_t outer_triangle, VertexId v) const;

 private:
  using Corners = std::array<std::uint32_t, 3>;  ///< points of points_
  bool is_down(VertexId v) const { return is_collapsed_[v] != 0; }
  std::uint32_t top_point(VertexId v) const;
  Corners points_of(const BoundaryTriangle& triangle) const;
  bool is_held(const BoundaryTriangle& moving, std::uint32_t outer_triangle) const;
  /// Whether a wall triangle has a line of an opened ridge in the outer triangle's surface, which was left as it is: they touch.
  bool has_fan_on(TriangleId wall_triangle, std::uint32_t outer_triangle) const;
  template <class F>
  void for_each_moving(TriangleId t, const F& f) const;
  template <class RoleOf>
  void assign_roles(const RoleOf& role_of, bool refit, const RunContext& context);

  const LayerBase& base_;
  const TriMesh* outer_;
  const OuterLinks* links_;
  std::vector<Vec3> points_;  ///< of the wall, of the top, of the outer boundary
  Column<VertexId, std::uint8_t> is_collapsed_;
  std::vector<HalfedgeId> rim_;  ///< the wall's boundary, ascending
  BoxHierarchy tree_;            ///< of the wall; the top's boxes use the same
  BoxHierarchy outer_tree_;
  FittedBoxes wall_, top_, outer_boxes_;
  Column<TriangleId, std::uint32_t> component_;  ///< connected part of the wall
  std::uint32_t n_components_ = 0;
  bool has_top_ = false;
  std::int64_t n_pairs_ = 0;
};

}  // namespace sterna::volmesh
