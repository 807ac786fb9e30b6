#include "volmesh/adjacent/adjacent_chart.h"

#include <algorithm>
#include <cmath>

#include "geom/base/error.h"
#include "geom/base/number_text.h"
#include "geom/math/measures.h"
#include "geom/mesh/bvh.h"
#include "volmesh/adjacent/adjacent_errors.h"

namespace sterna::volmesh {
namespace {

/// Fraction of the region's size: points of loops farther from a plane are an error. (The symmetry gate itself has a limit of 1e-12 of the body length.)
constexpr double k_on_plane = 1e-9;
/// Fraction of the largest coordinate: an original whose points are nearer than this to one plane is flat. It corresponds to sixteen rounding errors of a
/// coordinate.
constexpr double k_flat = 16.0 * 2.220446049250313e-16;
/// Largest number of steps of Newton's method for the height. Convergence is quadratic on smooth surfaces; on triangles one step is sufficient.
constexpr int k_max_steps = 12;
/// Tolerance of a height, as a fraction of the size of the projected piece.
constexpr double k_height_tolerance = 1e-14;

double largest_coordinate(const Box& box) {
  double largest = 0.0;
  for (std::size_t k = 0; k < 3; ++k) largest = std::max({largest, std::abs(box.min[k]), std::abs(box.max[k])});
  return largest;
}

std::optional<std::size_t> axis_of(const Vec3& n) {
  for (std::size_t k = 0; k < 3; ++k)
    if (std::abs(n[k]) == 1.0 && n[(k + 1) % 3] == 0.0 && n[(k + 2) % 3] == 0.0) return k;
  return std::nullopt;
}

/// Returns the points that edges use, in the order of the edges.
std::vector<Point> loop_points(const AdjacentRegion& region) {
  std::vector<Point> points;
  points.reserve(region.edges.size());
  for (const auto& edge : region.edges) points.push_back(region.points[edge[0]]);
  return points;
}

double median(std::vector<double> values) {
  const auto middle = values.begin() + static_cast<std::ptrdiff_t>(values.size() / 2);
  std::nth_element(values.begin(), middle, values.end());
  return *middle;
}

/// Returns the frame of a plane with this normal. The plane passes through the median height of the loops' points.
AdjacentFrame frame_through(const Vec3& normal, const std::vector<Point>& points) {
  Box box;
  for (const Point& p : points) box.add(p);
  std::vector<double> heights;
  heights.reserve(points.size());
  if (const auto axis = axis_of(normal)) {
    for (const Point& p : points) heights.push_back(p[*axis]);
    Point origin{};
    origin[*axis] = median(std::move(heights));
    return adjacent_frame_along(normal, origin);
  }
  const Point centre = box.center();
  for (const Point& p : points) heights.push_back(dot(normal, p - centre));
  return adjacent_frame_along(normal, centre + median(std::move(heights)) * normal);
}

/// Returns the normal of an original that is flat except for rounding. It is exactly along a coordinate axis if the original is normal to that axis. Empty if
/// the original is not flat.
std::optional<Vec3> flat_normal(const TriMesh& original) {
  Vec3 area{};
  for (const TriangleId t : original.triangles.ids()) {
    const auto [a, b, c] = corners(original, t);
    area += area_vector(a, b, c);
  }
  if (norm2(area) == 0.0) return std::nullopt;
  const Box box = bounding_box(original);
  const double tolerance = k_flat * largest_coordinate(box);
  for (std::size_t k = 0; k < 3; ++k)
    if (box.max[k] - box.min[k] <= tolerance) {
      Vec3 normal{};
      normal[k] = std::copysign(1.0, area[k]);
      return normal;
    }
  const Vec3 normal = normalized(area);
  const Point centre = box.center();
  for (const TriangleVertices& triangle : original.triangles)
    for (const VertexId v : triangle)
      if (std::abs(dot(original.points[v] - centre, normal) - dot(original.points[original.triangles[TriangleId(0u)][0]] - centre, normal)) > tolerance)
        return std::nullopt;
  return normal;
}

class PlanePiece final : public Surface {
 public:
  PlanePiece(const AdjacentFrame& frame, const ParameterBox& box) : frame_(frame), box_(box) {}
  ParameterBox domain() const override { return box_; }
  Point point(Uv at) const override { return frame_.origin + at.u * frame_.x + at.v * frame_.y; }
  SurfaceDerivatives derivatives(Uv at) const override { return {point(at), frame_.x, frame_.y, {}, {}, {}}; }
  std::string kind() const override { return "plane of an end surface"; }

 private:
  AdjacentFrame frame_;
  ParameterBox box_;
};

class ProjectedPiece final : public Surface {
 public:
  ProjectedPiece(const AdjacentFrame& frame, const ParameterBox& box, const ConstraintSurface& surface, const TriMesh& flat,
                 std::vector<std::array<double, 3>> heights, const RunContext& context)
      : frame_(frame), box_(box), surface_(surface), flat_(flat, context), corners_(flat.n_triangles()), heights_(std::move(heights)) {
    for (const TriangleId t : flat.triangles.ids()) corners_[t] = corners(flat, t);
    tolerance_ = k_height_tolerance * std::max(bounding_box(flat).longest_side(), largest_coordinate(bounding_box(flat)));
  }
  ParameterBox domain() const override { return box_; }
  Point point(Uv at) const override { return derivatives(at).point; }
  SurfaceDerivatives derivatives(Uv at) const override {
    double height = guess(at);
    Point p;
    Vec3 normal;
    for (int step = 0; step < k_max_steps; ++step) {
      p = frame_.origin + at.u * frame_.x + at.v * frame_.y + height * frame_.normal;
      normal = surface_.normal(p);
      const double off = dot(surface_.closest(p) - p, normal), steepness = dot(normal, frame_.normal);
      // If the surface is steeper than the projection allows, it is not the surface of the original, and the guess cannot be improved.
      if (std::abs(off) <= tolerance_ || !(steepness > k_least_steepness)) break;
      height += off / steepness;
    }
    SurfaceDerivatives d;
    d.point = p;
    const double steepness = std::max(dot(normal, frame_.normal), k_least_steepness);
    d.du = frame_.x - (dot(normal, frame_.x) / steepness) * frame_.normal;
    d.dv = frame_.y - (dot(normal, frame_.y) / steepness) * frame_.normal;
    return d;
  }
  std::string kind() const override { return "projection of an end surface"; }

 private:
  /// Cosine of 80 degrees; pieces have angles of up to 70 degrees.
  static constexpr double k_least_steepness = 0.17;

  /// Returns the height of the original over the location, which is linear within its triangles.
  double guess(Uv at) const {
    const Point location{at.u, at.v, 0.0};
    const NearestHit hit = flat_.nearest(location);
    const auto& [a, b, c] = corners_[hit.triangle];
    const auto& h = heights_[hit.triangle.index()];
    const double area = area_vector(a, b, c).z;
    if (!(area > 0.0)) return h[0];
    const double s = area_vector(hit.point, b, c).z / area, t = area_vector(a, hit.point, c).z / area;
    return s * h[0] + t * h[1] + (1.0 - s - t) * h[2];
  }

  AdjacentFrame frame_;
  ParameterBox box_;
  const ConstraintSurface& surface_;
  TriangleTree flat_;
  Column<TriangleId, std::array<Point, 3>> corners_;
  std::vector<std::array<double, 3>> heights_;
  double tolerance_ = 0.0;
};

}  // namespace

AdjacentFrame adjacent_frame_along(const Vec3& normal, const Point& origin) {
  if (const auto axis = axis_of(normal)) {
    Vec3 x{}, y{};
    x[(*axis + 1) % 3] = 1.0;
    y[(*axis + 2) % 3] = 1.0;
    if (normal[*axis] < 0.0) std::swap(x, y);
    return {origin, x, y, normal};
  }
  // Orthonormal basis without a branch on near-parallel axes (Duff et al. 2017, Building an orthonormal basis, revisited).
  const double sign = std::copysign(1.0, normal.z);
  const double a = -1.0 / (sign + normal.z);
  const double b = normal.x * normal.y * a;
  return {origin, {1.0 + sign * normal.x * normal.x * a, sign * b, -sign * normal.x}, {b, sign + normal.y * normal.y * a, -normal.y}, normal};
}

std::optional<AdjacentFrame> plane_of(const AdjacentRegion& region) {
  const std::vector<Point> points = loop_points(region);
  Box box;
  for (const Point& p : points) box.add(p);
  if (dynamic_cast<const ConstraintPlane*>(region.surface) == nullptr) {
    if (region.original == nullptr)
      throw Error(adjacent_error(region, ErrorCode::bad_argument, "the surface is curved, but the patch as it was given (original) is missing"));
    const std::optional<Vec3> normal = flat_normal(*region.original);
    if (!normal) return std::nullopt;
    const AdjacentFrame frame = frame_through(*normal, points);
    for (const Point& p : points)
      if (std::abs(frame.height(p)) > k_on_plane * box.longest_side()) return std::nullopt;
    return frame;
  }
  const AdjacentFrame frame = frame_through(region.surface->normal(points.front()), points);
  ErrorInfo info = adjacent_error(region, ErrorCode::bad_argument, "points of the loops are not in the plane");
  for (const Point& p : points)
    if (const double off = region.surface->inside_distance(p); std::abs(off) > k_on_plane * box.longest_side())
      info.add_location(
          p, in_metres(off, k_adjacent_digits) + " from the plane; at most " + in_metres(k_on_plane * box.longest_side(), k_adjacent_digits) + " are allowed");
  if (info.n_locations > 0) throw Error(std::move(info));
  return frame;
}

SurfacePtr plane_surface(const AdjacentFrame& frame, const ParameterBox& box) { return std::make_shared<PlanePiece>(frame, box); }

SurfacePtr projected_surface(const AdjacentFrame& frame, const ParameterBox& box, Borrowed<const ConstraintSurface> surface, const TriMesh& original,
                             std::span<const TriangleId> triangles, const RunContext& context) {
  TriMesh flat;
  std::vector<std::array<double, 3>> heights;
  for (const TriangleId t : triangles) {
    TriangleVertices corner;
    std::array<double, 3> height{};
    for (std::size_t k = 0; k < 3; ++k) {
      const Point& p = original.points[original.triangles[t][k]];
      const Uv at = frame.location(p);
      corner[k] = flat.points.push_back({at.u, at.v, 0.0});
      height[k] = frame.height(p);
    }
    flat.triangles.push_back(corner);
    heights.push_back(height);
  }
  return std::make_shared<ProjectedPiece>(frame, box, surface, flat, std::move(heights), context);
}

}  // namespace sterna::volmesh
