// Discs consist of rings of vertices. The spacing of rings equals the local edge length, and each ring is turned by half an edge against the next ring. The
// triangles between two rings are made one after another, on the ring whose next vertex comes first by its angle.

#include "volmesh/domain/disc_baffles.h"

#include <algorithm>
#include <cmath>
#include <memory>
#include <numbers>
#include <optional>
#include <utility>

#include "geom/base/error.h"
#include "geom/base/number_text.h"
#include "geom/mesh/baffles.h"
#include "geom/mesh/find_crossings.h"
#include "geom/mesh/size_points.h"

namespace sterna::volmesh {
namespace {

constexpr double k_shortest_edge = 1e-4;  ///< fraction of the radius; shorter edges, which need more rings, are an error
constexpr std::size_t k_most_rings = 2000;
constexpr int k_least_on_ring = 6;
constexpr int k_probes = 48;                       ///< number of points on a ring at which the distance from walls is sampled
const double k_row_height = 0.5 * std::sqrt(3.0);  ///< ratio of height to edge of equilateral triangles

ErrorInfo problem_with(const ActuatorDisc& disc, ErrorCode code, std::string problem, std::string hint = {}) {
  return {.code = code, .attempted = "making actuator disc \"" + disc.name + "\"", .problem = std::move(problem), .hint = std::move(hint)};
}

}  // namespace

void require_sane(const ActuatorDisc& disc) {
  const auto fail = [&](std::string problem) { throw Error(problem_with(disc, ErrorCode::bad_argument, std::move(problem))); };
  if (disc.name.empty()) fail("the disc has no name");
  if (!is_finite(disc.center)) fail("the center is not finite");
  if (!is_finite(disc.axis) || norm(disc.axis) == 0.0) fail("the axis has no direction");
  if (!(disc.radius > 0.0) || !std::isfinite(disc.radius)) fail("the radius is " + in_metres(disc.radius) + " and must be positive");
  if (!(disc.inner_radius >= 0.0) || disc.inner_radius >= disc.radius)
    fail("the inner radius is " + in_metres(disc.inner_radius) + " and must be between 0 and the radius, " + in_metres(disc.radius));
  if (!is_automatic(disc.edge) && !(disc.edge > k_shortest_edge * disc.radius))
    fail("the edge length is " + in_metres(disc.edge) + " and must be more than " + in_metres(k_shortest_edge * disc.radius));
}

namespace {

/// The plane of a disc, with a frame.
class Frame {
 public:
  explicit Frame(const ActuatorDisc& disc) : center_(disc.center) {
    const Vec3 n = normalized(disc.axis);
    // The coordinate axis with the smallest component of n gives the first direction.
    const Vec3 m{std::abs(n.x), std::abs(n.y), std::abs(n.z)};
    const Vec3 other = m.x <= m.y && m.x <= m.z ? Vec3{1, 0, 0} : m.y <= m.z ? Vec3{0, 1, 0} : Vec3{0, 0, 1};
    u_ = normalized(cross(n, other));
    v_ = cross(n, u_);
  }
  Point at(double radius, double angle) const { return center_ + radius * std::cos(angle) * u_ + radius * std::sin(angle) * v_; }

 private:
  Point center_;
  Vec3 u_, v_;
};

/// Returns the vertices of walls, each with the geometric mean of its edges as size.
std::vector<SizePoint> size_points_of(const TriMesh& walls) {
  Column<VertexId, double> sum(walls.n_vertices(), 0.0), count(walls.n_vertices(), 0.0);
  for (const TriangleVertices& v : walls.triangles)
    for (std::size_t k = 0; k < 3; ++k) {
      sum[v[k]] += std::log(distance(walls.points[v[k]], walls.points[v[(k + 1) % 3]]));
      count[v[k]] += 1.0;
    }
  std::vector<SizePoint> size_points;
  for (const VertexId v : walls.points.ids())
    if (count[v] > 0.0) size_points.push_back({walls.points[v], std::exp(sum[v] / count[v])});
  return size_points;
}

double longest_edge(const ActuatorDisc& disc) {
  const double longest = is_automatic(disc.edge) ? k_disc_edge * disc.radius : disc.edge;
  // With longer edges the polygons of a narrow ring would cross each other.
  return disc.inner_radius > 0.0 ? std::min(longest, disc.radius - disc.inner_radius) : longest;
}

std::uint32_t edges_on_ring(double radius, double edge) {
  return static_cast<std::uint32_t>(std::max<double>(k_least_on_ring, std::round(2.0 * std::numbers::pi * radius / edge)));
}

/// Edge lengths on circles around the disc's centre, as functions of the radius.
class RingSizes {
 public:
  RingSizes(const ActuatorDisc& disc, const Frame& frame, const TriMesh& walls, double growth, const RunContext& context)
      : frame_(frame), longest_(longest_edge(disc)), shortest_(k_shortest_edge * disc.radius) {
    if (walls.n_triangles() > 0) size_points_.emplace(size_points_of(walls), growth - 1.0, context);
  }

  double operator()(double radius) {
    double size = longest_;
    for (int i = 0; size_points_ && i < k_probes; ++i)
      size = std::min(size, size_points_->smallest(frame_.at(radius, 2.0 * std::numbers::pi * i / k_probes), hint_));
    return std::max(size, shortest_);
  }

 private:
  const Frame& frame_;
  double longest_, shortest_;
  std::optional<SizePointTree> size_points_;
  std::uint32_t hint_ = 0;
};

/// Returns the radii of the rings, from the outer circle inwards. A radius of 0 is a vertex in the centre.
std::vector<double> ring_radii(const ActuatorDisc& disc, RingSizes& size) {
  std::vector<double> steps;
  double reached = disc.radius;
  for (; reached > disc.inner_radius; reached -= steps.back()) {
    if (steps.size() == k_most_rings)
      throw Error(problem_with(disc, ErrorCode::bad_argument, "the disc needs more than " + std::to_string(k_most_rings) + " rings of triangles",
                               "raise the edge length of the disc, or move the disc away from finely meshed walls"));
    steps.push_back(k_row_height * size(reached));
  }
  // The last step overshoots the inner circle. It is kept if more than half of it is needed.
  const std::size_t least = disc.inner_radius > 0.0 ? 2 : 1;  // at least one ring of vertices lies between two free boundary circles
  if (steps.size() > least && disc.inner_radius - reached > 0.5 * steps.back()) {
    reached += steps.back();
    steps.pop_back();
  }
  if (steps.size() < least) {
    steps.assign(least, 1.0);
    reached = disc.radius - static_cast<double>(least);
  }
  const double scale = (disc.radius - disc.inner_radius) / (disc.radius - reached);
  std::vector<double> radii = {disc.radius};
  for (const double step : steps) radii.push_back(radii.back() - scale * step);
  radii.back() = disc.inner_radius;
  return radii;
}

struct Ring {
  std::uint32_t first = 0;
  std::uint32_t n = 0;
  double turn = 0.0;  ///< angle of the ring's first vertex
  double angle(std::uint32_t i) const { return turn + 2.0 * std::numbers::pi * i / n; }
  VertexId vertex(std::uint32_t i) const { return VertexId(first + i % n); }
};

/// Adds the triangles between two rings, counter-clockwise about the frame's normal.
void zip(const Ring& outer, const Ring& inner, TriMesh& mesh) {
  if (inner.n == 1) {
    for (std::uint32_t i = 0; i < outer.n; ++i) mesh.triangles.push_back({outer.vertex(i), outer.vertex(i + 1), inner.vertex(0)});
    return;
  }
  std::uint32_t i = 0, j = 0;
  while (i < outer.n || j < inner.n) {
    const bool is_outer = j == inner.n || (i < outer.n && outer.angle(i + 1) - outer.turn <= inner.angle(j + 1) - inner.turn + (inner.turn - outer.turn));
    if (is_outer) {
      mesh.triangles.push_back({outer.vertex(i), outer.vertex(i + 1), inner.vertex(j)});
      ++i;
    } else {
      mesh.triangles.push_back({inner.vertex(j + 1), inner.vertex(j), outer.vertex(i)});
      ++j;
    }
  }
}

}  // namespace

std::string back_name(const ActuatorDisc& disc) { return disc.name + ".back"; }

TriMesh triangulate_disc(const ActuatorDisc& disc, const TriMesh& walls, double growth, const RunContext& context) {
  require_sane(disc);
  const Frame frame(disc);
  RingSizes size(disc, frame, walls, growth, context);
  const std::vector<double> radii = ring_radii(disc, size);
  TriMesh mesh;
  std::vector<Ring> rings;
  for (std::size_t k = 0; k < radii.size(); ++k) {
    Ring ring;
    ring.first = static_cast<std::uint32_t>(mesh.n_vertices());
    ring.n = radii[k] == 0.0 ? 1 : edges_on_ring(radii[k], size(radii[k]));
    ring.turn = k % 2 == 0 ? 0.0 : std::numbers::pi / ring.n;
    if (ring.n == 1) mesh.points.push_back(disc.center);
    else
      for (std::uint32_t i = 0; i < ring.n; ++i) mesh.points.push_back(frame.at(radii[k], ring.angle(i)));
    if (k > 0) zip(rings.back(), ring, mesh);
    rings.push_back(ring);
  }
  for (TriangleVertices& t : mesh.triangles) std::swap(t[1], t[2]);  // normals then point against the axis
  mesh.triangle_patch.assign(mesh.n_triangles(), mesh.patches.push_back({disc.name, PatchKind::interface}));
  return mesh;
}

std::vector<Point> border_polygon(const ActuatorDisc& disc, double radius, const TriMesh& walls, double growth, const RunContext& context) {
  require_sane(disc);
  const Frame frame(disc);
  RingSizes size(disc, frame, walls, growth, context);
  const std::uint32_t n = edges_on_ring(radius, size(radius));
  std::vector<Point> polygon;
  for (std::uint32_t i = 0; i < n; ++i) polygon.push_back(frame.at(radius, 2.0 * std::numbers::pi * i / n));
  return polygon;
}

std::function<double(const Point&)> disc_sizes(const ActuatorDisc& disc, const TriMesh& walls, double growth, const RunContext& context) {
  struct State {
    std::optional<SizePointTree> size_points;
    std::uint32_t hint = 0;
  };
  const auto state = std::make_shared<State>();
  if (walls.n_triangles() > 0) state->size_points.emplace(size_points_of(walls), growth - 1.0, context);
  return [state, longest = longest_edge(disc), shortest = k_shortest_edge * disc.radius](const Point& p) {
    return std::max(shortest, state->size_points ? std::min(longest, state->size_points->smallest(p, state->hint)) : longest);
  };
}

void require_own_names(const std::vector<ActuatorDisc>& discs, const Column<PatchId, Patch>& outer, const Column<PatchId, Patch>& walls) {
  std::vector<std::string> names;
  for (const auto* patches : {&outer, &walls})
    for (const Patch& patch : *patches) names.push_back(patch.name);
  for (const ActuatorDisc& disc : discs) {
    require_sane(disc);
    for (const std::string& name : {disc.name, back_name(disc)}) {
      if (std::ranges::find(names, name) != names.end())
        throw Error(problem_with(disc, ErrorCode::bad_argument, "there is a patch \"" + name + "\" already", "give the disc another name"));
      names.push_back(name);
    }
  }
}

void require_clear(const ActuatorDisc& disc, std::span<const Vec3> points, std::span<const std::array<std::uint32_t, 3>> triangles, std::size_t n_own,
                   const std::function<const std::string&(std::size_t)>& patch_of, const std::string& apart_from, const RunContext& context) {
  ErrorInfo error = problem_with(disc, ErrorCode::self_intersection, "", "a disc may touch only walls with layers: leave a gap to all other patches");
  for (const auto& [a, b] : find_crossings(points, triangles, context).pairs) {
    if ((a < n_own) == (b < n_own)) continue;
    const auto& t = triangles[std::min(a, b)];
    error.add_location((points[t[0]] + points[t[1]] + points[t[2]]) / 3.0, "the disc meets patch \"" + patch_of(std::max(a, b) - n_own) + "\"");
  }
  if (error.n_locations == 0) return;
  error.problem = std::to_string(error.n_locations) + " pairs of a disc triangle and another triangle meet" + apart_from;
  throw Error(std::move(error));
}

namespace {

/// Runs require_clear() for a baffle and another mesh, which have separate indices.
void require_baffle_clear(const ActuatorDisc& disc, const TriMesh& baffle, const TriMesh& others, const RunContext& context) {
  std::vector<Vec3> points(baffle.points.begin(), baffle.points.end());
  points.insert(points.end(), others.points.begin(), others.points.end());
  Box box;
  for (const Point& p : baffle.points) box.add(p);
  const auto n_baffle = static_cast<std::uint32_t>(baffle.n_vertices());
  std::vector<std::array<std::uint32_t, 3>> triangles;
  for (const TriangleVertices& v : baffle.triangles) triangles.push_back({v[0].value(), v[1].value(), v[2].value()});
  const std::size_t n_own = triangles.size();
  std::vector<TriangleId> sources;
  for (const TriangleId t : others.triangles.ids()) {
    Box own;
    for (const Point& p : corners(others, t)) own.add(p);
    bool is_near = true;
    for (std::size_t axis = 0; axis < 3; ++axis) is_near &= own.min[axis] <= box.max[axis] && own.max[axis] >= box.min[axis];
    if (!is_near) continue;
    const TriangleVertices& v = others.triangles[t];
    triangles.push_back({n_baffle + v[0].value(), n_baffle + v[1].value(), n_baffle + v[2].value()});
    sources.push_back(t);
  }
  const auto patch_of = [&](std::size_t i) -> const std::string& { return others.patches[others.triangle_patch[sources[i]]].name; };
  require_clear(disc, points, triangles, n_own, patch_of, "", context);
}

/// Marks the vertices on the border of the part of a mesh that these triangles form.
Column<VertexId, std::uint8_t> find_border(const TriMesh& baffle, const std::vector<TriangleId>& triangles) {
  std::vector<std::array<std::uint32_t, 2>> edges;
  for (const TriangleId t : triangles)
    for (std::size_t k = 0; k < 3; ++k) {
      const VertexId a = baffle.triangles[t][k], b = baffle.triangles[t][(k + 1) % 3];
      edges.push_back({std::min(a, b).value(), std::max(a, b).value()});
    }
  std::ranges::sort(edges);
  Column<VertexId, std::uint8_t> is_border(baffle.n_vertices(), 0);
  for (std::size_t i = 0; i < edges.size(); ++i) {
    const bool has_twin = (i > 0 && edges[i - 1] == edges[i]) || (i + 1 < edges.size() && edges[i + 1] == edges[i]);
    if (!has_twin) is_border[VertexId(edges[i][0])] = is_border[VertexId(edges[i][1])] = 1;
  }
  return is_border;
}

}  // namespace

TriMesh with_discs(TriMesh outer, const TriMesh& walls, const std::vector<ActuatorDisc>& discs, double growth, const RunContext& context) {
  require_own_names(discs, outer.patches, walls.patches);
  TriMesh so_far = outer;
  append(so_far, walls);
  for (const ActuatorDisc& disc : discs) {
    const TriMesh baffle = triangulate_disc(disc, walls, growth, context);
    require_baffle_clear(disc, baffle, so_far, context);
    append(so_far, baffle);
    append(outer, baffle);
  }
  return outer;
}

TriMesh with_second_sides(TriMesh outer, const std::vector<ActuatorDisc>& discs) {
  for (const ActuatorDisc& disc : discs) {
    const auto patch = std::ranges::find(outer.patches, disc.name, &Patch::name);
    const PatchId front(static_cast<std::size_t>(patch - outer.patches.begin())), back = outer.patches.push_back({back_name(disc), PatchKind::interface});
    std::vector<TriangleId> triangles;
    for (const TriangleId t : outer.triangles.ids())
      if (outer.triangle_patch[t] == front) triangles.push_back(t);
    const Column<VertexId, std::uint8_t> is_border = find_border(outer, triangles);
    Column<VertexId, VertexId> second(outer.n_vertices());
    for (const TriangleId t : triangles) {
      TriangleVertices v = outer.triangles[t];
      for (VertexId& corner : v) {
        if (!second[corner].is_valid()) second[corner] = is_border[corner] ? corner : outer.points.push_back(Point(outer.points[corner]));
        corner = second[corner];
      }
      outer.triangles.push_back({v[0], v[2], v[1]});
      outer.triangle_patch.push_back(back);
    }
  }
  return outer;
}

TriMesh one_sided(TriMesh outer) {
  const BaffleSides baffles = find_baffle_sides(outer);
  if (baffles.empty()) return outer;
  Column<TriangleId, TriangleVertices> triangles;
  Column<TriangleId, PatchId> patches;
  for (const TriangleId t : outer.triangles.ids()) {
    if (baffles.is_second(t.index())) continue;
    triangles.push_back(outer.triangles[t]);
    patches.push_back(outer.triangle_patch[t]);
  }
  outer.triangles = std::move(triangles);
  outer.triangle_patch = std::move(patches);
  return outer;
}

}  // namespace sterna::volmesh
