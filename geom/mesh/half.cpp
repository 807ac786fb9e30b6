// Cuts a surface with a plane so that every decision is made once per vertex or edge, and neighbours agree.
// 1. place_vertices: distances to the plane; distances within the tolerance are set to zero and their vertices moved into the plane.
// 2. snap_near_vertices: vertices with a cut close by on one of their edges move there, along the sharpest such edge, so that features stay in place.
// 3. cut: triangles by the signs of their corners; a crossed edge gets one vertex.
// 4. require_border: checks the conditions on the open boundary that half.h states.
#include "geom/mesh/half.h"

#include <algorithm>
#include <cmath>

#include "geom/base/error.h"
#include "geom/math/measures.h"
#include "geom/mesh/mirror_gap.h"
#include "geom/mesh/topology.h"

namespace sterna {
namespace {

constexpr double k_tolerance_share = 1e-6;  ///< relative to the longest side: files keep 6 to 7 digits
constexpr double k_max_turn_cosine = 0.94;  ///< 20 degrees: moves that turn a triangle by more would change the shape
constexpr double k_min_kept_area = 0.2;     ///< fraction of a triangle's area that must remain if one of its vertices moves

struct HalvingPlane {
  std::size_t axis = 1;
  double at = 0.0;
  double side = 1.0;  ///< +1: the side of larger coordinates is kept
  double tolerance = 0.0;
  std::string text() const {
    std::string number = std::to_string(at);
    number.erase(number.find_last_not_of('0') + 1);
    if (number.ends_with('.')) number.pop_back();
    return std::string(1, "xyz"[axis]) + " = " + (number == "-0" ? "0" : number) + " m";
  }
};

HalvingPlane plane_of(const TriMesh& surface, const HalfOptions& options) {
  HalfOptions copy = options;
  for (const Option& option : options_of(copy)) set_option(option, option.get());  // throws for values out of range
  const double length = bounding_box(surface).longest_side();
  return {.axis = static_cast<std::size_t>(options.axis.front() - 'x'),
          .at = options.at,
          .side = options.keep == "+" ? 1.0 : -1.0,
          .tolerance = is_automatic(options.tolerance) ? k_tolerance_share * length : options.tolerance};
}

/// The surface during the cut: vertices with distance zero lie exactly in the plane.
struct Cutting {
  TriMesh mesh;
  Column<VertexId, double> distance;  ///< metres, positive on the kept side
};

std::array<double, 3> distances(const Cutting& cutting, TriangleId t) {
  const TriangleVertices& v = cutting.mesh.triangles[t];
  return {cutting.distance[v[0]], cutting.distance[v[1]], cutting.distance[v[2]]};
}
bool is_in_plane(const std::array<double, 3>& d) { return d[0] == 0.0 && d[1] == 0.0 && d[2] == 0.0; }
bool is_kept_in_part(const std::array<double, 3>& d) { return d[0] > 0.0 || d[1] > 0.0 || d[2] > 0.0; }

Point crossing(const Point& a, const Point& b, double of_a, double of_b, const HalvingPlane& plane) {
  const double t = of_a / (of_a - of_b);
  Point p = a + t * (b - a);
  p[plane.axis] = plane.at;
  return p;
}

ErrorInfo error_at(const HalvingPlane& plane, ErrorCode code, std::string problem, std::string hint) {
  return {.code = code, .attempted = "half at " + plane.text(), .problem = std::move(problem), .hint = std::move(hint)};
}

Cutting place_vertices(const TriMesh& surface, const HalvingPlane& plane) {
  Cutting cutting{surface, {}};
  cutting.distance.resize(surface.n_vertices());
  for (const VertexId v : surface.points.ids()) {
    const double d = plane.side * (surface.points[v][plane.axis] - plane.at);
    cutting.distance[v] = std::abs(d) <= plane.tolerance ? 0.0 : d;
    if (cutting.distance[v] == 0.0) cutting.mesh.points[v][plane.axis] = plane.at;
  }
  ErrorInfo info =
      error_at(plane, ErrorCode::mesh_invalid, "moving vertices by up to " + std::to_string(plane.tolerance) + " m into the plane inverts triangles",
               "lower the tolerance of half");
  for (const TriangleId t : surface.triangles.ids()) {
    const auto d = distances(cutting, t);
    if (is_in_plane(d) || !is_kept_in_part(d) || (d[0] != 0.0 && d[1] != 0.0 && d[2] != 0.0)) continue;
    const auto [a, b, c] = corners(surface, t);
    const auto [p, q, r] = corners(cutting.mesh, t);
    if (dot(area_vector(a, b, c), area_vector(p, q, r)) <= 0.0 && norm(area_vector(a, b, c)) > 0.0)
      info.add_location(a, "triangle " + std::to_string(t.value()));
  }
  if (info.n_locations > 0) throw Error(std::move(info));
  return cutting;
}

/// Returns the cosine between the normals of the triangles at an edge: smaller means sharper; -1 on a boundary.
double fold_cosine(const TriMesh& mesh, const Topology& topology, HalfedgeId h) {
  const HalfedgeId twin = topology.twin(h);
  if (!twin.is_valid()) return -1.0;
  const auto [a, b, c] = corners(mesh, triangle_of(h));
  const auto [p, q, r] = corners(mesh, triangle_of(twin));
  return dot(normalized(cross(b - a, c - a)), normalized(cross(q - p, r - p)));
}

struct Move {
  VertexId vertex;
  Point to;
  double share = 0.0;  ///< distance of the move over the shortest edge
  double fold = 1.0;   ///< fold cosine of the edge along which it moves
};

/// Returns the move of a vertex if it has a crossed edge with the cut near enough. A vertex on an open boundary, which may lie in another plane, moves only
/// along that boundary.
/// \return a move with share above `limit` if there is none
Move propose(const Cutting& cutting, const Topology& topology, VertexId v, const HalvingPlane& plane, double limit) {
  Move best{.vertex = v, .to = {}, .share = 2.0 * limit, .fold = 2.0};
  const double d = cutting.distance[v];
  double shortest = 1e300;
  for (const VertexId u : topology.neighbours(v)) shortest = std::min(shortest, distance(cutting.mesh.points[v], cutting.mesh.points[u]));
  bool is_on_border = false;
  for (const HalfedgeId h : topology.outgoing(v)) is_on_border |= topology.is_boundary(h) || topology.is_boundary(previous(h));
  const auto consider = [&](HalfedgeId h, VertexId u) {
    if (cutting.distance[u] * d >= 0.0 || (is_on_border && !topology.is_boundary(h))) return;
    const Point to = crossing(cutting.mesh.points[v], cutting.mesh.points[u], d, cutting.distance[u], plane);
    const double share = distance(to, cutting.mesh.points[v]) / shortest;
    const double fold = fold_cosine(cutting.mesh, topology, h);
    if (share <= limit && (fold < best.fold || (fold == best.fold && share < best.share))) best = {v, to, share, fold};
  };
  for (const HalfedgeId h : topology.outgoing(v)) {
    consider(h, topology.to(h));
    if (topology.is_boundary(previous(h))) consider(previous(h), topology.from(previous(h)));
  }
  return best;
}

/// Returns true if no triangle at the vertex turns or shrinks too much, or falls into the plane.
bool is_move_harmless(const Cutting& cutting, const Topology& topology, const Move& move) {
  for (const HalfedgeId h : topology.outgoing(move.vertex)) {
    const Point& b = cutting.mesh.points[topology.to(h)];
    const Point& c = cutting.mesh.points[topology.from(previous(h))];
    if (cutting.distance[topology.to(h)] == 0.0 && cutting.distance[topology.from(previous(h))] == 0.0) return false;
    const Vec3 before = area_vector(cutting.mesh.points[move.vertex], b, c), after = area_vector(move.to, b, c);
    if (norm(after) < k_min_kept_area * norm(before) || dot(before, after) < k_max_turn_cosine * norm(before) * norm(after)) return false;
  }
  return true;
}

struct SnapReport {
  std::size_t n_moved = 0;
  double farthest = 0.0;  ///< m
};

/// Moves vertices into the plane, the nearest first, each tested with the current positions of its edges.
SnapReport snap_near_vertices(Cutting& cutting, const Topology& topology, const HalvingPlane& plane, double limit) {
  SnapReport report;
  std::vector<Move> moves;
  for (const VertexId v : cutting.mesh.points.ids()) {
    if (cutting.distance[v] == 0.0 || topology.outgoing(v).empty()) continue;
    if (const Move move = propose(cutting, topology, v, plane, limit); move.share <= limit) moves.push_back(move);
  }
  std::sort(moves.begin(), moves.end(), [](const Move& a, const Move& b) { return a.share < b.share || (a.share == b.share && a.vertex < b.vertex); });
  for (const Move& before : moves) {
    const Move move = propose(cutting, topology, before.vertex, plane, limit);
    if (move.share > limit || !is_move_harmless(cutting, topology, move)) continue;
    report.farthest = std::max(report.farthest, distance(move.to, cutting.mesh.points[move.vertex]));
    ++report.n_moved;
    cutting.mesh.points[move.vertex] = move.to;
    cutting.distance[move.vertex] = 0.0;
  }
  return report;
}

/// Crossed edges in ascending order, each with its lower vertex first. Each edge becomes a new vertex.
using EdgeList = std::vector<std::array<VertexId, 2>>;

EdgeList crossed_edges(const Cutting& cutting) {
  EdgeList edges;
  for (const TriangleVertices& t : cutting.mesh.triangles)
    for (std::size_t k = 0; k < 3; ++k) {
      const VertexId a = t[k], b = t[(k + 1) % 3];
      if (cutting.distance[a] * cutting.distance[b] < 0.0) edges.push_back({std::min(a, b), std::max(a, b)});
    }
  std::sort(edges.begin(), edges.end());
  edges.erase(std::unique(edges.begin(), edges.end()), edges.end());
  return edges;
}

/// Collects the part of each triangle that is kept: the triangle itself, a smaller triangle, or two triangles. Vertex numbers beyond those of the mesh stand
/// for crossed edges.
class Cutter {
 public:
  Cutter(const Cutting& cutting, const HalvingPlane& plane) : cutting_(cutting), edges_(crossed_edges(cutting)), points_(cutting.mesh.points) {
    for (const auto& [a, b] : edges_) points_.push_back(crossing(points_[a], points_[b], cutting.distance[a], cutting.distance[b], plane));
    for (const TriangleId t : cutting.mesh.triangles.ids()) cut(t);
  }

  /// Returns the result with the kept vertices and patches only.
  TriMesh take() const {
    TriMesh result;
    Column<VertexId, VertexId> old2new(points_.size());
    std::vector<std::uint8_t> is_used(points_.size(), 0), has_triangles(cutting_.mesh.patches.size(), 0);
    for (const TriangleVertices& t : triangles_)
      for (const VertexId v : t) is_used[v.index()] = 1;
    for (const VertexId v : points_.ids())
      if (is_used[v.index()]) old2new[v] = result.points.push_back(points_[v]);
    for (const PatchId patch : triangle_patch_) has_triangles[patch.index()] = 1;
    Column<PatchId, PatchId> old2new_patch(cutting_.mesh.patches.size());
    for (const PatchId patch : cutting_.mesh.patches.ids())
      if (has_triangles[patch.index()]) old2new_patch[patch] = result.patches.push_back(cutting_.mesh.patches[patch]);
    for (TriangleVertices t : triangles_) {
      for (VertexId& v : t) v = old2new[v];
      result.triangles.push_back(t);
    }
    for (const PatchId patch : triangle_patch_) result.triangle_patch.push_back(old2new_patch[patch]);
    return result;
  }
  std::size_t n_cut() const { return n_cut_; }

 private:
  VertexId on_edge(VertexId a, VertexId b) const {
    const auto it = std::lower_bound(edges_.begin(), edges_.end(), std::array<VertexId, 2>{std::min(a, b), std::max(a, b)});
    return VertexId(cutting_.mesh.n_vertices() + static_cast<std::size_t>(it - edges_.begin()));
  }
  void add(TriangleId of, VertexId a, VertexId b, VertexId c) {
    triangles_.push_back({a, b, c});
    triangle_patch_.push_back(cutting_.mesh.triangle_patch[of]);
  }
  void cut(TriangleId t) {
    const auto d = distances(cutting_, t);
    if (!is_kept_in_part(d)) return;
    const TriangleVertices& v = cutting_.mesh.triangles[t];
    // The polygon above the plane has three or four corners, in the order of the triangle.
    std::array<VertexId, 4> corner;
    std::size_t n = 0;
    for (std::size_t k = 0; k < 3; ++k) {
      const std::size_t next = (k + 1) % 3;
      if (d[k] >= 0.0) corner[n++] = v[k];
      if (d[k] * d[next] < 0.0) corner[n++] = on_edge(v[k], v[next]);
    }
    n_cut_ += d[0] < 0.0 || d[1] < 0.0 || d[2] < 0.0 ? 1 : 0;
    if (n == 3) return add(t, corner[0], corner[1], corner[2]);
    // A polygon of four corners is split by the shorter diagonal. If both are equal, the diagonal at the smaller vertex is used, so that the result does not
    // depend on the triangle's first corner.
    const double first = distance2(corner[0], corner[2]), second = distance2(corner[1], corner[3]);
    const bool is_first = first < second || (first == second && std::min(corner[0], corner[2]) < std::min(corner[1], corner[3]));
    add(t, corner[0], corner[1], corner[is_first ? 2 : 3]);
    add(t, corner[is_first ? 0 : 1], corner[2], corner[3]);
  }
  double distance2(VertexId a, VertexId b) const { return norm2(points_[b] - points_[a]); }

  const Cutting& cutting_;
  EdgeList edges_;
  Column<VertexId, Point> points_;
  std::vector<TriangleVertices> triangles_;
  std::vector<PatchId> triangle_patch_;
  std::size_t n_cut_ = 0;
};

void require_reach(const TriMesh& surface, const TriMesh& half, const HalvingPlane& plane) {
  if (half.n_triangles() > 0) {
    for (const Point& p : half.points)
      if (p[plane.axis] == plane.at) return;
  }
  VertexId nearest(0);
  const auto from_plane = [&](VertexId v) { return std::abs(surface.points[v][plane.axis] - plane.at); };
  for (const VertexId v : surface.points.ids())
    if (from_plane(v) < from_plane(nearest)) nearest = v;
  ErrorInfo info = error_at(plane, ErrorCode::bad_argument,
                            half.n_triangles() == 0 ? "no part of the surface is on the side that is kept"
                                                    : "the surface does not reach the plane: its nearest vertex is " + std::to_string(from_plane(nearest)) +
                                                          " m away, the tolerance is " + std::to_string(plane.tolerance) + " m",
                            "set axis, at and keep to the plane in which the model ends");
  info.add_location(surface.points[nearest], "nearest vertex");
  throw Error(std::move(info));
}

/// Returns true if the edge lies exactly in a plane of constant coordinate where the surface ends, and its triangle does not.
bool is_in_some_plane(const TriMesh& half, const Box& box, const Topology& topology, HalfedgeId h) {
  const Point &a = half.points[topology.from(h)], &b = half.points[topology.to(h)], &c = half.points[topology.from(previous(h))];
  for (std::size_t k = 0; k < 3; ++k)
    if (a[k] == b[k] && a[k] != c[k] && (a[k] == box.min[k] || a[k] == box.max[k])) return true;
  return false;
}

void require_border(const TriMesh& half, const HalvingPlane& plane, const RunContext& context) {
  const Topology topology(half, context);
  const Box box = bounding_box(half);
  std::vector<std::uint8_t> n_border_edges(half.n_vertices(), 0);
  ErrorInfo open = error_at(plane, ErrorCode::open_surface, "",
                            "close the holes beside the plane; the open boundary of a half model must be within the tolerance of the plane");
  ErrorInfo touching = error_at(plane, ErrorCode::non_manifold_surface, "", "move the plane a little, or lower tolerance and snap");
  std::size_t n_pinched = 0;
  for (std::size_t i = 0; i < topology.n_halfedges(); ++i) {
    const HalfedgeId h(i);
    if (!topology.is_boundary(h)) continue;
    const VertexId from = topology.from(h), to = topology.to(h);
    const bool is_in_this = half.points[from][plane.axis] == plane.at && half.points[to][plane.axis] == plane.at;
    if (!is_in_this && !is_in_some_plane(half, box, topology, h))
      open.add_location(0.5 * (half.points[from] + half.points[to]),
                        "an edge with one triangle, " + std::to_string(std::abs(half.points[from][plane.axis] - plane.at)) + " m from the plane");
    else if (++n_border_edges[from.index()] == 2) {
      ++n_pinched;
      touching.add_location(half.points[from], "the open boundary touches itself");
    }
  }
  if (open.n_locations > 0) {
    open.problem = "the open boundary is not closed in the plane: " + std::to_string(open.n_locations) +
                   " edges with one triangle lie neither in this plane nor in another plane x, y or z = constant where the surface ends";
    throw Error(std::move(open));
  }
  for (const VertexId v : half.points.ids())
    if (half.points[v][plane.axis] == plane.at && n_border_edges[v.index()] == 0)
      touching.add_location(half.points[v], "the surface touches the plane without crossing it");
  if (touching.n_locations == 0) return;
  touching.problem = std::to_string(n_pinched) + " vertices where the open boundary touches itself, " +
                     std::to_string(static_cast<std::size_t>(touching.n_locations) - n_pinched) + " where the surface touches the plane without crossing it";
  throw Error(std::move(touching));
}

/// Warns if the removed part is not the mirror image of the kept part: for example a deflected aileron, or a tail on one side.
void report_asymmetry(const TriMesh& surface, const HalvingPlane& plane, const RunContext& context) {
  constexpr double k_share_of_edge = 0.3, k_share_of_length = 3e-4;
  const MirrorGap gap = mirror_gap(surface, plane.axis, plane.at, k_share_of_edge, context);
  if (gap.distance <= k_share_of_length * bounding_box(surface).longest_side()) return;
  context.warn(describe_asymmetry(gap, plane.text()));
}

}  // namespace

TriMesh half_of(const TriMesh& surface, const HalfOptions& options, const RunContext& context, bool is_image_expected) {
  const HalvingPlane plane = plane_of(surface, options);
  if (surface.n_triangles() == 0) throw Error(error_at(plane, ErrorCode::empty_surface, "the surface has no triangles", ""));
  Cutting cutting = place_vertices(surface, plane);
  const SnapReport snapped = options.snap > 0.0 ? snap_near_vertices(cutting, Topology(surface, context), plane, options.snap) : SnapReport{};
  const Cutter cutter(cutting, plane);
  if (is_image_expected && std::ranges::any_of(cutting.distance, [](double d) { return d < 0.0; })) report_asymmetry(surface, plane, context);
  TriMesh half = cutter.take();
  require_reach(surface, half, plane);
  require_border(half, plane, context);
  context.debug("half at " + plane.text() + ": " + std::to_string(half.n_triangles()) + " of " + std::to_string(surface.n_triangles()) + " triangles, " +
                std::to_string(cutter.n_cut()) + " were cut; " + std::to_string(snapped.n_moved) + " vertices moved into the plane by up to " +
                std::to_string(snapped.farthest) + " m");
  return half;
}

TriMesh beyond_plane(const TriMesh& surface, const HalfOptions& options) {
  const HalvingPlane plane = plane_of(surface, options);
  TriMesh kept;
  kept.patches = surface.patches;
  kept.points = surface.points;
  const auto add = [&](const TriangleVertices& triangle, PatchId patch) {
    kept.triangles.push_back(triangle);
    kept.triangle_patch.push_back(patch);
  };
  for (const TriangleId t : surface.triangles.ids()) {
    const TriangleVertices& v = surface.triangles[t];
    std::array<double, 3> d{};
    for (std::size_t k = 0; k < 3; ++k) {
      d[k] = plane.side * (surface.points[v[k]][plane.axis] - plane.at);
      if (std::abs(d[k]) <= plane.tolerance) d[k] = 0.0;
    }
    if (!is_kept_in_part(d)) continue;
    if (d[0] >= 0.0 && d[1] >= 0.0 && d[2] >= 0.0) {
      add(v, surface.triangle_patch[t]);
      continue;
    }
    std::vector<VertexId> polygon;
    for (std::size_t k = 0; k < 3; ++k) {
      const std::size_t next = (k + 1) % 3;
      if (d[k] >= 0.0) polygon.push_back(v[k]);
      if (d[k] * d[next] < 0.0) polygon.push_back(kept.points.push_back(crossing(surface.points[v[k]], surface.points[v[next]], d[k], d[next], plane)));
    }
    for (std::size_t k = 1; k + 1 < polygon.size(); ++k) add({polygon[0], polygon[k], polygon[k + 1]}, surface.triangle_patch[t]);
  }
  return kept;
}

}  // namespace sterna
