// 1. border_edges: assigns each edge with only one triangle to a plane.
// 2. join_on_lines: where two planes meet, adds the part of their line that bounds the fluid, between open-boundary vertices.
// 3. triangulate: fills the part of each plane that is inside an odd number of open-boundary loops, without new vertices.
// 4. Edges that are still open mark the location of an error.
#include "volmesh/domain/end_planes.h"

#include <algorithm>
#include <array>
#include <cmath>

#include "geom/base/error.h"
#include "geom/math/measures.h"
#include "volmesh/domain/fill_polygon.h"

namespace sterna::volmesh {
namespace {

constexpr double k_line_growth = 1.3;  ///< growth ratio of the edges on the line of two planes, from both ends
constexpr std::size_t k_most_line_vertices = 100'000;
constexpr const char* k_planes_attempt = "filling the planes at which the surface ends";

using Edge = std::array<VertexId, 2>;  ///< directed edge

bool is_in(const Point& p, const EndPlane& end) { return p[end.axis] == end.at; }

std::string name_of(const EndPlane& end) {
  std::string text(1, "xyz"[end.axis]);
  return text + " = " + std::to_string(end.at);
}

/// Returns the open-boundary edges of each plane. An edge that lies in two planes belongs to the plane from which its triangle rises.
std::vector<std::vector<Edge>> border_edges(const TriMesh& mesh, std::span<const EndPlane> ends, const RunContext& context) {
  const Topology topology(mesh, context);
  std::vector<std::vector<Edge>> borders(ends.size());
  ErrorInfo info{.code = ErrorCode::open_surface,
                 .attempted = k_planes_attempt,
                 .hint = "close the surface away from these planes; the outer shape must reach the planes"};
  for (std::size_t i = 0; i < topology.n_halfedges(); ++i) {
    const HalfedgeId h(i);
    if (!topology.is_boundary(h)) continue;
    const VertexId from = topology.from(h), to = topology.to(h), opposite = topology.from(previous(h));
    std::size_t k = 0;
    while (k < ends.size() && !(is_in(mesh.points[from], ends[k]) && is_in(mesh.points[to], ends[k]) && !is_in(mesh.points[opposite], ends[k]))) ++k;
    if (k < ends.size()) {
      borders[k].push_back({from, to});
      continue;
    }
    ++info.n_locations;
    if (info.locations.size() < k_max_locations) info.locations.push_back({0.5 * (mesh.points[from] + mesh.points[to]), "an edge with one triangle"});
  }
  if (info.n_locations == 0) return borders;
  info.problem = std::to_string(info.n_locations) + " edges with one triangle lie in none of the " + std::to_string(ends.size()) + " planes";
  throw Error(std::move(info));
}

/// Returns the mean length of the open-boundary edges at a vertex.
double length_at(const TriMesh& mesh, const std::vector<std::vector<Edge>>& borders, VertexId v) {
  double sum = 0.0;
  int n = 0;
  for (const auto& border : borders)
    for (const auto& [a, b] : border) {
      if (a != v && b != v) continue;
      sum += distance(mesh.points[a], mesh.points[b]);
      ++n;
    }
  return n > 0 ? sum / n : 0.0;
}

/// Returns the parameters in (0, 1) that divide a line of length 1. The pieces grow from `first` at its start and from `last` at its end, up to `most`.
std::vector<double> graded(double first, double last, double most) {
  std::vector<double> lower, upper;
  double a = 0.0, b = 1.0, step_a = first, step_b = last;
  while (a + step_a < b - step_b && lower.size() + upper.size() < k_most_line_vertices) {
    if (step_a <= step_b) {
      lower.push_back(a += step_a);
      step_a = std::max(step_a, std::min(step_a * k_line_growth, most));
    } else {
      upper.push_back(b -= step_b);
      step_b = std::max(step_b, std::min(step_b * k_line_growth, most));
    }
  }
  // The remaining piece between both halves is shorter than both steps. If the last point were omitted, the gap would be at most as long as the sum of both
  // steps.
  lower.insert(lower.end(), upper.rbegin(), upper.rend());
  return lower;
}

/// Divides the line of two planes into edges, and adds them to the open boundaries of both planes.
void join_on_line(TriMesh& mesh, std::span<const EndPlane> ends, std::span<const double> edges, std::size_t k, std::size_t l,
                  std::vector<std::vector<Edge>>& borders, std::vector<std::vector<Edge>>& lines) {
  const std::size_t along = 3 - ends[k].axis - ends[l].axis;
  std::vector<VertexId> on_line;
  for (const Edge& edge : borders[k])
    for (const VertexId v : edge)
      if (is_in(mesh.points[v], ends[l])) on_line.push_back(v);
  std::sort(on_line.begin(), on_line.end(),
            [&](VertexId a, VertexId b) { return mesh.points[a][along] < mesh.points[b][along] || (mesh.points[a][along] == mesh.points[b][along] && a < b); });
  on_line.erase(std::unique(on_line.begin(), on_line.end()), on_line.end());
  if (on_line.size() % 2 != 0) {
    ErrorInfo info{.code = ErrorCode::open_surface,
                   .attempted = k_planes_attempt,
                   .problem = "open boundaries meet the intersection line of the planes " + name_of(ends[k]) + " and " + name_of(ends[l]) + " in " +
                              std::to_string(on_line.size()) +
                              " vertices; an even number is needed, because each part of the line in the fluid begins and ends at a vertex",
                   .hint = "open boundaries may cross this line but not touch it, and no third plane may cut the line"};
    for (const VertexId v : on_line)
      if (info.locations.size() < k_max_locations) info.locations.push_back({mesh.points[v], "an open boundary meets the line"});
    throw Error(std::move(info));
  }
  for (std::size_t i = 0; i < on_line.size(); i += 2) {
    const VertexId a = on_line[i], b = on_line[i + 1];
    const Point from = mesh.points[a], to = mesh.points[b];
    const double length = distance(from, to);
    std::vector<VertexId> chain{a};
    double most = 1.0;
    for (const std::size_t plane : {k, l})
      if (!is_automatic(edges[plane])) most = std::min(most, edges[plane] / length);
    for (const double t : graded(length_at(mesh, borders, a) / length, length_at(mesh, borders, b) / length, most)) {
      Point p = from;
      p[along] = from[along] + t * (to[along] - from[along]);
      chain.push_back(mesh.points.push_back(p));
    }
    chain.push_back(b);
    for (std::size_t j = 0; j + 1 < chain.size(); ++j) {
      lines[k].push_back({chain[j], chain[j + 1]});
      lines[l].push_back({chain[j], chain[j + 1]});
    }
  }
}

void triangulate(TriMesh& mesh, const EndPlane& end, const std::vector<Edge>& border, const std::vector<Edge>& lines, const Patch& patch,
                 const RunContext& context) {
  const std::size_t u = (end.axis + 1) % 3, v = (end.axis + 2) % 3;
  std::vector<VertexId> vertices;
  for (const auto* edges : {&border, &lines})
    for (const Edge& edge : *edges) vertices.insert(vertices.end(), edge.begin(), edge.end());
  std::sort(vertices.begin(), vertices.end());
  vertices.erase(std::unique(vertices.begin(), vertices.end()), vertices.end());
  const auto number = [&](VertexId p) { return static_cast<std::uint32_t>(std::lower_bound(vertices.begin(), vertices.end(), p) - vertices.begin()); };
  std::vector<Vec2> locations;
  for (const VertexId p : vertices) locations.push_back({mesh.points[p][u], mesh.points[p][v]});
  std::vector<std::array<std::uint32_t, 2>> segments;
  for (const auto* edges : {&border, &lines})
    for (const auto& [a, b] : *edges) segments.push_back({number(a), number(b)});
  std::vector<std::array<std::uint32_t, 3>> triangles;
  try {
    triangles = triangulate_borders(locations, segments, context);
  } catch (const Error& error) {
    ErrorInfo info = error.info();
    info.attempted = k_planes_attempt;
    info.problem = "the open boundaries in the plane " + name_of(end) + " cross: " + info.problem;
    for (ErrorLocation& location : info.locations) {
      Point p;
      p[end.axis] = end.at;
      p[u] = location.position.x;
      p[v] = location.position.y;
      location.position = p;
    }
    info.geometry = {};
    throw Error(std::move(info));
  }
  const auto same = std::find(mesh.patches.begin(), mesh.patches.end(), patch);
  const PatchId id = same == mesh.patches.end() ? mesh.patches.push_back(patch) : PatchId(static_cast<std::uint64_t>(same - mesh.patches.begin()));
  for (const auto& t : triangles) {
    // Triangles that are counter-clockwise in (u, v) have their normal along the axis.
    const bool is_turned = end.inward < 0.0;
    mesh.triangles.push_back({vertices[t[0]], vertices[t[is_turned ? 2 : 1]], vertices[t[is_turned ? 1 : 2]]});
    mesh.triangle_patch.push_back(id);
  }
}

void require_closed(const TriMesh& mesh, const RunContext& context) {
  const Topology topology(mesh, context);
  if (topology.n_boundary_halfedges() == 0) return;
  ErrorInfo info{.code = ErrorCode::open_surface,
                 .attempted = k_planes_attempt,
                 .problem = "the planes do not close the surface: " + std::to_string(topology.n_boundary_halfedges()) + " edges still have only one triangle",
                 .n_locations = static_cast<std::int64_t>(topology.n_boundary_halfedges()),
                 .hint = "open boundaries must not touch each other, and each must separate fluid and body"};
  for (std::size_t i = 0; i < topology.n_halfedges() && info.locations.size() < k_max_locations; ++i)
    if (topology.is_boundary(HalfedgeId(i))) info.locations.push_back({mesh.points[topology.from(HalfedgeId(i))], "an open edge starts here"});
  throw Error(std::move(info));
}

}  // namespace

std::vector<EndPlane> end_planes_of(const Constraints& borders) {
  std::vector<EndPlane> ends;
  for (const auto& surface : borders.surfaces) {
    const Vec3 normal = surface->normal({});
    EndPlane end;
    for (std::size_t k = 0; k < 3; ++k)
      if (std::abs(normal[k]) > 0.5) end.axis = k;
    end.at = surface->closest({})[end.axis];
    end.inward = normal[end.axis] > 0.0 ? 1.0 : -1.0;
    ends.push_back(end);
  }
  return ends;
}

std::vector<double> volumes_of(const TriMesh& mesh, const Components& components, std::span<const EndPlane> ends) {
  // A plane across the axis contributes its area times the difference between its coordinate and `origin`. This is zero for one plane.
  std::size_t axis = 3;
  double origin = 0.0;
  for (std::size_t k = 0; k < 3 && axis == 3; ++k)
    if (std::none_of(ends.begin(), ends.end(), [&](const EndPlane& end) { return end.axis == k; })) axis = k;
  for (std::size_t k = 0; k < 3 && axis == 3; ++k)
    if (std::count_if(ends.begin(), ends.end(), [&](const EndPlane& end) { return end.axis == k; }) == 1) axis = k;
  if (axis == 3)
    throw Error({.code = ErrorCode::open_surface,
                 .attempted = k_planes_attempt,
                 .problem = "the surface ends at two planes normal to each of the three axes",
                 .hint = "add at least one of these sides to the surface"});
  for (const EndPlane& end : ends)
    if (end.axis == axis) origin = end.at;
  std::vector<double> volumes(components.count, 0.0);
  for (const TriangleId t : mesh.triangles.ids()) {
    const auto [a, b, c] = corners(mesh, t);
    volumes[components.component[t]] += area_vector(a, b, c)[axis] * ((a[axis] - origin) + (b[axis] - origin) + (c[axis] - origin)) / 3.0;
  }
  return volumes;
}

void fill_ends(TriMesh& mesh, std::span<const EndPlane> ends, std::span<const Patch> patches, std::span<const double> edges, const RunContext& context) {
  std::vector<std::vector<Edge>> borders = border_edges(mesh, ends, context), lines(ends.size());
  for (std::size_t k = 0; k < ends.size(); ++k)
    for (std::size_t l = k + 1; l < ends.size(); ++l)
      if (ends[k].axis != ends[l].axis) join_on_line(mesh, ends, edges, k, l, borders, lines);
  for (std::size_t k = 0; k < ends.size(); ++k) triangulate(mesh, ends[k], borders[k], lines[k], patches[k], context);
  require_closed(mesh, context);
}

}  // namespace sterna::volmesh
