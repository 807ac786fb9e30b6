// The height that the geometry itself permits a growth line of a layer. It is limited by opposing walls, and by the directions that see all facets of a corner.
#pragma once

#include <array>
#include <cstdint>
#include <optional>
#include <vector>

#include "geom/base/run_context.h"
#include "geom/mesh/bvh.h"

namespace sterna {

/// Fraction of the target height that counts as reached (docs/method/envelope.md, "Heights").
inline constexpr double k_full_height_share = 0.9;
/// Room for tets between two layers, as a fraction of the longer local envelope edge; tets there have angles of some 15 degrees. At most k_kept_share of the
/// gap is reserved; the layers get the rest. This is the room that the envelope reserves (docs/method/envelope.md, "Room for tetrahedra").
inline constexpr double k_kept_edges = 0.3;
inline constexpr double k_kept_share = 0.5;

/// A boundary triangle that may be opposite to a growth line.
struct FacingTriangle {
  std::array<Point, 3> corners;               ///< right-hand normal into the fluid
  std::array<std::uint32_t, 3> base_lines{};  ///< lines on its corners, or k_no_line
  double requested = 0.0;  ///< m, largest requested height at the corners of the triangle; 0 if it carries no layer, and then its orientation is ignored
  double edge = 0.0;       ///< m, mean edge of the envelope above it
  static constexpr std::uint32_t k_no_line = 0xffffffffu;
};

/// Properties of a growth line that determine its room.
struct RoomRequest {
  std::uint32_t line = 0;
  Point base_point;
  Vec3 normal;              ///< unit, wall normal at the base vertex
  double target = 0.0;      ///< m, requested height
  double edge = 0.0;        ///< m, mean edge of the envelope at the line
  double visibility = 1.0;  ///< cosine between the direction with the best view of all facets at the base and the facet with the worst view
};

/// The boundary around the layers. Queries are per line and thread-safe.
class LayerRoom {
 public:
  LayerRoom(std::vector<FacingTriangle> boundary, const RunContext& context);

  /// Returns the height along the wall normal that the geometry permits, m; at most the target.
  /// In a gap, the normal meets a wall that faces it within 45 degrees at distance g. If both layers do not fit into g minus the room reserved by the envelope,
  /// the remaining height is divided in proportion to their targets: equal layers get half each.
  /// At a corner, a line as long as the target reaches only target * visibility on the worst facet, whatever its direction; this counts as full height there.
  double permitted(const RoomRequest& line) const { return permitted(line, in_gap(line)); }
  /// The same for a line with a known result of in_gap().
  static double permitted(const RoomRequest& line, double in_gap);
  /// Returns the height along the wall normal that an opposing wall permits the line, m; infinite if no wall limits it.
  double in_gap(const RoomRequest& line) const;

 private:
  struct Hit {
    double gap;
    std::uint32_t triangle;
    double cosine;
  };
  std::optional<Hit> nearest_opposite(const RoomRequest& line) const;

  std::vector<FacingTriangle> boundary_;
  double most_requested_ = 0.0;  ///< m
  BoxTree tree_;
};

}  // namespace sterna
