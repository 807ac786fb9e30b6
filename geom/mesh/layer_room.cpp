#include "geom/mesh/layer_room.h"

#include <algorithm>
#include <cmath>

#include "geom/math/constants.h"

namespace sterna {
namespace {

/// Walls that face the line within 45 degrees oppose it, as in the gap search of the envelope.
constexpr double k_opposing_cosine = 0.7;

std::vector<Box> facing_boxes(const std::vector<FacingTriangle>& boundary) {
  std::vector<Box> boxes(boundary.size());
  for (std::size_t i = 0; i < boundary.size(); ++i)
    for (const Point& p : boundary[i].corners) boxes[i].add(p);
  return boxes;
}

/// Returns the distance along the unit direction d from p to the triangle with normal `normal` (of any length), or a negative number. Rounding is irrelevant
/// here, since the result is used only as a length.
double distance_along(const Point& p, const Vec3& d, const std::array<Point, 3>& t, const Vec3& normal) {
  const double slope = dot(d, normal);
  if (slope == 0.0) return -1.0;
  const double s = dot(t[0] - p, normal) / slope;
  const Point hit = p + s * d;
  for (std::size_t k = 0; k < 3; ++k)
    if (dot(cross(t[(k + 1) % 3] - t[k], hit - t[k]), normal) < 0.0) return -1.0;
  return s;
}

}  // namespace

LayerRoom::LayerRoom(std::vector<FacingTriangle> boundary, const RunContext& context)
    : boundary_(std::move(boundary)), tree_(facing_boxes(boundary_), context) {
  for (const FacingTriangle& t : boundary_) most_requested_ = std::max(most_requested_, t.requested);
}

std::optional<LayerRoom::Hit> LayerRoom::nearest_opposite(const RoomRequest& line) const {
  // A wall farther away than both heights and the reserved part of a gap (at most half of it) leaves room for any requested height.
  const double reach = (line.target + most_requested_ / k_opposing_cosine) / k_kept_share;
  Box box;
  box.add(line.base_point);
  box.add(line.base_point + reach * line.normal);
  std::optional<Hit> nearest;
  tree_.for_each_overlap(box, [&](std::uint32_t i) {
    const FacingTriangle& t = boundary_[i];
    if (std::find(t.base_lines.begin(), t.base_lines.end(), line.line) != t.base_lines.end()) return true;
    const Vec3 normal = cross(t.corners[1] - t.corners[0], t.corners[2] - t.corners[0]);
    const double along = dot(normal, line.normal) / norm(normal);
    const double cosine = t.requested > 0.0 ? -along : std::abs(along);
    if (!(cosine >= k_opposing_cosine)) return true;
    const double gap = distance_along(line.base_point, line.normal, t.corners, normal);
    if (gap > 0.0 && (!nearest || gap < nearest->gap || (gap == nearest->gap && i < nearest->triangle))) nearest = Hit{gap, i, cosine};
    return true;
  });
  return nearest;
}

double LayerRoom::in_gap(const RoomRequest& line) const {
  const std::optional<Hit> hit = nearest_opposite(line);
  if (!hit) return k_infinity;
  const FacingTriangle& opposite = boundary_[hit->triangle];
  const double kept = std::min(k_kept_edges * std::max(line.edge, opposite.edge) / hit->cosine, k_kept_share * hit->gap);
  const double share = (hit->gap - kept) / (line.target + opposite.requested / hit->cosine);
  return share < 1.0 ? line.target * share : k_infinity;
}

double LayerRoom::permitted(const RoomRequest& line, double in_gap) {
  return std::min(line.target * std::clamp(line.visibility / k_full_height_share, 0.0, 1.0), in_gap);
}

}  // namespace sterna
