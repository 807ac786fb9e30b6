// Passes that insert nothing: collapses and smoothing.
#include <algorithm>
#include <cmath>
#include <numbers>

#include "surfmesh/face/face_passes.h"

namespace sterna::surfmesh {
namespace {

using delaunay::SurfaceTriangulation;

/// Edges shorter than this part of the wanted length go.
constexpr double k_short = 0.5;
/// Cotangent of 30 degrees: a collapse may make no smaller angle.
constexpr double k_collapse_cotangent = 1.732;
/// Cotangent of 42 degrees: a star with no smaller angle stays where it is.
constexpr double k_good_cotangent = 1.11;
/// By this part of itself the worst cotangent of a star must fall, or the move is not worth it.
constexpr double k_min_gain = 0.01;
/// Of the way to where the triangles would be equilateral: the whole of it, then half, are tried.
constexpr double k_steps[] = {1.0, 0.4};

/// Height of the equilateral triangle on an edge.
double equilateral_height(const Vec3& along) { return 0.5 * std::numbers::sqrt3 * norm(along); }

/// Worst cotangent of the star of v with v at `at`, infinite when a triangle would look against its normal there.
double worst_of_star(const SurfaceTriangulation& mesh, VertexId v, const Point& at, const Vec3& normal) {
  double worst = 0.0;
  delaunay::for_star(mesh.mesh, v, [&](HalfedgeId h) {
    if (mesh.is_flat(delaunay::triangle_of(h))) return;
    const Point &x = mesh.points[mesh.mesh.target(h)], &y = mesh.points[mesh.mesh.apex(h)];
    if (dot(cross(x - at, y - at), normal) <= 0.0) worst = std::numeric_limits<double>::infinity();
    worst = std::max(worst, delaunay::worst_cotangent(at, x, y));
  });
  return worst;
}

/// Mean of the places that would make each triangle of the star equilateral on its outer edge.
Point ideal_place(const SurfaceTriangulation& mesh, VertexId v) {
  const Point& at = mesh.points[v];
  Vec3 sum{};
  double n = 0.0;
  delaunay::for_star(mesh.mesh, v, [&](HalfedgeId h) {
    if (mesh.is_flat(delaunay::triangle_of(h))) return;
    const Point &x = mesh.points[mesh.mesh.target(h)], &y = mesh.points[mesh.mesh.apex(h)];
    const Vec3 middle = 0.5 * (x + y), along = y - x;
    const double length2 = norm2(along);
    if (length2 == 0.0) return;
    Vec3 up = at - middle;
    up -= (dot(up, along) / length2) * along;
    sum += middle + equilateral_height(along) * normalized(up);
    n += 1.0;
  });
  return n > 0.0 ? sum / n : at;
}

/// Tries to move v; true when it did.
bool improve_place(FaceState& state, VertexId v) {
  SurfaceTriangulation& mesh = state.mesh;
  const delaunay::SurfaceFrame& frame = mesh.frames[v];
  if (norm2(frame.normal) == 0.0) return false;
  const Point at = mesh.points[v];
  const double before = worst_of_star(mesh, v, at, frame.normal);
  if (before <= k_good_cotangent) return false;
  const Vec3 way = ideal_place(mesh, v) - at;
  const Uv step = parameter_step(frame, way), from = mesh.parameters(v);
  for (const double share : k_steps) {
    const Uv to = from + share * step;
    const delaunay::SurfaceSample there = sample(state.surface, to);
    const double after = worst_of_star(mesh, v, there.point, there.frame.normal);
    if (after < (1.0 - k_min_gain) * before && delaunay::move_vertex(mesh, v, to, there)) return true;
  }
  return false;
}

int valence(const SurfaceTriangulation& mesh, VertexId v) {
  int n = 0;
  delaunay::for_star(mesh.mesh, v, [&](HalfedgeId) { ++n; });
  return n;
}

void flip_at(FaceState& state, VertexId v, std::vector<HalfedgeId>& work, std::vector<TriangleId>& touched, FaceMeshReport& report) {
  work.clear();
  touched.clear();
  delaunay::for_star(state.mesh.mesh, v, [&](HalfedgeId h) {
    work.push_back(h);
    work.push_back(delaunay::next(h));
  });
  report.n_flips += static_cast<std::int64_t>(delaunay::flip_around(state.mesh, work, touched));
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
    delaunay::for_star(mesh.mesh, v, [&](HalfedgeId h) {
      const double l2 = norm2(mesh.points[mesh.mesh.target(h)] - mesh.points[v]);
      if (l2 < length2) {
        length2 = l2;
        shortest = h;
      }
    });
    const VertexId other = mesh.mesh.target(shortest);
    if (length2 >= k_short * k_short * state.size[v] * state.size[other]) continue;
    if (!delaunay::collapse_edge(mesh, shortest, k_collapse_cotangent)) continue;
    ++report.n_collapses;
    if (!mesh.is_border(other)) flip_at(state, other, work, touched, report);
  }
}

void remove_poor_vertices(FaceState& state, FaceMeshReport& report) {
  SurfaceTriangulation& mesh = state.mesh;
  std::vector<HalfedgeId> edges;
  for (std::uint32_t i = mesh.n_border; i < mesh.points.size(); ++i) {
    const VertexId v(i);
    if (!mesh.mesh.outgoing[v].is_valid()) continue;
    const int n = valence(mesh, v);
    if (n > 4) continue;
    const double before = worst_of_star(mesh, v, mesh.points[v], mesh.frames[v].normal);
    edges.clear();
    delaunay::for_star(mesh.mesh, v, [&](HalfedgeId h) { edges.push_back(h); });
    for (const HalfedgeId h : edges) {
      if (!delaunay::collapse_edge(mesh, h, std::min(before, k_collapse_cotangent))) continue;
      ++report.n_collapses;
      break;
    }
  }
}

void smooth(FaceState& state, FaceMeshReport& report, const RunContext& context) {
  SurfaceTriangulation& mesh = state.mesh;
  std::vector<HalfedgeId> work;
  std::vector<TriangleId> touched;
  // After the first sweep only vertices beside a change are looked at again.
  std::vector<std::uint8_t> is_active(mesh.points.size(), 1);
  for (int sweep = 0; sweep < state.options.smoothing_sweeps; ++sweep) {
    context.check_stop();
    std::int64_t n_moved = 0;
    for (std::uint32_t i = mesh.n_border; i < mesh.points.size(); ++i) {
      const VertexId v(i);
      if (is_active[i] == 0 || !mesh.mesh.outgoing[v].is_valid()) continue;
      is_active[i] = 0;
      if (!improve_place(state, v)) continue;
      ++n_moved;
      flip_at(state, v, work, touched, report);
      is_active[i] = 1;
      delaunay::for_star(mesh.mesh, v, [&](HalfedgeId h) { is_active[mesh.mesh.target(h).index()] = 1; });
      for (const TriangleId t : touched)
        for (const VertexId w : mesh.mesh.cells[t].vertex) is_active[w.index()] = 1;
    }
    report.n_moves += n_moved;
    if (n_moved == 0) break;
  }
}

}  // namespace sterna::surfmesh
