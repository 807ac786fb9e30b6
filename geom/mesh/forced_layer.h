// Proofs that the wall under a layer alone forces a layer value beyond its hard limit, for any direction of the growth lines. Each proof is a bound, stated
// in docs/quality_gates.md. The wall triangles, the request, and the lengths of lines and of their steps are taken as given.
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

#include "geom/base/borrowed.h"
#include "geom/math/measures.h"
#include "geom/mesh/dual_parts.h"
#include "geom/mesh/gates.h"
#include "geom/mesh/hybrid_mesh.h"
#include "geom/mesh/line_measures.h"

namespace sterna::check_parts {

/// rad; lines are assumed to lean by at most this angle from the direction that sees the facets at their base best, which is the reference of G10.
inline constexpr double k_lean_room = std::numbers::pi / 18.0;
inline constexpr const char* k_more_normals =
    "several normals along that edge (open_ridges = \"always\"), a blunt edge in the input surface, or triangles of similar size on both sides of the edge";

/// Returns the maximum error of a triangle's area vector if each of its corners moves by at most `moved`, m^2.
inline double area_error(double longest_side, double moved) { return 2.0 * moved * (longest_side + moved); }
inline double longest_side(const Point& a, const Point& b, const Point& c) { return std::max({distance(a, b), distance(b, c), distance(c, a)}); }

/// A face between two columns: side `corner` of `column` in layer `layer`; `other` is the column behind the face.
struct ColumnSide {
  std::size_t column = 0;
  std::size_t corner = 0;
  std::size_t other = 0;
  int layer = 0;
};

class GivenLayer {
 public:
  explicit GivenLayer(Borrowed<const HybridMesh> mesh);

  /// Returns a proof for G5. Where the layer is thin, the dual faces across a line are parallel to the sum of the facets at its base, and no line that sees
  /// all facets comes close to the normal of that sum.
  std::optional<Forcing> orthogonality(NodeId node, double limit) const;
  /// Returns a proof for OpenFOAM's face weight. Where the layer is thin, the distances of cell centres from a side equal the extents of the wall triangles
  /// from their common edge.
  std::optional<Forcing> face_weight(const ColumnSide& side, double limit) const;
  /// Returns a proof for OpenFOAM's volume ratio, from the areas of the wall triangles.
  std::optional<Forcing> volume_ratio(const ColumnSide& side, double limit) const;
  /// Returns a proof for OpenFOAM's skewness at sharp edges: searches all directions of the edge's two lines by intervals.
  std::optional<Forcing> skewness(const ColumnSide& side, double limit) const;
  /// Returns a proof for the skewness of an edge for which the search is inconclusive. Assume one line on each node, in the direction that sees the facets
  /// best. As long as the layer is thin, the skewness at a sharp edge then follows from the two wall triangles. A side whose `value` is equal or better is
  /// forced by these triangles.
  std::optional<Forcing> skewness_of_edge(const ColumnSide& side, double limit, double value) const;
  /// Returns a proof for G9. No last cell is higher than the growth ratio of the request permits, nor higher than its share of the room in a gap.
  /// `gaps`: height along the wall normal that a gap permits each line, m; infinite if no gap limits the line; may be empty.
  std::optional<Forcing> interface_height(std::size_t column, std::span<const double> gaps, double limit) const;

 private:
  struct Pair;
  struct Room;
  struct Wedge;
  /// Returns the two lines of the edge, then the opposite line in the column and the opposite line in the other column.
  std::array<std::uint32_t, 4> lines_of(const ColumnSide& side) const;
  std::optional<Pair> pair_of(const ColumnSide& side) const;
  std::optional<Room> room_of(std::uint32_t line, double gap) const;
  const Point& base_point(std::uint32_t line) const { return mesh_.points[mesh_.layers.node(line, 0)]; }
  double step(std::uint32_t line, int layer) const;
  double length(std::uint32_t line, int layer) const;
  /// Returns the normals of the facets at the line's base, including their images behind symmetry planes.
  std::vector<Vec3> normals_around(std::uint32_t line) const;
  bool is_closed(std::uint32_t line) const;
  /// Returns true if the cells on both sides are prisms.
  bool is_between_prisms(const ColumnSide& side) const {
    return side.layer < mesh_.layers.ends_of_column(side.column)[0] && side.layer < mesh_.layers.ends_of_column(side.other)[0];
  }

  const HybridMesh& mesh_;
  dual_parts::LineRings rings_;
  MirrorNormals mirror_normals_;
  std::vector<std::pair<std::uint32_t, std::uint32_t>> line_at_;  ///< first node and line, ascending
};

}  // namespace sterna::check_parts
