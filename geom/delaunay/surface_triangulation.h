// A triangulation on a curved surface: valid in the parameter plane by exact predicates, good by the empty sphere in 3-space (docs/method/surface.md, "Delaunay
// criterion in space").
//
// Every vertex has a place in the (scaled) parameter plane, a point and a frame. All decisions on validity look at the plane, all on quality at the points.
// A pole, many (u, v) of one point, is a run of vertices on the border that stand for the first of them; a triangle with two such corners has no area in
// space ("flat"), is skipped by every measure and left out at extraction. Flat triangles move along the pole when others need their place (flip_to_criterion).
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "geom/base/run_context.h"
#include "geom/base/vec3.h"
#include "geom/delaunay/cavity.h"
#include "geom/delaunay/triangulation.h"
#include "geom/model/nurbs_form.h"

namespace sterna::delaunay {

/// First derivatives and unit normal of the surface at a vertex; the normal is zero where it is not defined.
struct SurfaceFrame {
  Vec3 du;
  Vec3 dv;
  Vec3 normal;
};
struct SurfaceSample {
  Point point;
  SurfaceFrame frame;
};

/// Border of a face: closed loops, the domain to the left, whatever their order; every vertex belongs to a loop.
struct SurfaceBorder {
  std::vector<Uv> uv;
  std::vector<SurfaceSample> samples;             ///< same size
  std::vector<VertexId> stands_for;               ///< same size: itself, or for a pole the first of its vertices
  std::vector<std::vector<std::uint32_t>> loops;  ///< indices of vertices
};

struct SurfaceTriangulation {
  Triangulation mesh;                     ///< mesh.uv = scale * parameters
  Column<VertexId, Point> points;         ///< metres
  Column<VertexId, SurfaceFrame> frames;  ///< derivatives by the parameters (not scaled)
  Column<VertexId, VertexId> stands_for;  ///< itself but at poles
  std::uint32_t n_border = 0;             ///< vertices below it are the border's and stay where they are
  Vec2 scale{1.0, 1.0};                   ///< powers of two, so that parameters come back to the bit

  Uv parameters(VertexId v) const { return {mesh.uv[v].x / scale.x, mesh.uv[v].y / scale.y}; }
  Vec2 place(Uv at) const { return {at.u * scale.x, at.v * scale.y}; }
  bool is_border(VertexId v) const { return v.value() < n_border; }
  /// Two corners are the same point of a pole.
  bool is_flat(TriangleId t) const {
    const auto& v = mesh.cells[t].vertex;
    return stands_for[v[0]] == stands_for[v[1]] || stands_for[v[1]] == stands_for[v[2]] || stands_for[v[2]] == stands_for[v[0]];
  }
};

/// The power of two next to `speed` (metres by parameter), 1 when it is zero: what (u, v) are scaled by.
double scale_of_speed(double speed);

/// Constrained Delaunay triangulation of the border in the scaled plane; no inner vertices yet.
/// \post every segment of a loop is an edge with the domain on one side
/// \throws Error(self_intersection) with the place in space where borders cross or touch along an edge; Error(bad_argument) when nothing is inside
SurfaceTriangulation triangulate_border(const SurfaceBorder& border, Vec2 scale, const RunContext& context);

/// Cosine of 60 degrees (docs/method/surface.md, "Delaunay criterion in space"): how far a flipped triangle's normal may be from the surface's.
inline constexpr double k_min_normal_cosine = 0.5;

/// The empty sphere about the circumcentre in 3-space, through the corners. A flat triangle is never in conflict, nor is one with a corner where the surface
/// looks away from where it looks at the vertex: on the other side of a nose or a thin edge it is near in space only. (60 in place of 90 degrees leaves leading
/// edges stuck.)
struct SphereCriterion {
  static constexpr bool k_needs_normals = true;  ///< insert_vertex looks at the normals of the new triangles
  const Column<VertexId, Point>* points;
  const Column<VertexId, SurfaceFrame>* frames;
  bool conflicts(const Triangulation& mesh, TriangleId t, VertexId p) const {
    const auto& corner = mesh.cells[t].vertex;
    const Point& a = (*points)[corner[0]];
    const Vec3 u = (*points)[corner[1]] - a, v = (*points)[corner[2]] - a, q = (*points)[p] - a;
    const Vec3 w = cross(u, v);
    // Centre - a = (|v|^2 w x u + |u|^2 v x w) / (2 |w|^2); p is inside when |q|^2 < 2 q . (centre - a).
    if (norm2(q) * norm2(w) >= dot(q, norm2(v) * cross(w, u) + norm2(u) * cross(v, w))) return false;
    const Vec3& normal = (*frames)[p].normal;
    return dot((*frames)[corner[0]].normal, normal) >= 0.0 && dot((*frames)[corner[1]].normal, normal) >= 0.0 &&
           dot((*frames)[corner[2]].normal, normal) >= 0.0;
  }
};

enum class InsertOutcome {
  inserted,
  too_near,       ///< to a vertex around its cavity
  beyond_border,  ///< the place is outside the domain, on its border, or hidden behind it
  folded,         ///< a new triangle would look against the surface's normal
};

/// Inserts a vertex at `at`, looked for from triangle `near`. Nothing is changed unless `inserted`; then the vertex is the last one.
/// \param min_distance metres: to the vertices around the cavity
template <class Criterion>
InsertOutcome insert_vertex(SurfaceTriangulation& surface, Uv at, const SurfaceSample& sample, TriangleId near, double min_distance, const Criterion& criterion,
                            Cavity& cavity);

/// Cotangent of the smallest angle of a triangle in space; the larger, the worse; infinite without area.
double worst_cotangent(const Point& a, const Point& b, const Point& c);

/// Flips the edge of `h` when its two opposite angles in space sum to more than pi, the smallest angle grows, both new triangles are valid in the plane and
/// look along the surface (within 60 degrees of the normals of their corners, or nearer than before). At poles, flat triangles are moved out of the way. \param
/// changed gets the half-edges around the place of a flip
bool flip_to_criterion(SurfaceTriangulation& surface, HalfedgeId h, std::vector<HalfedgeId>& changed);
/// Flips until no edge wants to. Ends, since every flip raises the smallest angle of its place. Returns the number of flips.
std::size_t flip_all(SurfaceTriangulation& surface);
/// The same around the given half-edges only; empties the list. \param touched gets the triangles at flips, also more than once
std::size_t flip_around(SurfaceTriangulation& surface, std::vector<HalfedgeId>& halfedges, std::vector<TriangleId>& touched);

/// Moves inner vertex v when its star stays valid in the plane. \return false: nothing changed
bool move_vertex(SurfaceTriangulation& surface, VertexId v, Uv to, const SurfaceSample& sample);

/// Worst cotangent of the star of the origin of `h`, an inner vertex, once it is joined to its target; infinite when collapse_edge would refuse whatever is
/// allowed.
double worst_after_collapse(const SurfaceTriangulation& surface, HalfedgeId h);
/// Joins the origin of `h`, an inner vertex, to its target, when the triangles left are valid in the plane, look along the surface and have no cotangent above
/// `worst_allowed`. \return false: nothing changed
bool collapse_edge(SurfaceTriangulation& surface, HalfedgeId h, double worst_allowed);

/// Living triangles that are not flat, with poles as their first vertex, in ascending order of slots.
std::vector<TriangleVertices> extract_triangles(const SurfaceTriangulation& surface);

/// Triangles that a walk may visit: the place is near the triangle it starts from, so a longer walk has lost its way.
inline constexpr std::size_t k_walk_limit = 400;

/// All triangles of the new fan look along the normal of its centre. Flat ones have no direction.
bool looks_along_surface(const SurfaceTriangulation& surface, VertexId p, const Cavity& cavity);

template <class Criterion>
InsertOutcome insert_vertex(SurfaceTriangulation& surface, Uv at, const SurfaceSample& sample, TriangleId near, double min_distance, const Criterion& criterion,
                            Cavity& cavity) {
  Triangulation& mesh = surface.mesh;
  const Vec2 place = surface.place(at);
  const Location location = locate(mesh, place, near, k_walk_limit);
  if (location.kind == Location::Kind::on_vertex) return InsertOutcome::too_near;
  if (location.kind != Location::Kind::inside && location.kind != Location::Kind::on_edge) return InsertOutcome::beyond_border;
  if (location.kind == Location::Kind::on_edge && mesh.is_constrained(location.halfedge)) return InsertOutcome::beyond_border;
  const VertexId p = mesh.uv.push_back(place);
  surface.points.push_back(sample.point);
  surface.frames.push_back(sample.frame);
  const auto take_back = [&](InsertOutcome outcome) {
    mesh.uv.raw().pop_back();
    surface.points.raw().pop_back();
    surface.frames.raw().pop_back();
    return outcome;
  };
  grow_cavity(mesh, p, location, criterion, cavity);
  const double min_distance2 = min_distance * min_distance;
  for (const Cavity::BorderEdge& edge : cavity.border)
    if (norm2(surface.points[edge.from] - sample.point) < min_distance2) return take_back(InsertOutcome::too_near);
  if (Criterion::k_needs_normals && !looks_along_surface(surface, p, cavity)) return take_back(InsertOutcome::folded);
  mesh.outgoing.push_back(HalfedgeId{});
  surface.stands_for.push_back(p);
  fill_cavity(mesh, p, cavity);
  return InsertOutcome::inserted;
}

}  // namespace sterna::delaunay
