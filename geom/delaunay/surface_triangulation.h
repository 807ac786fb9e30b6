// A triangulation on a curved surface. Exact predicates keep it valid in the parameter plane; the empty sphere in 3-space is the criterion for optimising it
// (docs/method/surface.md, "Delaunay criterion in space").
// Every vertex has a position in the (scaled) parameter plane, a point and a frame. Validity is decided in the plane, quality by the points in space. A pole,
// many (u, v) of one point, is a run of vertices on the border that are represented by the first of them. A triangle with two such corners has no area in space
// ("flat"); it is skipped by every measure and omitted at extraction. Flat triangles move along the pole if other triangles require their position
// (flip_to_criterion).
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

/// Border of a face: closed loops in any order, the domain to the left; every vertex belongs to a loop.
struct SurfaceBorder {
  std::vector<Uv> uv;
  std::vector<SurfaceSample> samples;             ///< same size
  std::vector<VertexId> stands_for;               ///< same size: itself, or the first vertex of its pole
  std::vector<std::vector<std::uint32_t>> loops;  ///< indices of vertices
};

struct SurfaceTriangulation {
  Triangulation mesh;                     ///< mesh.uv = scale * parameters
  Column<VertexId, Point> points;         ///< metres
  Column<VertexId, SurfaceFrame> frames;  ///< derivatives by the parameters (not scaled)
  Column<VertexId, VertexId> stands_for;  ///< itself, except at poles
  std::uint32_t n_border = 0;             ///< lower vertex ids belong to the border and do not move
  Vec2 scale{1.0, 1.0};                   ///< powers of two, so that parameters are recovered to the bit

  Uv parameters(VertexId v) const { return {mesh.uv[v].x / scale.x, mesh.uv[v].y / scale.y}; }
  Vec2 plane_point(Uv at) const { return {at.u * scale.x, at.v * scale.y}; }
  bool is_border(VertexId v) const { return v.value() < n_border; }
  /// Returns true if two corners are the same point of a pole.
  bool is_flat(TriangleId t) const {
    const auto& v = mesh.cells[t].vertex;
    return stands_for[v[0]] == stands_for[v[1]] || stands_for[v[1]] == stands_for[v[2]] || stands_for[v[2]] == stands_for[v[0]];
  }
};

/// Returns the power of two nearest to `speed` (metres per parameter), 1 if it is zero: the scale factor of (u, v).
double scale_of_speed(double speed);

/// Returns the constrained Delaunay triangulation of the border in the scaled plane. It has no inner vertices yet.
/// \post every segment of a loop is an edge with the domain on one side
/// \throws Error(self_intersection) with the location in space where borders cross or touch along an edge; Error(bad_argument) if the domain is empty
SurfaceTriangulation triangulate_border(const SurfaceBorder& border, Vec2 scale, const RunContext& context);

/// Cosine of 60 degrees (docs/method/surface.md, "Delaunay criterion in space"): limit of the angle between a flipped triangle's normal and the surface normal.
inline constexpr double k_min_normal_cosine = 0.5;

/// The empty sphere about the circumcentre in 3-space, through the corners. A flat triangle is never in conflict. Neither is a triangle with a corner whose
/// surface normal is opposed to that at the vertex: it lies on the other side of a nose or a thin edge and is near in space only. (60 in place of 90 degrees
/// prevents progress at leading edges.)
struct SphereCriterion {
  static constexpr bool k_needs_normals = true;  ///< insert_vertex uses the normals of the new triangles
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
  too_near,       ///< too near to a vertex around its cavity
  beyond_border,  ///< the location is outside the domain, on its border, or not visible behind it
  folded,         ///< the normal of a new triangle would be opposed to the surface normal
};

/// Inserts a vertex at `at`, located by a walk from triangle `near`. Nothing is changed unless the result is `inserted`; the new vertex is then the last one.
/// \param min_distance metres: to the vertices around the cavity
template <class Criterion>
InsertOutcome insert_vertex(SurfaceTriangulation& surface, Uv at, const SurfaceSample& sample, TriangleId near, double min_distance, const Criterion& criterion,
                            Cavity& cavity);

/// Returns the cotangent of the smallest angle of a triangle in space; larger is worse; infinite for zero area.
double worst_cotangent(const Point& a, const Point& b, const Point& c);

/// Flips the edge of `h` if its two opposite angles in space sum to more than pi, the smallest angle grows, and both new triangles are valid in the plane and
/// have normals along the surface normal (within 60 degrees of the normals of their corners, or closer than before). At poles, flat triangles are moved out of
/// the way. \param changed gets the half-edges around the location of a flip
bool flip_to_criterion(SurfaceTriangulation& surface, HalfedgeId h, std::vector<HalfedgeId>& changed);
/// Flips until no edge satisfies the criterion. Terminates, since every flip raises the local smallest angle. Returns the number of flips.
std::size_t flip_all(SurfaceTriangulation& surface);
/// Flips only around the given half-edges; empties the list. \param touched gets the triangles at flips, possibly more than once
std::size_t flip_around(SurfaceTriangulation& surface, std::vector<HalfedgeId>& halfedges, std::vector<TriangleId>& touched);

/// Moves inner vertex v if its star stays valid in the plane. \return false: nothing changed
bool move_vertex(SurfaceTriangulation& surface, VertexId v, Uv to, const SurfaceSample& sample);

/// Returns the worst cotangent of the star of the origin of `h`, an inner vertex, after joining it to its target; infinite if collapse_edge would reject the
/// collapse for any limit.
double worst_after_collapse(const SurfaceTriangulation& surface, HalfedgeId h);
/// Joins the origin of `h`, an inner vertex, to its target, if the remaining triangles are valid in the plane, have normals along the surface normal, and have
/// no cotangent above `worst_allowed`. \return false: nothing changed
bool collapse_edge(SurfaceTriangulation& surface, HalfedgeId h, double worst_allowed);

/// Returns the existing triangles that are not flat, with poles as their first vertex, in ascending order of slots.
std::vector<TriangleVertices> extract_triangles(const SurfaceTriangulation& surface);

/// Limit of triangles visited by a walk: the target is near the start triangle, so a longer walk has failed.
inline constexpr std::size_t k_walk_limit = 400;

/// Returns true if the normals of all triangles of the new fan agree with the normal of its centre. Flat triangles have no normal.
bool looks_along_surface(const SurfaceTriangulation& surface, VertexId p, const Cavity& cavity);

template <class Criterion>
InsertOutcome insert_vertex(SurfaceTriangulation& surface, Uv at, const SurfaceSample& sample, TriangleId near, double min_distance, const Criterion& criterion,
                            Cavity& cavity) {
  Triangulation& mesh = surface.mesh;
  const Vec2 plane_point = surface.plane_point(at);
  const Location location = locate(mesh, plane_point, near, k_walk_limit);
  if (location.kind == Location::Kind::on_vertex) return InsertOutcome::too_near;
  if (location.kind != Location::Kind::inside && location.kind != Location::Kind::on_edge) return InsertOutcome::beyond_border;
  if (location.kind == Location::Kind::on_edge && mesh.is_constrained(location.halfedge)) return InsertOutcome::beyond_border;
  const VertexId p = mesh.uv.push_back(plane_point);
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
