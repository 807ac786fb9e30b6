#include "geom/delaunay/surface_triangulation.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "geom/base/error.h"
#include "geom/delaunay/planar.h"

namespace sterna::delaunay {
namespace {

constexpr const char* k_border_attempt = "triangulating the border of a face";

/// Converts an error of the plane to one with its location in space, interpolated along the segments that it names.
[[noreturn]] void throw_in_space(const Error& error, const SurfaceBorder& border, Vec2 scale) {
  ErrorInfo info = error.info();
  info.attempted = k_border_attempt;
  for (ErrorLocation& location : info.locations) {
    const Vec2 at{location.position.x, location.position.y};
    std::size_t nearest = 0;
    double best = std::numeric_limits<double>::infinity();
    for (std::size_t i = 0; i < border.uv.size(); ++i) {
      const double distance = std::hypot(border.uv[i].u * scale.x - at.x, border.uv[i].v * scale.y - at.y);
      if (distance < best) {
        best = distance;
        nearest = i;
      }
    }
    location.what = "near this point of the border, at (u, v) = (" + std::to_string(at.x / scale.x) + ", " + std::to_string(at.y / scale.y) + ")";
    location.position = border.samples[nearest].point;
  }
  info.geometry = {};
  throw Error(std::move(info));
}

/// Checks that every segment of a loop is an edge of the domain's border. Where two borders touch along a line, or a vertex lies on another segment, it is not,
/// and the neighbouring face would not match.
void check_segments(const Triangulation& mesh, const std::vector<Segment>& segments, const std::vector<VertexId>& same_as, const SurfaceBorder& border) {
  std::vector<std::array<std::uint32_t, 2>> edges, required;
  for (const TriangleId t : mesh.cells.ids())
    for (std::uint32_t c = 0; c < 3; ++c)
      if (!mesh.cells[t].twin[c].is_valid()) {
        const HalfedgeId h = halfedge(t, c);
        edges.push_back({std::min(mesh.origin(h), mesh.target(h)).value(), std::max(mesh.origin(h), mesh.target(h)).value()});
      }
  std::sort(edges.begin(), edges.end());
  ErrorInfo info{.code = ErrorCode::self_intersection, .attempted = k_border_attempt, .problem = "the border touches itself along a line"};
  for (const Segment& s : segments) {
    const std::uint32_t a = same_as[s.from].value(), b = same_as[s.to].value();
    if (a != b && std::binary_search(edges.begin(), edges.end(), std::array<std::uint32_t, 2>{std::min(a, b), std::max(a, b)})) continue;
    ++info.n_locations;
    if (info.locations.size() < 10)
      info.locations.push_back({border.samples[s.from].point, "segment of the border to " + format_point(border.samples[s.to].point)});
  }
  if (info.n_locations == 0) return;
  info.hint = "borders may meet only in single points; merge a face this narrow with its neighbours";
  throw Error(std::move(info));
}

}  // namespace

double scale_of_speed(double speed) {
  if (!(speed > 0.0) || !std::isfinite(speed)) return 1.0;
  int exponent = 0;
  std::frexp(speed, &exponent);
  return std::ldexp(1.0, exponent);
}

SurfaceTriangulation triangulate_border(const SurfaceBorder& border, Vec2 scale, const RunContext& context) {
  std::vector<Vec2> locations;
  for (const Uv& at : border.uv) locations.push_back({at.u * scale.x, at.v * scale.y});
  std::vector<Segment> segments;
  for (const auto& loop : border.loops)
    for (std::size_t i = 0; i < loop.size(); ++i) segments.push_back({loop[i], loop[(i + 1) % loop.size()], true});
  SurfaceTriangulation surface;
  std::vector<VertexId> same_as;
  try {
    PlanarTriangulation plane = triangulate_plane(locations, segments, Extent::inside, context);
    surface.mesh = std::move(plane.mesh);
    same_as = std::move(plane.same_as);
  } catch (const Error& error) {
    if (error.code() != ErrorCode::self_intersection) throw;
    throw_in_space(error, border, scale);
  }
  if (surface.mesh.cells.empty()) {
    ErrorInfo info{.code = ErrorCode::bad_argument, .attempted = k_border_attempt, .problem = "the border encloses no area in (u, v)"};
    if (!border.samples.empty()) info.locations.push_back({border.samples[0].point, "first point of the border"});
    throw Error(std::move(info));
  }
  check_segments(surface.mesh, segments, same_as, border);
  for (std::size_t i = 0; i < border.uv.size(); ++i) {
    surface.points.push_back(border.samples[i].point);
    surface.frames.push_back(border.samples[i].frame);
    surface.stands_for.push_back(border.stands_for[i]);
  }
  surface.n_border = static_cast<std::uint32_t>(border.uv.size());
  surface.scale = scale;
  return surface;
}

bool looks_along_surface(const SurfaceTriangulation& surface, VertexId p, const Cavity& cavity) {
  const Vec3& normal = surface.frames[p].normal;
  const Point& centre = surface.points[p];
  for (const Cavity::BorderEdge& edge : cavity.border) {
    if (surface.stands_for[edge.from] == surface.stands_for[edge.to]) continue;
    if (dot(cross(surface.points[edge.from] - centre, surface.points[edge.to] - centre), normal) <= 0.0) return false;
  }
  return true;
}

std::vector<TriangleVertices> extract_triangles(const SurfaceTriangulation& surface) {
  std::vector<TriangleVertices> triangles;
  triangles.reserve(surface.mesh.n_triangles());
  for (const TriangleId t : surface.mesh.cells.ids()) {
    const Cell& cell = surface.mesh.cells[t];
    if (cell.is_dead || surface.is_flat(t)) continue;
    triangles.push_back({surface.stands_for[cell.vertex[0]], surface.stands_for[cell.vertex[1]], surface.stands_for[cell.vertex[2]]});
  }
  return triangles;
}

}  // namespace sterna::delaunay
