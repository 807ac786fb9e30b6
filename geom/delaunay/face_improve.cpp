// Passes that insert nothing: collapses and smoothing.
#include <algorithm>
#include <cmath>
#include <numbers>

#include "geom/delaunay/face_passes.h"

namespace sterna::delaunay {
namespace {

/// Edges shorter than this fraction of the target length are collapsed.
constexpr double k_short = 0.5;
/// Cotangent of 30 degrees: smallest angle that a collapse may create.
constexpr double k_collapse_cotangent = 1.732;
/// Cotangent of 25 degrees. A vertex with a smaller angle is removed if that improves its neighbourhood.
constexpr double k_steep_cotangent = 2.14;
/// Cotangent of 42 degrees: below this angle a move must increase the smallest angle of a star, above it only the mean shape.
constexpr double k_poor_cotangent = 1.11;
/// Cotangent of 55 degrees: a star without smaller angles is not changed.
constexpr double k_good_cotangent = 0.7;
/// Minimum relative decrease of the worst cotangent of a star for a move.
constexpr double k_min_gain = 0.01;
/// Minimum decrease of the sum of shapes of a star.
constexpr double k_min_shape_gain = 0.003;

/// Returns the worst cotangent of the star of v with v at `at`; infinite if a triangle's normal would be opposed to the surface normal there.
double worst_of_star(const SurfaceTriangulation& mesh, VertexId v, const Point& at, const Vec3& normal) {
  double worst = 0.0;
  for_star(mesh.mesh, v, [&](HalfedgeId h) {
    if (mesh.is_flat(triangle_of(h))) return;
    const Point &x = mesh.points[mesh.mesh.target(h)], &y = mesh.points[mesh.mesh.apex(h)];
    if (dot(cross(x - at, y - at), normal) <= 0.0) worst = std::numeric_limits<double>::infinity();
    worst = std::max(worst, worst_cotangent(at, x, y));
  });
  return worst;
}

/// The triangles of a star that are not flat, given by their outer edges.
struct Ring {
  struct Side {
    Point x, y;
    double length2;
  };
  std::vector<Side> sides;
};

void gather(const SurfaceTriangulation& mesh, VertexId v, Ring& ring) {
  ring.sides.clear();
  for_star(mesh.mesh, v, [&](HalfedgeId h) {
    if (mesh.is_flat(triangle_of(h))) return;
    const Point &x = mesh.points[mesh.mesh.target(h)], &y = mesh.points[mesh.mesh.apex(h)];
    ring.sides.push_back({x, y, norm2(y - x)});
  });
}

struct StarQuality {
  double worst = 0.0;  ///< cotangent
  double shape = 0.0;  ///< sum of squared edges over area, 1 for each equilateral triangle
};

/// Returns the quality with the centre at `at`; infinite if a triangle's normal would be opposed to the surface normal there.
StarQuality quality_of(const Ring& ring, const Point& at, const Vec3& normal) {
  constexpr double k_shape = 0.5 / std::numbers::sqrt3;
  StarQuality q;
  for (const Ring::Side& side : ring.sides) {
    const Vec3 a = side.x - at, b = side.y - at;
    const Vec3 n = cross(a, b);
    if (dot(n, normal) <= 0.0) return {std::numeric_limits<double>::infinity(), std::numeric_limits<double>::infinity()};
    const double ab = dot(a, b), aa = norm2(a), bb = norm2(b), over_area = 1.0 / norm(n);
    q.worst = std::max(q.worst, std::max({ab, aa - ab, bb - ab}) * over_area);
    q.shape += k_shape * (aa + bb + side.length2) * over_area;
  }
  return q;
}

bool is_better(const StarQuality& before, const StarQuality& after) {
  if (before.worst > k_poor_cotangent) return after.worst < (1.0 - k_min_gain) * before.worst;
  return after.worst <= k_poor_cotangent && after.shape < before.shape - k_min_shape_gain;
}

/// Returns the mean of the positions that would make each triangle of the star equilateral on its outer edge.
Point ideal_location(const Ring& ring, const Point& at) {
  Vec3 sum{};
  double n = 0.0;
  for (const Ring::Side& side : ring.sides) {
    if (side.length2 == 0.0) continue;
    const Vec3 middle = 0.5 * (side.x + side.y), along = side.y - side.x;
    Vec3 up = at - middle;
    up -= (dot(up, along) / side.length2) * along;
    const double height2 = norm2(up);
    sum += middle;
    if (height2 > 0.0) sum += std::sqrt(0.75 * side.length2 / height2) * up;
    n += 1.0;
  }
  return n > 0.0 ? sum / n : at;
}

/// One step of Newton's method on the sum of shapes, which is convex in the tangent plane (a square over a linear function for each triangle).
struct ShapeStep {
  Vec3 step;          ///< metres, along the surface
  double gain = 0.0;  ///< decrease of the sum
};

ShapeStep shape_step(const Ring& ring, const Point& at, const SurfaceFrame& frame) {
  constexpr double k_shape = 0.5 / std::numbers::sqrt3;
  const Vec3 t1 = normalized(frame.du), t2 = cross(frame.normal, t1);
  double g1 = 0.0, g2 = 0.0, h11 = 0.0, h12 = 0.0, h22 = 0.0;
  for (const Ring::Side& side : ring.sides) {
    const Vec3 a = side.x - at, b = side.y - at;
    const double a1 = dot(a, t1), a2 = dot(a, t2), b1 = dot(b, t1), b2 = dot(b, t2);
    const double r = 1.0 / (a1 * b2 - a2 * b1);  // reciprocal of twice the area
    if (!(r > 0.0)) return {};
    // f = q r, where q is the sum of the squared edges. (q1, q2) is the gradient of q, and (w1, w2) that of twice the area.
    const double f = r * (a1 * a1 + a2 * a2 + b1 * b1 + b2 * b2 + side.length2);
    const double q1 = -2.0 * (a1 + b1), q2 = -2.0 * (a2 + b2), w1 = a2 - b2, w2 = b1 - a1;
    g1 += r * (q1 - f * w1);
    g2 += r * (q2 - f * w2);
    h11 += r * (4.0 - 2.0 * r * w1 * (q1 - f * w1));
    h12 += r * r * (2.0 * f * w1 * w2 - q1 * w2 - q2 * w1);
    h22 += r * (4.0 - 2.0 * r * w2 * (q2 - f * w2));
  }
  const double det = h11 * h22 - h12 * h12;
  if (!(det > 0.0)) return {};
  const double d1 = (h12 * g2 - h22 * g1) / det, d2 = (h12 * g1 - h11 * g2) / det;
  return {d1 * t1 + d2 * t2, -0.5 * k_shape * (g1 * d1 + g2 * d2)};
}

/// Tries to move v; returns true if it was moved.
bool improve_location(FaceState& state, VertexId v, Ring& ring) {
  SurfaceTriangulation& mesh = state.mesh;
  const SurfaceFrame frame = mesh.frames[v];
  if (norm2(frame.normal) == 0.0) return false;
  const Point at = mesh.points[v];
  gather(mesh, v, ring);
  const StarQuality before = quality_of(ring, at, frame.normal);
  if (before.worst <= k_good_cotangent) return false;
  const Uv from = mesh.parameters(v);
  const auto move_by = [&](const Vec3& way) {
    const Uv to = from + parameter_step(frame, way);
    const SurfaceSample there = sample(state.surface, to);
    return is_better(before, quality_of(ring, there.point, there.frame.normal)) && move_vertex(mesh, v, to, there);
  };
  if (before.worst <= k_poor_cotangent) {
    const ShapeStep shape = shape_step(ring, at, frame);
    return shape.gain > k_min_shape_gain && move_by(shape.step);
  }
  return move_by(ideal_location(ring, at) - at) || move_by(shape_step(ring, at, frame).step);
}

int valence(const SurfaceTriangulation& mesh, VertexId v) {
  int n = 0;
  for_star(mesh.mesh, v, [&](HalfedgeId) { ++n; });
  return n;
}

void flip_at(FaceState& state, VertexId v, std::vector<HalfedgeId>& work, std::vector<TriangleId>& touched, FaceMeshReport& report) {
  work.clear();
  touched.clear();
  for_star(state.mesh.mesh, v, [&](HalfedgeId h) {
    work.push_back(h);
    work.push_back(next(h));
  });
  report.n_flips += static_cast<std::int64_t>(flip_around(state.mesh, work, touched));
}

}  // namespace

void collapse_short_edges(FaceState& state, FaceMeshReport& report, const RunContext& context) {
  context.check_stop();
  SurfaceTriangulation& mesh = state.mesh;
  std::vector<HalfedgeId> work;
  std::vector<TriangleId> touched;
  for (std::uint32_t i = mesh.n_border; i < mesh.points.size(); ++i) {
    const VertexId v(i);
    if (!mesh.mesh.outgoing[v].is_valid()) continue;
    HalfedgeId shortest;
    double length2 = std::numeric_limits<double>::infinity();
    for_star(mesh.mesh, v, [&](HalfedgeId h) {
      const double l2 = norm2(mesh.points[mesh.mesh.target(h)] - mesh.points[v]);
      if (l2 < length2) {
        length2 = l2;
        shortest = h;
      }
    });
    const VertexId other = mesh.mesh.target(shortest);
    if (length2 >= k_short * k_short * state.size[v] * state.size[other]) continue;
    if (!collapse_edge(mesh, shortest, k_collapse_cotangent)) continue;
    ++report.n_collapses;
    if (!mesh.is_border(other)) flip_at(state, other, work, touched, report);
  }
}

void remove_poor_vertices(FaceState& state, FaceMeshReport& report) {
  SurfaceTriangulation& mesh = state.mesh;
  std::vector<HalfedgeId> edges, work;
  std::vector<TriangleId> touched;
  for (std::uint32_t i = mesh.n_border; i < mesh.points.size(); ++i) {
    const VertexId v(i);
    if (!mesh.mesh.outgoing[v].is_valid()) continue;
    const double before = worst_of_star(mesh, v, mesh.points[v], mesh.frames[v].normal);
    if (before < k_steep_cotangent && valence(mesh, v) > 4) continue;
    // Collapse to the neighbour that leaves the best triangles.
    double best = (1.0 - k_min_gain) * before;
    VertexId target;
    for_star(mesh.mesh, v, [&](HalfedgeId h) {
      const double after = worst_after_collapse(mesh, h);
      if (!(after < best)) return;
      best = after;
      target = mesh.mesh.target(h);
    });
    if (!target.is_valid() || !collapse_edge(mesh, find_edge(mesh.mesh, v, target), best)) continue;
    ++report.n_collapses;
    if (!mesh.is_border(target)) flip_at(state, target, work, touched, report);
  }
}

void smooth(FaceState& state, FaceMeshReport& report, const RunContext& context) {
  SurfaceTriangulation& mesh = state.mesh;
  std::vector<std::uint8_t> is_active(mesh.points.size(), 0), has_moved(mesh.points.size(), 0);
  const auto activate = [&](TriangleId t) {
    for (const VertexId w : mesh.mesh.cells[t].vertex) is_active[w.index()] = 1;
  };
  for (const TriangleId t : mesh.mesh.cells.ids()) {
    if (mesh.mesh.cells[t].is_dead || mesh.is_flat(t)) continue;
    const auto& v = mesh.mesh.cells[t].vertex;
    if (worst_cotangent(mesh.points[v[0]], mesh.points[v[1]], mesh.points[v[2]]) > k_good_cotangent) activate(t);
  }
  std::vector<HalfedgeId> work;
  std::vector<TriangleId> touched;
  Ring ring;
  for (int sweep = 0; sweep < state.options.smoothing_sweeps; ++sweep) {
    context.check_stop();
    std::int64_t n_moved = 0;
    std::fill(has_moved.begin(), has_moved.end(), 0);
    for (std::uint32_t i = mesh.n_border; i < mesh.points.size(); ++i) {
      const VertexId v(i);
      if (is_active[i] == 0 || !mesh.mesh.outgoing[v].is_valid()) continue;
      is_active[i] = 0;
      if (!improve_location(state, v, ring)) continue;
      ++n_moved;
      has_moved[i] = 1;
    }
    report.n_moves += n_moved;
    if (n_moved == 0) break;
    work.clear();
    touched.clear();
    for (const TriangleId t : mesh.mesh.cells.ids()) {
      const Cell& cell = mesh.mesh.cells[t];
      if (cell.is_dead) continue;
      if (!has_moved[cell.vertex[0].index()] && !has_moved[cell.vertex[1].index()] && !has_moved[cell.vertex[2].index()]) continue;
      activate(t);
      for (std::uint32_t c = 0; c < 3; ++c)
        if (const HalfedgeId h = halfedge(t, c); cell.twin[c].is_valid() && (h < cell.twin[c] || !has_moved[mesh.mesh.apex(cell.twin[c]).index()]))
          work.push_back(h);
    }
    report.n_flips += static_cast<std::int64_t>(flip_around(mesh, work, touched));
    for (const TriangleId t : touched) activate(t);
  }
}

}  // namespace sterna::delaunay
