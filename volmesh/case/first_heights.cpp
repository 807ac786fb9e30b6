#include "volmesh/case/first_heights.h"

#include <algorithm>
#include <array>
#include <cmath>

#include "geom/base/error.h"
#include "geom/base/number_text.h"
#include "geom/mesh/bvh.h"

namespace sterna::volmesh {
namespace {

constexpr int k_height_digits = 4;

/// Returns the barycentric coordinates of a point in the triangle's plane. For a triangle without area they are those of the first corner.
std::array<double, 3> weights_of(const std::array<Point, 3>& t, const Point& p) {
  const Vec3 u = t[1] - t[0], v = t[2] - t[0], w = p - t[0];
  const Vec3 normal = cross(u, v);
  const double n2 = norm2(normal);
  if (!(n2 > 0.0)) return {1.0, 0.0, 0.0};
  const double b = std::clamp(dot(cross(w, v), normal) / n2, 0.0, 1.0), c = std::clamp(dot(cross(u, w), normal) / n2, 0.0, 1.0 - b);
  return {1.0 - b - c, b, c};
}

}  // namespace

FirstHeights::FirstHeights(const TriMesh& surface, std::vector<double> heights, const RunContext& context) : surface_(surface), heights_(std::move(heights)) {
  if (heights_.size() != surface_.n_vertices() || heights_.empty())
    throw Error({.code = ErrorCode::internal,
                 .attempted = "setting first heights by location",
                 .problem = std::to_string(heights_.size()) + " heights for " + std::to_string(surface_.n_vertices()) + " vertices"});
  std::vector<ErrorLocation> wrong;
  for (const VertexId v : surface_.points.ids()) {
    const double height = heights_[v.index()];
    if (std::isfinite(height) && height >= k_least_first_height) continue;
    if (wrong.size() < k_max_locations) wrong.push_back({surface_.points[v], "first height " + in_metres(height, k_height_digits)});
  }
  if (!wrong.empty())
    throw Error({.code = ErrorCode::bad_argument,
                 .attempted = "setting first heights by location",
                 .problem = "the function first_height returns values that are not heights of " + in_metres(k_least_first_height, k_height_digits) + " or more",
                 .locations = std::move(wrong),
                 .hint = "the function is called at every vertex of the surface, also on patches without layers"});
  const auto [least, greatest] = std::minmax_element(heights_.begin(), heights_.end());
  least_ = *least;
  greatest_ = *greatest;
  tree_ = std::make_unique<const TriangleTree>(surface_, context);
}

FirstHeights::~FirstHeights() = default;

double FirstHeights::at(const Point& p) const {
  const NearestHit hit = tree_->nearest(p);
  const TriangleVertices& corners = surface_.triangles[hit.triangle];
  const std::array<Point, 3> points = {surface_.points[corners[0]], surface_.points[corners[1]], surface_.points[corners[2]]};
  const auto height = [&](std::size_t k) { return heights_[corners[k].index()]; };
  for (std::size_t k = 0; k < 3; ++k)
    if (points[k] == p) return height(k);
  const std::array<double, 3> weights = weights_of(points, hit.point);
  return std::exp(weights[0] * std::log(height(0)) + weights[1] * std::log(height(1)) + weights[2] * std::log(height(2)));
}

std::shared_ptr<const FirstHeights> FirstHeights::refined(double factor, const RunContext& context) const {
  std::vector<double> heights = heights_;
  for (double& height : heights) height /= factor;
  return std::make_shared<const FirstHeights>(surface_, std::move(heights), context);
}

}  // namespace sterna::volmesh
