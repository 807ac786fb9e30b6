// How much height the geometry itself permits a line of a layer: what opposing walls leave it, and what one direction can reach on all facets of a corner.
#pragma once

#include <array>
#include <cstdint>
#include <optional>
#include <vector>

#include "geom/base/run_context.h"
#include "geom/mesh/bvh.h"

namespace sterna {

/// Share of a height that counts as reached (docs/method/envelope.md, "Heights").
inline constexpr double k_full_height_share = 0.9;
/// Of the longer local envelope edge stays between two layers, for tets, which reach some 15 degrees there; at most k_kept_share of the gap, the rest is for
/// the layers. What the envelope keeps to itself (docs/method/envelope.md, "Room for tetrahedra").
inline constexpr double k_kept_edges = 0.3;
inline constexpr double k_kept_share = 0.5;

/// A triangle of the boundary that may stand opposite to a line.
struct FacingTriangle {
  std::array<Point, 3> corners;         ///< right-hand normal into the fluid
  std::array<std::uint32_t, 3> feet{};  ///< lines on its corners, or k_no_foot
  double asked = 0.0;                   ///< m, largest height asked for at its corners; 0: it carries no layer, and its sense does not count
  double edge = 0.0;                    ///< m, mean edge of the envelope above it
  static constexpr std::uint32_t k_no_foot = 0xffffffffu;
};

/// A line of the layer, as far as its room depends on it.
struct RoomRequest {
  std::uint32_t line = 0;
  Point foot;
  Vec3 normal;              ///< unit, of the wall at the foot
  double target = 0.0;      ///< m, height asked for
  double edge = 0.0;        ///< m, mean edge of the envelope at the line
  double visibility = 1.0;  ///< cosine between the direction that sees the facets at the foot best and the facet that it sees worst
};

/// The boundary around the layers, to be asked line by line from any thread.
class LayerRoom {
 public:
  LayerRoom(std::vector<FacingTriangle> boundary, const RunContext& context);

  /// Height along the wall's normal that the geometry permits, m; at most the target.
  /// Gap: where the normal meets a wall that faces it within 45 degrees at distance g, and both layers do not fit into g less what the envelope keeps to
  /// itself, each gets what is left in proportion to what it asks for: equal layers half of it. Corner: a line as long as the target reaches target *
  /// visibility on the worst facet, whatever its direction; that counts as full there.
  double permitted(const RoomRequest& line) const { return permitted(line, in_gap(line)); }
  /// The same, of a line that in_gap() was asked for.
  static double permitted(const RoomRequest& line, double in_gap);
  /// Height along the wall's normal that an opposing wall leaves the line, m; infinite where none limits it.
  double in_gap(const RoomRequest& line) const;

 private:
  struct Hit {
    double gap;
    std::uint32_t triangle;
    double cosine;
  };
  std::optional<Hit> nearest_opposite(const RoomRequest& line) const;

  std::vector<FacingTriangle> boundary_;
  double most_asked_ = 0.0;  ///< m
  BoxTree tree_;
};

}  // namespace sterna
