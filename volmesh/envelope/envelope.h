// The second surface that bounds the layer: same connectivity as the wall, one growth direction and one height per vertex.
#pragma once

#include <cstdint>
#include <string_view>
#include <vector>

#include "geom/base/ids.h"
#include "geom/base/vec3.h"
#include "volmesh/envelope/layer_base.h"
#include "volmesh/envelope/options.h"

namespace sterna::volmesh {

/// Why a vertex has less than its target height; the reason of the strongest limit.
enum class HeightLimit : std::uint8_t { none, untangle, warp, gap, collision, prism, invisible, fixed };
inline constexpr std::size_t k_height_limits = 8;
std::string_view to_string(HeightLimit limit);

/// Where the envelope is; what a proposal consists of.
struct EnvelopeShape {
  Column<VertexId, Vec3> direction;          ///< unit growth direction
  Column<VertexId, double> height;           ///< m along the direction; 0 = collapsed

  bool is_collapsed(VertexId v) const { return height[v] == 0.0; }
  Point point(const TriMesh& wall, VertexId v) const { return wall.points[v] + height[v] * direction[v]; }
};

struct Envelope : EnvelopeShape {
  Column<VertexId, double> target;           ///< m, h_target of method.md §2
  Column<VertexId, double> eq1;              ///< m, height by eq. (1) without caps
  Column<VertexId, double> cap;              ///< m, largest height that the stages so far allow (starts as target)
  Column<VertexId, HeightLimit> limit;
};

/// Derived numbers that every step needs.
struct EnvelopeScale {
  double h0;         ///< m, first height
  int n;             ///< layers
  double h_min;      ///< m, 0.2 n h0: below it a vertex collapses (method.md §4)
};
EnvelopeScale scale_of(const EnvelopeOptions& options);

/// Lowers a height (never raises), remembers why, and collapses below h_min.
void lower(Envelope& envelope, VertexId v, double height, HeightLimit reason, const EnvelopeScale& scale);

}  // namespace sterna::volmesh
