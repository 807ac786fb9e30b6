#include "geom/delaunay/face_mesh.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

#include "geom/base/error.h"
#include "geom/delaunay/face_passes.h"
#include "geom/delaunay/renumber.h"

namespace sterna::delaunay {
namespace {

/// Minimum number of vertices of a pole in (u, v), so that each triangle around it has one beside it.
constexpr std::uint32_t k_pole_vertices = 9;
constexpr double k_least_angle = 20.0 * std::numbers::pi / 180.0;
constexpr double k_largest_angle = 130.0 * std::numbers::pi / 180.0;

/// Converts the points with their surface's frames; runs of coincident points become poles, with additional vertices between them if there are few.
SurfaceBorder make_border(const Surface& surface, const FaceBorder& border) {
  SurfaceBorder result;
  const auto add = [&](const BorderPoint& p) {
    result.uv.push_back(p.uv);
    result.samples.push_back(sample(surface, p.uv));
    result.samples.back().point = p.point;
    result.stands_for.push_back(VertexId(static_cast<std::uint64_t>(result.uv.size() - 1)));
  };
  for (const auto& loop : border.loops)
    for (const BorderPoint& p : loop) add(p);
  std::uint32_t first = 0;
  for (const auto& loop : border.loops) {
    const auto n = static_cast<std::uint32_t>(loop.size());
    const auto is_pole_edge = [&](std::uint32_t i) { return loop[i].point == loop[(i + 1) % n].point && !(loop[i].uv == loop[(i + 1) % n].uv); };
    // Start where no run continues, so that each run is traversed from its start.
    std::uint32_t start = 0;
    while (start < n && is_pole_edge((start + n - 1) % n)) ++start;
    std::vector<std::uint32_t> vertices;
    for (std::uint32_t k = 0; k < n;) {
      const std::uint32_t i = (start + k) % n;
      std::uint32_t length = 0;
      while (length + 1 < n && is_pole_edge((i + length) % n)) ++length;
      vertices.push_back(first + i);
      const std::uint32_t more = length == 0 || length + 1 >= k_pole_vertices ? 0 : (k_pole_vertices - 1 + length - 1) / length - 1;
      for (std::uint32_t e = 0; e < length; ++e) {
        const BorderPoint &from = loop[(i + e) % n], &to = loop[(i + e + 1) % n];
        for (std::uint32_t m = 1; m <= more; ++m) {
          const double share = static_cast<double>(m) / (more + 1);
          vertices.push_back(static_cast<std::uint32_t>(result.uv.size()));
          add({from.uv + share * (to.uv - from.uv), from.point});
          result.stands_for.back() = VertexId(first + i);
        }
        vertices.push_back(first + (i + e + 1) % n);
        result.stands_for[first + (i + e + 1) % n] = VertexId(first + i);
      }
      k += length + 1;
    }
    result.loops.push_back(std::move(vertices));
    first += n;
  }
  // At a pole derivatives are zero except for rounding: any computed normal is meaningless.
  std::vector<bool> is_pole(result.uv.size(), false);
  for (std::size_t i = 0; i < result.uv.size(); ++i)
    if (result.stands_for[i].index() != i) is_pole[i] = is_pole[result.stands_for[i].index()] = true;
  for (std::size_t i = 0; i < result.uv.size(); ++i)
    if (is_pole[i]) result.samples[i].frame.normal = {};
  return result;
}

/// Sets the sizes of border vertices: the mean length of their edges, but at most twice the target length there (a coarse border does not coarsen the
/// interior).
void set_border_sizes(FaceState& state, const SurfaceBorder& border) {
  std::vector<double> sum(border.uv.size(), 0.0), n(border.uv.size(), 0.0);
  for (const auto& loop : border.loops)
    for (std::size_t i = 0; i < loop.size(); ++i) {
      const std::uint32_t a = loop[i], b = loop[(i + 1) % loop.size()];
      const double length = distance(border.samples[a].point, border.samples[b].point);
      if (length == 0.0) continue;
      for (const std::uint32_t v : {a, b}) {
        sum[v] += length;
        n[v] += 1.0;
      }
    }
  for (std::size_t v = 0; v < border.uv.size(); ++v) {
    const double requested = target_size(state, border.uv[v], border.samples[v].point);
    state.size.push_back(n[v] > 0.0 ? std::min(sum[v] / n[v], 2.0 * requested) : requested);
  }
}

void bring_neighbours_together(FaceState& state) {
  const Column<VertexId, VertexId> old_id = renumber(state.mesh);
  Column<VertexId, double> size;
  size.reserve(old_id.size());
  for (const VertexId v : old_id) size.push_back(state.size[v]);
  state.size = std::move(size);
}

FaceMesh extract(const SurfaceTriangulation& mesh, std::uint32_t n_border) {
  FaceMesh result;
  result.n_border = n_border;
  Column<VertexId, VertexId> number(mesh.points.size());
  for (const VertexId v : mesh.points.ids()) {
    const bool is_given = v.value() < n_border;
    if (!is_given && (mesh.is_border(v) || !mesh.mesh.outgoing[v].is_valid())) continue;
    number[v] = VertexId(static_cast<std::uint64_t>(result.points.size()));
    result.points.push_back(mesh.points[v]);
    result.uv.push_back(mesh.parameters(v));
    result.normals.push_back(mesh.frames[v].normal);
  }
  result.triangles = extract_triangles(mesh);
  for (TriangleVertices& triangle : result.triangles)
    for (VertexId& v : triangle) v = number[v];
  return result;
}

/// Compares angles by their cotangents: only the smallest and the largest are needed.
void measure(const FaceMesh& mesh, FaceMeshReport& report) {
  static const double k_steep = 1.0 / std::tan(k_least_angle), k_flat = 1.0 / std::tan(k_largest_angle);
  double steepest = -std::numeric_limits<double>::infinity(), flattest = std::numeric_limits<double>::infinity();
  for (const TriangleVertices& v : mesh.triangles) {
    const Point &a = mesh.points[v[0].index()], &b = mesh.points[v[1].index()], &c = mesh.points[v[2].index()];
    const Vec3 ab = b - a, bc = c - b, ca = a - c, normal = cross(ab, bc);
    const double area = norm(normal);
    const auto [low, high] = std::minmax({-dot(ab, ca), -dot(bc, ab), -dot(ca, bc)});
    // Zero area: one angle is zero, another pi.
    const double steep = area > 0.0 ? high / area : std::numeric_limits<double>::infinity(),
                 flat = area > 0.0 ? low / area : -std::numeric_limits<double>::infinity();
    if (steep > steepest) {
      steepest = steep;
      report.worst_location = (a + b + c) / 3.0;
    }
    flattest = std::min(flattest, flat);
    if (steep > k_steep || flat < k_flat) ++report.n_outside_20_130;
    if (dot(normal, mesh.normals[v[0].index()]) < 0.0 || dot(normal, mesh.normals[v[1].index()]) < 0.0 || dot(normal, mesh.normals[v[2].index()]) < 0.0)
      ++report.n_folded;
  }
  report.min_angle = std::atan2(1.0, steepest);
  report.max_angle = std::atan2(1.0, flattest);
}

}  // namespace

void check_border(const FaceBorder& border) {
  for (const auto& loop : border.loops)
    if (loop.size() < 3)
      throw Error({.code = ErrorCode::bad_argument,
                   .attempted = "meshing a face",
                   .problem = "a loop of the border has " + std::to_string(loop.size()) + " points; at least three are needed"});
  if (border.loops.empty()) throw Error({.code = ErrorCode::bad_argument, .attempted = "meshing a face", .problem = "the face has no border"});
}

ParameterBox box_of(const FaceBorder& border) {
  ParameterBox box{{1e300, -1e300}, {1e300, -1e300}};
  for (const auto& loop : border.loops)
    for (const BorderPoint& p : loop) {
      box.u = {std::min(box.u.from, p.uv.u), std::max(box.u.to, p.uv.u)};
      box.v = {std::min(box.v.from, p.uv.v), std::max(box.v.to, p.uv.v)};
    }
  return box;
}

FaceMesh mesh_face(const Surface& surface, const FaceBorder& border, const SizeFunction& size, Vec2 mean_speed, const FaceMeshOptions& options,
                   const RunContext& context) {
  check_border(border);
  FaceState state{surface, size, options, box_of(border), {}, {}};
  const SurfaceBorder plane_border = make_border(surface, border);
  const Vec2 scale{scale_of_speed(mean_speed.x), scale_of_speed(mean_speed.y)};
  state.mesh = triangulate_border(plane_border, scale, context);
  set_border_sizes(state, plane_border);

  FaceMeshReport report;
  unfold(state, report, context);
  refine_by_size(state, report, context);
  bring_neighbours_together(state);
  collapse_short_edges(state, report, context);
  smooth(state, report, context);
  refine_by_quality(state, report, context);
  remove_poor_vertices(state, report);
  smooth(state, report, context);
  remove_poor_vertices(state, report);

  std::uint32_t n_border = 0;
  for (const auto& loop : border.loops) n_border += static_cast<std::uint32_t>(loop.size());
  FaceMesh result = extract(state.mesh, n_border);
  measure(result, report);
  result.report = report;
  return result;
}

}  // namespace sterna::delaunay
