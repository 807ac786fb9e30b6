// A circular cylinder. Its two rings consist of straight edges. The ends are filled as polygons. The side is unrolled to a rectangle between the rings and a
// seam, filled, and rolled up.
#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>
#include <string>

#include "geom/base/error.h"
#include "geom/base/number_text.h"
#include "volmesh/domain/farfield.h"
#include "volmesh/domain/fill_polygon.h"
#include "volmesh/domain/shape_sizes.h"

namespace sterna::volmesh {
namespace {

constexpr const char* k_cylinder_attempt = "making the farfield cylinder";
constexpr double k_two_pi = 2.0 * std::numbers::pi;

struct CylinderSize {
  Point from;
  Vec3 axis, e1, e2;  ///< unit vectors, right-handed
  double length = 0.0, radius = 0.0;
  double start = 0.0, end = 0.0, side = 0.0;  ///< target edge lengths, m
  int n_start = 0, n_end = 0;                 ///< numbers of ring edges; multiples of four, so that there are vertices in both planes through the axis
};

int ring_pieces(double radius, double edge) { return 4 * std::max(2, pieces(k_two_pi * radius / 4.0, edge)); }

CylinderSize size_of_cylinder(const TriMesh& wall, const FarfieldOptions& options, std::span<const EndPlane> ends) {
  CylinderSize size;
  Point center = bounding_box(wall).center();
  for (const EndPlane& end : ends)
    if (end.axis != 0) center[end.axis] = end.at;
  const double reach = k_default_radius * body_length(wall);
  const std::array given_from = {options.farfield_from_x, options.farfield_from_y, options.farfield_from_z},
                   given_to = {options.farfield_to_x, options.farfield_to_y, options.farfield_to_z};
  size.from = center - Vec3{reach, 0, 0};
  Point to = center + Vec3{reach, 0, 0};
  for (std::size_t k = 0; k < 3; ++k) {
    if (!is_automatic(given_from[k])) size.from[k] = given_from[k];
    if (!is_automatic(given_to[k])) to[k] = given_to[k];
  }
  size.length = distance(size.from, to);
  if (!(size.length > 0.0))
    throw Error({.code = ErrorCode::bad_argument,
                 .attempted = k_cylinder_attempt,
                 .problem = "both ends of the cylinder are at " + format_point(to),
                 .hint = "give different farfield_from and farfield_to"});
  size.axis = (to - size.from) / size.length;
  // The coordinate axis that follows the steepest one cyclically is used: y for a cylinder along x.
  std::size_t steepest = 0;
  for (std::size_t k = 1; k < 3; ++k)
    if (std::abs(size.axis[k]) > std::abs(size.axis[steepest])) steepest = k;
  Vec3 across;
  across[(steepest + 1) % 3] = 1.0;
  size.e1 = normalized(across - dot(across, size.axis) * size.axis);
  size.e2 = cross(size.axis, size.e1);
  size.radius = is_automatic(options.farfield_radius) ? k_default_radius * body_length(wall) : options.farfield_radius;
  const double common = common_edge(options.farfield_edge, k_default_edge * size.radius);
  size.start = edge_of_side(options.farfield_sides, "start", common);
  size.end = edge_of_side(options.farfield_sides, "end", common);
  size.side = edge_of_side(options.farfield_sides, "side", common);
  size.n_start = ring_pieces(size.radius, std::min(size.start, size.side));
  size.n_end = ring_pieces(size.radius, std::min(size.end, size.side));
  return size;
}

void check_encloses(const TriMesh& wall, const CylinderSize& size) {
  const double margin = k_shape_margin * body_length(wall);
  const double inner = size.radius * std::cos(std::numbers::pi / std::min(size.n_start, size.n_end));
  ErrorInfo info{
      .code = ErrorCode::bad_argument, .attempted = k_cylinder_attempt, .hint = "raise farfield_radius, or move farfield_from and farfield_to apart"};
  const auto require = [&](const std::string& what, const auto& needed, double given) {
    const Point farthest = *std::max_element(wall.points.begin(), wall.points.end(), [&](const Point& p, const Point& q) { return needed(p) < needed(q); });
    if (needed(farthest) + margin <= given) return;
    info.problem += (info.problem.empty() ? "" : "; ") + what + " is " + in_metres(given) + ", but the wall and a margin of 0.02 body lengths need " +
                    in_metres(needed(farthest) + margin);
    info.locations.push_back({farthest, "farthest point of the wall"});
  };
  require(
      "radius inside the flat triangles of the side", [&](const Point& p) { return norm((p - size.from) - dot(p - size.from, size.axis) * size.axis); }, inner);
  require(
      "length before the start of the cylinder", [&](const Point& p) { return -dot(p - size.from, size.axis); }, 0.0);
  require(
      "length from start to end of the cylinder", [&](const Point& p) { return dot(p - size.from, size.axis); }, size.length);
  if (!info.locations.empty()) throw Error(std::move(info));
}

class CylinderMesh {
 public:
  CylinderMesh(const CylinderSize& size, const RunContext& context) : size_(size) {
    const std::vector<VertexId> start = make_ring(size.n_start, 0.0), end = make_ring(size.n_end, size.length);
    fill_end("start", start, 0.0, size.start, context);
    fill_end("end", end, size.length, size.end, context);
    fill_side(start, end, context);
  }
  TriMesh take() { return std::move(mesh_); }

 private:
  Point on_side(double angle, double along) const {
    return size_.from + along * size_.axis + size_.radius * (std::cos(angle) * size_.e1 + std::sin(angle) * size_.e2);
  }
  std::vector<VertexId> make_ring(int n, double along) {
    std::vector<VertexId> ring;
    for (int i = 0; i < n; ++i) ring.push_back(mesh_.points.push_back(on_side(k_two_pi * i / n, along)));
    return ring;
  }
  void fill_end(const char* name, const std::vector<VertexId>& ring, double along, double target, const RunContext& context) {
    const auto n = static_cast<double>(ring.size());
    const double spacing = 2.0 * size_.radius * std::sin(std::numbers::pi / n), inner = size_.radius * std::cos(std::numbers::pi / n);
    std::vector<Vec2> polygon;
    for (std::size_t i = 0; i < ring.size(); ++i)
      polygon.push_back({size_.radius * std::cos(k_two_pi * static_cast<double>(i) / n), size_.radius * std::sin(k_two_pi * static_cast<double>(i) / n)});
    const PolygonFill fill = fill_polygon(
        polygon,
        [&](const Vec2& p) {
          const double from_border = inner - std::hypot(p.x, p.y);
          return LocalSize{std::min(target, spacing + k_edge_growth * std::max(0.0, from_border)), from_border};
        },
        context);
    std::vector<VertexId> vertices = ring;
    for (std::size_t i = ring.size(); i < fill.points.size(); ++i)
      vertices.push_back(mesh_.points.push_back(size_.from + along * size_.axis + fill.points[i].x * size_.e1 + fill.points[i].y * size_.e2));
    add_patch(mesh_, name, fill.triangles, vertices, along > 0.0);
  }
  /// Fills the unrolled side, with x along the axis and y along the ring. The right-hand normal points towards the axis.
  void fill_side(const std::vector<VertexId>& start, const std::vector<VertexId>& end, const RunContext& context) {
    const double width = k_two_pi * size_.radius;
    const int n_seam = pieces(size_.length, size_.side);
    std::vector<VertexId> seam;
    for (int i = 1; i < n_seam; ++i) seam.push_back(mesh_.points.push_back(on_side(0.0, size_.length * i / n_seam)));
    std::vector<Vec2> polygon;
    std::vector<VertexId> vertices;
    const auto add = [&](double x, double y, VertexId v) {
      polygon.push_back({x, y});
      vertices.push_back(v);
    };
    const auto at_seam = [&](std::size_t i) { return size_.length * static_cast<double>(i + 1) / n_seam; };
    add(0.0, 0.0, start[0]);
    for (std::size_t i = 0; i < seam.size(); ++i) add(at_seam(i), 0.0, seam[i]);
    for (std::size_t i = 0; i < end.size(); ++i) add(size_.length, width * static_cast<double>(i) / static_cast<double>(end.size()), end[i]);
    add(size_.length, width, end[0]);
    for (std::size_t i = seam.size(); i-- > 0;) add(at_seam(i), width, seam[i]);
    add(0.0, width, start[0]);
    for (std::size_t i = start.size(); i-- > 1;) add(0.0, width * static_cast<double>(i) / static_cast<double>(start.size()), start[i]);
    const double first = width / static_cast<double>(start.size()), last = width / static_cast<double>(end.size());
    const PolygonFill fill = fill_polygon(
        polygon,
        [&](const Vec2& p) {
          const double edge = std::min({size_.side, first + k_edge_growth * std::max(0.0, p.x), last + k_edge_growth * std::max(0.0, size_.length - p.x)});
          return LocalSize{edge, std::min({p.x, size_.length - p.x, p.y, width - p.y})};
        },
        context);
    for (std::size_t i = polygon.size(); i < fill.points.size(); ++i)
      vertices.push_back(mesh_.points.push_back(on_side(fill.points[i].y / size_.radius, fill.points[i].x)));
    add_patch(mesh_, "side", fill.triangles, vertices, false);
  }

  const CylinderSize& size_;
  TriMesh mesh_;
};

}  // namespace

TriMesh farfield_cylinder(const TriMesh& wall, const FarfieldOptions& options, std::span<const EndPlane> ends, const RunContext& context) {
  const CylinderSize size = size_of_cylinder(wall, options, ends);
  const double disc = std::numbers::pi * size.radius * size.radius;
  require_affordable(triangles_of(disc, size.start) + triangles_of(disc, size.end) + triangles_of(k_two_pi * size.radius * size.length, size.side),
                     k_cylinder_attempt);
  check_encloses(wall, size);
  return CylinderMesh(size, context).take();
}

}  // namespace sterna::volmesh
