// Proofs that the wall under a layer alone puts a value of the layer beyond its hard limit, wherever the lines lead. Each is a bound, stated in
// docs/quality_gates.md. Taken as they are: the wall's triangles, the request, and the lengths of lines and of their steps.
#pragma once

#include <algorithm>
#include <array>
#include <cstdint>
#include <numbers>
#include <optional>
#include <span>
#include <string>
#include <utility>
#include <vector>

#include "geom/math/measures.h"
#include "geom/mesh/dual_parts.h"
#include "geom/mesh/gates.h"
#include "geom/mesh/hybrid_mesh.h"
#include "geom/mesh/line_measures.h"

namespace sterna::check_parts {

/// Lines are supposed to lead at most this far off the direction that sees the facets at their feet best, rad: what G10 takes for the best.
inline constexpr double k_lean_room = std::numbers::pi / 18.0;
inline constexpr const char* k_more_normals =
    "several normals along that edge (open_ridges = \"always\"), a blunt edge in the given surface, or triangles of like size on both of its sides";

/// How far the area vector of a triangle may be off when each of its corners moves by at most `moved`, m^2.
inline double area_error(double longest_side, double moved) { return 2.0 * moved * (longest_side + moved); }
inline double longest_side(const Point& a, const Point& b, const Point& c) { return std::max({distance(a, b), distance(b, c), distance(c, a)}); }

/// A face between two columns: side `corner` of `column` in layer `layer`; `other` is the column behind it.
struct ColumnSide {
  std::size_t column = 0;
  std::size_t corner = 0;
  std::size_t other = 0;
  int layer = 0;
};

class GivenLayer {
 public:
  explicit GivenLayer(const HybridMesh& mesh);

  /// G5. Where the layer is thin, the dual faces across a line are parallel to the sum of the facets at its foot, and no line that sees all facets comes near
  /// the normal of that sum.
  std::optional<Forcing> orthogonality(NodeId node, double limit) const;
  /// OpenFOAM's face weight. Where the layer is thin, centres of cells are as far from a side as the wall triangles reach from their common edge.
  std::optional<Forcing> face_weight(const ColumnSide& side, double limit) const;
  /// OpenFOAM's volume ratio, likewise by the areas of the wall triangles.
  std::optional<Forcing> volume_ratio(const ColumnSide& side, double limit) const;
  /// OpenFOAM's skewness at sharp edges: all directions of the edge's two lines are searched by intervals.
  std::optional<Forcing> skewness(const ColumnSide& side, double limit) const;
  /// The same for what no search can tell: with one line on each node, in the direction that sees the facets best, the skewness at a sharp edge follows from
  /// the wall's two triangles as long as the layer is thin; a side whose `value` is like it or better has it from there.
  std::optional<Forcing> skewness_of_edge(const ColumnSide& side, double limit, double value) const;
  /// G9. No last cell is higher than the request's growth permits, nor than its share of the room in a gap.
  /// `gaps`: height along the wall's normal that a gap permits each line, m, infinite where there is none; may be empty.
  std::optional<Forcing> interface_height(std::size_t column, std::span<const double> gaps, double limit) const;

 private:
  struct Pair;
  struct Room;
  struct Wedge;
  /// The edge's two, then that opposite to it in the column and that in the other.
  std::array<std::uint32_t, 4> lines_of(const ColumnSide& side) const;
  std::optional<Pair> pair_of(const ColumnSide& side) const;
  std::optional<Room> room_of(std::uint32_t line, double gap) const;
  const Point& foot(std::uint32_t line) const { return mesh_.points[mesh_.layers.node(line, 0)]; }
  double step(std::uint32_t line, int layer) const;
  double length(std::uint32_t line, int layer) const;
  /// Of the facets at the line's foot, those behind symmetry planes included.
  std::vector<Vec3> normals_around(std::uint32_t line) const;
  bool is_closed(std::uint32_t line) const;
  /// Whether the cells on both sides are prisms.
  bool is_between_prisms(const ColumnSide& side) const {
    return side.layer < mesh_.layers.ends_of_column(side.column)[0] && side.layer < mesh_.layers.ends_of_column(side.other)[0];
  }

  const HybridMesh& mesh_;
  dual_parts::LineRings rings_;
  MirrorFeet feet_;
  std::vector<std::pair<std::uint32_t, std::uint32_t>> line_at_;  ///< first node and line, ascending
};

}  // namespace sterna::check_parts
