// Passes that insert vertices: unfolding, size, quality. Each is a task of refine (geom/delaunay/refinement_queue.h).
#include <algorithm>
#include <cmath>
#include <numbers>

#include "geom/base/error.h"
#include "geom/delaunay/face_passes.h"
#include "geom/delaunay/planar.h"
#include "geom/delaunay/refinement_queue.h"

namespace sterna::delaunay {
namespace {

/// A triangle follows the surface if its normal is within 40 degrees of the surface's (flips may rotate it by up to 60) and its sag is below k_max_sag.
constexpr double k_unfolded_cosine = 0.766;
/// Largest sag: distance of the surface point at the triangle's centre from its plane, relative to its longest edge.
constexpr double k_max_sag = 0.2;
/// Unfolding continues only for triangles larger than this multiple of the target edge length: smaller ones have the requested size.
constexpr double k_unfold_floor = 0.7;
/// Unfolding inserts no vertex nearer to another one than this fraction of the target edge length.
constexpr double k_unfold_spacing = 0.3;
/// Circumradius relative to that of an equilateral triangle with the target edges, above which a triangle gets a vertex: that of a right angle between two
/// target edges, so that the triangles of a regular lattice are not refined where it is bent (Rebay 1993).
constexpr double k_size_threshold = 1.2247;
constexpr double k_size_threshold2 = k_size_threshold * k_size_threshold;
/// Minimum distance of a new vertex from others, relative to the target length.
constexpr double k_min_spacing = 0.65;
/// The same in the second pass, which improves angles and therefore permits nearer vertices.
constexpr double k_min_spacing_for_quality = 0.5;
/// The front's edge length changes by at most this factor from one layer to the next, so sizes change gradually.
constexpr double k_front_growth = 1.5;
constexpr double k_front_shrink = 0.7;
/// Tolerance of a position, relative to the edge length. For the apexes of the first pass it must be smaller, since errors accumulate from layer to layer: with
/// 0.02, 92 % of the vertices of a bicubic bump have six neighbours, with 0.002 96 %, and Newton's method rarely needs an additional step.
constexpr double k_location_tolerance = 0.15;
constexpr double k_apex_tolerance = 0.002;

struct Triangle {
  std::array<VertexId, 3> v;
  std::array<Point, 3> p;
  std::array<double, 3> edge2;  ///< squared length of the edge from corner k to k + 1
  double size;                  ///< mean target length of the corners
};

Triangle gather(const FaceState& state, TriangleId t) {
  Triangle tri;
  tri.v = state.mesh.mesh.cells[t].vertex;
  for (std::size_t k = 0; k < 3; ++k) tri.p[k] = state.mesh.points[tri.v[k]];
  for (std::size_t k = 0; k < 3; ++k) tri.edge2[k] = norm2(tri.p[(k + 1) % 3] - tri.p[k]);
  tri.size = (state.size[tri.v[0]] + state.size[tri.v[1]] + state.size[tri.v[2]]) / 3.0;
  return tri;
}

/// Returns the squared circumradius.
double circumradius2(const Triangle& tri) {
  const double area2 = norm2(cross(tri.p[1] - tri.p[0], tri.p[2] - tri.p[0]));
  return area2 > 0.0 ? tri.edge2[0] * tri.edge2[1] * tri.edge2[2] / (4.0 * area2) : std::numeric_limits<double>::infinity();
}

/// Returns the square of the circumradius relative to that of the equilateral triangle of the target size.
double size_ratio2(const Triangle& tri) { return 3.0 * circumradius2(tri) / (tri.size * tri.size); }

/// Proposes the point above the middle of edge k at `height` metres towards its apex: parameters by the linear map of the triangle, then projected to the
/// surface.
void propose_over_edge(const FaceState& state, const Triangle& tri, std::size_t k, double height, double spacing, Proposal& proposal) {
  const std::size_t l = (k + 1) % 3, m = (k + 2) % 3;
  const Vec3 along = tri.p[l] - tri.p[k];
  const Vec3 middle = 0.5 * (tri.p[k] + tri.p[l]);
  const Vec3 to_apex = tri.p[m] - middle;
  const double share = dot(to_apex, along) / tri.edge2[k];
  const Vec3 up = to_apex - share * along;
  const double apex_height = norm(up);
  const double ratio = apex_height > 0.0 ? height / apex_height : 0.0;
  const Uv a = state.mesh.parameters(tri.v[k]), b = state.mesh.parameters(tri.v[l]), c = state.mesh.parameters(tri.v[m]);
  const Uv uv_middle = 0.5 * (a + b);
  const Uv uv_up = c - uv_middle - share * (b - a);
  proposal.at = approach(state, middle + ratio * up, uv_middle + ratio * uv_up, k_location_tolerance * spacing, proposal.sample);
}

/// Proposes the apex of an isosceles triangle on edge k of exactly this height: the direction is along the surface at the edge, not in the plane of a triangle
/// that may be much too large.
void propose_apex(const FaceState& state, const Triangle& tri, std::size_t k, double height, double spacing, Proposal& proposal) {
  const VertexId a = tri.v[k], b = tri.v[(k + 1) % 3];
  const SurfaceFrame &frame_a = state.mesh.frames[a], &frame_b = state.mesh.frames[b];
  const Vec3 along = tri.p[(k + 1) % 3] - tri.p[k];
  const Vec3 up = cross(frame_a.normal + frame_b.normal, along);
  const double length = norm(up);
  // At poles the frame is undefined.
  if (length == 0.0 || norm2(frame_a.normal) == 0.0 || norm2(frame_b.normal) == 0.0) return propose_over_edge(state, tri, k, height, spacing, proposal);
  const Vec3 step = (height / length) * up;
  const Uv guess = 0.5 * (state.mesh.parameters(a) + state.mesh.parameters(b) + parameter_step(frame_a, step) + parameter_step(frame_b, step));
  proposal.at = approach(state, 0.5 * (tri.p[k] + tri.p[(k + 1) % 3]) + step, guess, k_apex_tolerance * spacing, proposal.sample);
}

/// Returns the signed height of the circumcentre over the middle of edge k.
double centre_height(const Triangle& tri, std::size_t k) {
  const std::size_t l = (k + 1) % 3, m = (k + 2) % 3;
  const Vec3 a = tri.p[k] - tri.p[m], b = tri.p[l] - tri.p[m];
  const double area = norm(cross(a, b));
  // Half the edge times the cotangent of the opposite angle.
  return area > 0.0 ? 0.5 * std::sqrt(tri.edge2[k]) * dot(a, b) / area : 0.0;
}

struct UnfoldTask {
  FaceState& state;

  void measure(const SurfaceTriangulation&, TriangleId) const {}
  double priority(const SurfaceTriangulation& mesh, TriangleId t) const {
    const Triangle tri = gather(state, t);
    const Uv a = mesh.parameters(tri.v[0]), b = mesh.parameters(tri.v[1]), c = mesh.parameters(tri.v[2]);
    const SurfaceSample middle = sample(state.surface, (1.0 / 3.0) * (a + b + c));
    double reach2 = std::max({tri.edge2[0], tri.edge2[1], tri.edge2[2]});
    for (const Point& p : tri.p) reach2 = std::max(reach2, norm2(p - middle.point));
    const double reach = std::sqrt(reach2);
    if (reach < k_unfold_floor * tri.size) return 0.0;
    const Vec3 normal = normalized(cross(tri.p[1] - tri.p[0], tri.p[2] - tri.p[0]));
    bool is_unfolded = std::abs(dot(middle.point - tri.p[0], normal)) < k_max_sag * reach;
    const auto follows = [&](const Vec3& along) { return norm2(along) == 0.0 || dot(normal, along) > k_unfolded_cosine; };
    is_unfolded = is_unfolded && follows(middle.frame.normal);
    for (const VertexId v : tri.v) is_unfolded = is_unfolded && follows(mesh.frames[v].normal);
    return is_unfolded ? 0.0 : reach;
  }
  /// Proposes the middle of the longest free edge in the plane; the centre of the triangle if all edges are constrained.
  bool propose(const SurfaceTriangulation& mesh, TriangleId t, Proposal& proposal) const {
    const auto& v = mesh.mesh.cells[t].vertex;
    const Uv corner[3] = {mesh.parameters(v[0]), mesh.parameters(v[1]), mesh.parameters(v[2])};
    proposal.at = (1.0 / 3.0) * (corner[0] + corner[1] + corner[2]);
    double longest = 0.0;
    for (std::uint32_t c = 0; c < 3; ++c) {
      if ((mesh.mesh.cells[t].flags[c] & k_constrained) != 0) continue;
      const Vec2 &p = mesh.mesh.uv[v[c]], &q = mesh.mesh.uv[v[(c + 1) % 3]];
      const double length = std::hypot(q.x - p.x, q.y - p.y);
      if (length > longest) {
        longest = length;
        proposal.at = 0.5 * (corner[c] + corner[(c + 1) % 3]);
      }
    }
    proposal.sample = sample(state.surface, proposal.at);
    // A part of the surface that is thinner than the target edges (a round tip that ends at a sharp trailing edge) cannot be resolved: it remains a strip.
    proposal.min_distance = k_unfold_spacing * gather(state, t).size;
    return true;
  }
  void inserted(const SurfaceTriangulation&, VertexId, const Proposal& proposal) const {
    state.size.push_back(target_size(state, proposal.at, proposal.sample.point));
  }
};

/// Stores the target length at a new vertex: that of its location, limited by the growth from its neighbours.
void push_graded_size(FaceState& state, VertexId p, const Proposal& proposal) {
  double size = proposal.size;
  for_star(state.mesh.mesh, p, [&](HalfedgeId h) {
    const VertexId q = state.mesh.mesh.target(h);
    size = std::min(size, state.size[q] + state.options.size_growth * distance(state.mesh.points[q], proposal.sample.point));
  });
  state.size.push_back(size);
}

/// Triangles are processed by largest circumradius relative to their target size: fronts then advance where there is most room, keep their shape and meet along
/// few lines. (In order of creation, dents of a front grow from layer to layer, and every third vertex has five or seven neighbours.)
struct SizeTask {
  FaceState& state;
  bool is_front;                        ///< true: vertices are proposed only beside edges of the target length
  Column<TriangleId, double> ratio2{};  ///< size_ratio2 of every triangle; infinite for flat ones

  void measure(const SurfaceTriangulation& mesh, TriangleId t) {
    if (t.index() >= ratio2.size()) ratio2.resize(mesh.mesh.cells.size(), 0.0);
    ratio2[t] = mesh.is_flat(t) ? std::numeric_limits<double>::infinity() : size_ratio2(gather(state, t));
  }
  bool is_done(HalfedgeId out) const { return !out.is_valid() || ratio2[triangle_of(out)] <= k_size_threshold2; }
  double priority(const SurfaceTriangulation& mesh, TriangleId t) const {
    if (ratio2[t] <= k_size_threshold2) return 0.0;
    const auto& twin = mesh.mesh.cells[t].twin;
    if (is_front && !is_done(twin[0]) && !is_done(twin[1]) && !is_done(twin[2])) return 0.0;
    return std::min(ratio2[t], 1e18);
  }
  bool propose(const SurfaceTriangulation& mesh, TriangleId t, Proposal& proposal) const {
    const Triangle tri = gather(state, t);
    // Selects the shortest edge; in a front, the shortest edge beside a finished triangle.
    std::size_t k = 3;
    for (std::uint32_t c = 0; c < 3; ++c)
      if ((k == 3 || tri.edge2[c] < tri.edge2[k]) && (!is_front || is_done(mesh.mesh.cells[t].twin[c]))) k = c;
    const double edge = std::sqrt(tri.edge2[k]);
    const double size = 0.5 * (state.size[tri.v[k]] + state.size[tri.v[(k + 1) % 3]]);
    const double side = std::clamp(size, k_front_shrink * edge, k_front_growth * edge);
    const double ideal = std::sqrt(std::max(side * side - 0.25 * edge * edge, 0.25 * edge * edge));
    const double centre = centre_height(tri, k);
    const double height = centre > 0.0 ? std::min(ideal, centre) : ideal;
    if (is_front) propose_apex(state, tri, k, height, side, proposal);
    else propose_over_edge(state, tri, k, height, side, proposal);
    proposal.size = target_size(state, proposal.at, proposal.sample.point);
    proposal.min_distance = k_min_spacing * std::min(side, proposal.size);
    return true;
  }
  void inserted(const SurfaceTriangulation&, VertexId p, const Proposal& proposal) const { push_graded_size(state, p, proposal); }
};

struct QualityTask {
  FaceState& state;
  double worst_allowed;  ///< cotangent

  void measure(const SurfaceTriangulation&, TriangleId) const {}
  double priority(const SurfaceTriangulation&, TriangleId t) const {
    const Triangle tri = gather(state, t);
    const double worst = worst_cotangent(tri.p[0], tri.p[1], tri.p[2]);
    return worst > worst_allowed ? std::min(worst, 1e9) : 0.0;
  }
  bool propose(const SurfaceTriangulation&, TriangleId t, Proposal& proposal) const {
    const Triangle tri = gather(state, t);
    const auto k = static_cast<std::size_t>(std::min_element(tri.edge2.begin(), tri.edge2.end()) - tri.edge2.begin());
    const double edge = std::sqrt(tri.edge2[k]);
    // Off-centre: the new triangle on the shortest edge just meets the target angle.
    const double height = std::min(centre_height(tri, k), 0.5 * edge / std::tan(0.5 * state.options.min_angle));
    propose_over_edge(state, tri, k, height, edge, proposal);
    proposal.size = target_size(state, proposal.at, proposal.sample.point);
    proposal.min_distance = std::max(0.9 * edge, k_min_spacing_for_quality * proposal.size);
    return true;
  }
  void inserted(const SurfaceTriangulation&, VertexId p, const Proposal& proposal) const { push_graded_size(state, p, proposal); }
};

std::size_t insertions_left(const FaceState& state) {
  // A vertex creates two triangles.
  const auto limit = static_cast<std::size_t>(state.options.max_triangles);
  const std::size_t n = state.mesh.mesh.n_triangles();
  return limit > n ? (limit - n) / 2 : 0;
}

void count(FaceState& state, const RefineReport& done, FaceMeshReport& report) {
  report.n_refused += static_cast<std::int64_t>(done.n_too_near + done.n_beyond_border + done.n_folded);
  if (!done.is_limit_met) return;
  const VertexId last(static_cast<std::uint64_t>(state.mesh.points.size() - 1));
  ErrorInfo info{.code = ErrorCode::overflow,
                 .attempted = "meshing a face",
                 .problem = "the limit of " + std::to_string(state.options.max_triangles) +
                            " triangles (max_triangles) is reached before the edges have their target length"};
  info.locations.push_back({state.mesh.points[last], "target edge length here: " + std::to_string(state.size[last]) + " m"});
  info.hint = "a larger max_edge, min_edge or curvature_angle, or a higher limit";
  throw Error(std::move(info));
}

}  // namespace

void unfold(FaceState& state, FaceMeshReport& report, const RunContext& context) {
  UnfoldTask task{state};
  const RefineReport done = refine<false>(state.mesh, PlanarCriterion{}, task, insertions_left(state), context);
  count(state, done, report);
  report.n_unfolding += static_cast<std::int64_t>(done.n_inserted);
  report.n_flips += static_cast<std::int64_t>(flip_all(state.mesh));
}

void refine_by_size(FaceState& state, FaceMeshReport& report, const RunContext& context) {
  for (const bool is_front : {true, false}) {
    SizeTask task{state, is_front};
    const RefineReport done = refine<true>(state.mesh, SphereCriterion{&state.mesh.points, &state.mesh.frames}, task, insertions_left(state), context);
    count(state, done, report);
    report.n_first_pass += static_cast<std::int64_t>(done.n_inserted);
  }
}

void refine_by_quality(FaceState& state, FaceMeshReport& report, const RunContext& context) {
  if (state.options.min_angle <= 0.0) return;
  QualityTask task{state, 1.0 / std::tan(state.options.min_angle)};
  const RefineReport done = refine<true>(state.mesh, SphereCriterion{&state.mesh.points, &state.mesh.frames}, task, insertions_left(state), context);
  count(state, done, report);
  report.n_second_pass += static_cast<std::int64_t>(done.n_inserted);
}

}  // namespace sterna::delaunay
