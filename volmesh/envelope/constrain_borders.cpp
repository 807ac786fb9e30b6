// Determines the plane to which each boundary vertex belongs. This is not obvious: a boundary edge along x may lie in a plane of constant y and in a plane of
// constant z.
// 1. candidates_of_edges: finds planes that contain both ends of an edge, but not the third corner of its triangle (because the body does not end on the plane
// of a box face).
// 2. find_planes: selects for each edge the candidate plane that contains the largest length of boundary edges. The result contains every plane that an edge
// selects.
// 3. constraints_of_planes: assigns to each vertex the planes of its edges.
#include "volmesh/envelope/constrain_borders.h"

#include <algorithm>
#include <cmath>
#include <string>

#include "geom/base/disjoint_sets.h"
#include "geom/base/error.h"

namespace sterna::volmesh {
namespace {

constexpr double k_parallel_sine = 1e-6;  ///< the line of intersection of planes at a smaller angle cannot be computed
constexpr std::string_view k_hint =
    "a wall may end only in planes, as a half model at its symmetry plane x, y or z = constant; close the other open boundaries, or move their vertices into "
    "the plane";

struct BorderEdge {
  HalfedgeId halfedge;
  VertexId from, to, opposite;
};

std::vector<BorderEdge> boundary_edges(const TriMesh& wall, const Topology& topology) {
  std::vector<BorderEdge> edges;
  for (std::size_t i = 0; i < 3 * wall.n_triangles(); ++i) {
    const HalfedgeId h(i);
    if (topology.is_boundary(h)) edges.push_back({h, topology.from(h), topology.to(h), topology.from(previous(h))});
  }
  return edges;
}

/// Returns the number of closed polygons of the boundary. Edges that share a vertex belong to the same polygon.
std::size_t count_borders(const TriMesh& wall, const std::vector<BorderEdge>& edges) {
  DisjointSets borders(wall.n_vertices());
  std::size_t n = 0;
  std::vector<std::uint8_t> is_on_border(wall.n_vertices(), 0);
  for (const BorderEdge& e : edges) {
    for (const VertexId v : {e.from, e.to}) n += is_on_border[v.index()]++ == 0 ? 1 : 0;
    if (borders.join(e.from.value(), e.to.value())) --n;
  }
  return n;
}

[[noreturn]] void reject(const TriMesh& wall, const std::vector<BorderEdge>& edges, std::string problem, const std::vector<VertexId>& where,
                         const std::string& what) {
  ErrorInfo info{
      .code = ErrorCode::open_surface,
      .attempted = "constraining the open boundaries of the wall",
      .problem = std::to_string(count_borders(wall, edges)) + " open boundaries with " + std::to_string(edges.size()) + " edges: " + std::move(problem),
      .n_locations = static_cast<std::int64_t>(where.size()),
      .hint = std::string(k_hint)};
  for (std::size_t i = 0; i < std::min(where.size(), k_max_locations); ++i)
    info.locations.push_back({wall.points[where[i]], "vertex " + std::to_string(where[i].value()) + " " + what});
  for (const BorderEdge& e : edges) {
    const std::uint32_t next = static_cast<std::uint32_t>(info.geometry.points.size());
    info.geometry.points.insert(info.geometry.points.end(), {wall.points[e.from], wall.points[e.to]});
    info.geometry.edges.push_back({next, next + 1});
  }
  throw Error(std::move(info));
}

struct AxisPlane {
  std::size_t axis;
  double value;  ///< m, smallest coordinate of the cluster
  double support = 0.0;
};

/// Returns planes of constant coordinate that contain boundary edges whose triangle is not in the plane, with the total length of these edges.
std::vector<AxisPlane> candidates_of_edges(const TriMesh& wall, const std::vector<BorderEdge>& edges, double tolerance) {
  std::vector<AxisPlane> found;
  for (std::size_t axis = 0; axis < 3; ++axis) {
    std::vector<AxisPlane> in_order;
    for (const BorderEdge& e : edges) {
      const double a = wall.points[e.from][axis], b = wall.points[e.to][axis], c = wall.points[e.opposite][axis];
      if (std::abs(a - b) > tolerance || std::abs(a - c) <= tolerance) continue;
      in_order.push_back({axis, std::min(a, b), distance(wall.points[e.from], wall.points[e.to])});
    }
    std::sort(in_order.begin(), in_order.end(),
              [](const AxisPlane& p, const AxisPlane& q) { return p.value < q.value || (p.value == q.value && p.support < q.support); });
    for (const AxisPlane& p : in_order) {
      if (!found.empty() && found.back().axis == axis && p.value - found.back().value <= tolerance) found.back().support += p.support;
      else found.push_back(p);
    }
  }
  return found;
}

std::vector<ConstraintPlane> find_planes(const TriMesh& wall, const std::vector<BorderEdge>& edges, double tolerance) {
  const std::vector<AxisPlane> candidates = candidates_of_edges(wall, edges, tolerance);
  std::vector<std::uint8_t> is_chosen(candidates.size(), 0);
  std::vector<VertexId> lost;
  for (const BorderEdge& e : edges) {
    std::size_t best = candidates.size();
    for (std::size_t k = 0; k < candidates.size(); ++k) {
      const auto is_in = [&](VertexId v) {
        const double x = wall.points[v][candidates[k].axis] - candidates[k].value;
        return x >= 0.0 && x <= 2.0 * tolerance;
      };
      if (!is_in(e.from) || !is_in(e.to) || is_in(e.opposite)) continue;
      if (best == candidates.size() || candidates[k].support > candidates[best].support) best = k;
    }
    if (best < candidates.size()) is_chosen[best] = 1;
    else lost.push_back(e.from);
  }
  if (!lost.empty()) reject(wall, edges, std::to_string(lost.size()) + " edges lie in no plane x, y or z = constant", lost, "starts such an edge");
  std::vector<ConstraintPlane> planes;
  for (std::size_t k = 0; k < candidates.size(); ++k) {
    if (!is_chosen[k]) continue;
    // The most frequent coordinate of the plane's vertices is used, because snapping then moves the fewest vertices.
    std::vector<double> values;
    for (const BorderEdge& e : edges) {
      const double x = wall.points[e.from][candidates[k].axis];
      if (x >= candidates[k].value && x <= candidates[k].value + 2.0 * tolerance) values.push_back(x);
    }
    std::sort(values.begin(), values.end());
    Point point;
    std::size_t most = 0;
    for (std::size_t begin = 0, end = 0; begin < values.size(); begin = end) {
      while (end < values.size() && values[end] == values[begin]) ++end;
      if (end - begin <= most) continue;
      most = end - begin;
      point[candidates[k].axis] = values[begin];
    }
    Vec3 normal;
    normal[candidates[k].axis] = 1.0;
    planes.emplace_back(point, normal);
  }
  return planes;
}

/// Returns the planes with their normals oriented to the side of the wall.
std::vector<std::shared_ptr<const ConstraintSurface>> facing_wall(const TriMesh& wall, const std::vector<BorderEdge>& edges,
                                                                  std::span<const ConstraintPlane> planes, double tolerance) {
  std::vector<std::shared_ptr<const ConstraintSurface>> surfaces;
  for (const ConstraintPlane& plane : planes) {
    std::vector<VertexId> above, below;
    for (const VertexId v : wall.points.ids()) {
      const double x = plane.inside_distance(wall.points[v]);
      if (x > tolerance) above.push_back(v);
      if (x < -tolerance) below.push_back(v);
    }
    const std::vector<VertexId>& fewer = above.size() < below.size() ? above : below;
    if (!fewer.empty())
      reject(wall, edges, "the wall ends at a plane and continues beyond the plane, with " + std::to_string(fewer.size()) + " vertices", fewer,
             "is on the other side");
    const Vec3 normal = plane.normal({});
    const Point on_plane = plane.closest({});
    surfaces.push_back(std::make_shared<ConstraintPlane>(on_plane, above.empty() ? -normal : normal));
  }
  return surfaces;
}

}  // namespace

Constraints constraints_of_planes(const TriMesh& wall, const Topology& topology, std::span<const ConstraintPlane> planes) {
  const std::vector<BorderEdge> edges = boundary_edges(wall, topology);
  Constraints result;
  if (edges.empty()) return result;
  // Detected planes are within k_border_tolerance of their lowest vertex. Given planes may lie on either side of their vertices.
  const double tolerance = 2.0 * k_border_tolerance * body_length(wall);
  result.surfaces = facing_wall(wall, edges, planes, tolerance);
  result.vertex.resize(wall.n_vertices());
  std::vector<VertexId> lost, crowded;
  for (const BorderEdge& e : edges) {
    const auto distance_of = [&](std::size_t k, VertexId v) { return std::abs(result.surfaces[k]->inside_distance(wall.points[v])); };
    bool has_plane = false;
    for (std::size_t k = 0; k < result.surfaces.size(); ++k) {
      if (distance_of(k, e.from) > tolerance || distance_of(k, e.to) > tolerance || distance_of(k, e.opposite) <= tolerance) continue;
      has_plane = true;
      for (const VertexId v : {e.from, e.to}) {
        auto& on = result.vertex[v].on;
        const auto number = static_cast<std::int32_t>(k);
        if (result.vertex[v].is_on(k)) continue;
        if (on[0] < 0) on[0] = number;
        else if (on[1] < 0) on[1] = number;
        else crowded.push_back(v);
        if (on[1] >= 0 && on[0] > on[1]) std::swap(on[0], on[1]);
      }
    }
    if (!has_plane) lost.push_back(e.from);
  }
  if (!lost.empty()) reject(wall, edges, std::to_string(lost.size()) + " edges lie in none of the planes", lost, "starts such an edge");
  if (!crowded.empty()) reject(wall, edges, std::to_string(crowded.size()) + " vertices lie on more than two planes", crowded, "is on three planes");
  for (VertexConstraint& constraint : result.vertex) {
    if (constraint.on[0] < 0) continue;
    const Vec3 first = result.surfaces[static_cast<std::size_t>(constraint.on[0])]->normal({});
    constraint.freedom = Freedom::plane;
    constraint.axis = first;
    if (constraint.on[1] < 0) continue;
    const Vec3 line = cross(first, result.surfaces[static_cast<std::size_t>(constraint.on[1])]->normal({}));
    constraint.freedom = norm(line) > k_parallel_sine ? Freedom::line : Freedom::fixed;  // between parallel planes no direction is free
    constraint.axis = normalized(line);
  }
  return result;
}

Constraints constraints_of_borders(const TriMesh& wall, const Topology& topology) {
  const std::vector<BorderEdge> edges = boundary_edges(wall, topology);
  if (edges.empty()) return {};
  const std::vector<ConstraintPlane> planes = find_planes(wall, edges, k_border_tolerance * body_length(wall));
  return constraints_of_planes(wall, topology, planes);
}

}  // namespace sterna::volmesh
