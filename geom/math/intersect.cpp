// Exact triangle-triangle intersection from the signs of orient3d and orient2d alone.
//
// Triangles are closed point sets; a triangle without area is the segment or the point that it covers. Two triangles of an indexed set cross
// when they have a common point outside the convex hull (point, segment) of the vertices that they share.
//
// The usual cases are decided by the sides of each triangle's vertices on the other's plane and by lines that pierce triangles (the functions in the first
// half). If all the signs vanish that could prove that the triangles have area and different planes, the slow path (second half) treats the two sets as
// segments and coplanar triangles.
#include "geom/math/intersect.h"

#include <algorithm>
#include <optional>
#include <tuple>

#include "geom/math/predicates.h"

namespace sterna {
namespace {

using Corners = std::array<Vec3, 3>;

// ---------------------------------------------------------------- planar geometry

/// Projects onto a coordinate plane. This is exact, because it only drops a coordinate. For some axes the projection mirrors; callers compensate for that by
/// orienting their triangles.
Vec2 project(const Vec3& p, int axis) {
  if (axis == 0) return {p.y, p.z};
  return axis == 1 ? Vec2{p.x, p.z} : Vec2{p.x, p.y};
}
int orient(const Vec3& a, const Vec3& b, const Vec3& c, int axis) { return orient2d(project(a, axis), project(b, axis), project(c, axis)); }

/// Returns an axis along which a, b, c project to a triangle with area; none if they are collinear.
std::optional<int> projection_axis(const Vec3& a, const Vec3& b, const Vec3& c) {
  for (const int axis : {2, 1, 0}) {
    if (orient(a, b, c, axis) != 0) return axis;
  }
  return std::nullopt;
}

/// Returns the triangle counter-clockwise in the projection.
Corners counter_clockwise(const Corners& t, int axis) { return orient(t[0], t[1], t[2], axis) > 0 ? t : Corners{t[0], t[2], t[1]}; }

/// Returns true if a line along an edge of `a` has all points of `b` strictly on its outer side; a counter-clockwise, b a triangle or a segment.
template <std::size_t N>
bool edge_separates(const Corners& a, const std::array<Vec3, N>& b, int axis) {
  for (std::size_t i = 0; i < 3; ++i) {
    if (std::all_of(b.begin(), b.end(), [&](const Vec3& p) { return orient(a[i], a[(i + 1) % 3], p, axis) < 0; })) return true;
  }
  return false;
}

bool coplanar_triangles_meet(const Corners& a, const Corners& b, int axis) {
  const Corners p = counter_clockwise(a, axis);
  const Corners q = counter_clockwise(b, axis);
  return !edge_separates(p, q, axis) && !edge_separates(q, p, axis);
}

/// Returns true if p != apex is in the closed sector at `apex` between `from` and `to` (counter-clockwise, less than a half turn).
bool is_in_sector(const Vec3& apex, const Vec3& from, const Vec3& to, const Vec3& p, int axis) {
  return orient(apex, from, p, axis) >= 0 && orient(apex, p, to, axis) >= 0;
}

/// Returns true if the angular sectors of two coplanar triangles with the common first corner have a common ray.
bool coplanar_sectors_meet(const Corners& a, const Corners& b, int axis) {
  const Corners p = counter_clockwise(a, axis);
  const Corners q = counter_clockwise(b, axis);
  return is_in_sector(p[0], p[1], p[2], q[1], axis) || is_in_sector(p[0], p[1], p[2], q[2], axis) || is_in_sector(q[0], q[1], q[2], p[1], axis) ||
         is_in_sector(q[0], q[1], q[2], p[2], axis);
}

// ---------------------------------------------------------------- generic position

struct Sides {
  std::array<int, 3> sign;
  bool all_zero() const { return sign[0] == 0 && sign[1] == 0 && sign[2] == 0; }
};

/// Returns the sides of the corners of b on the plane of a; none if all lie strictly on one side.
std::optional<Sides> sides_of(const Corners& a, const Corners& b) {
  const Sides s{{orient3d(a[0], a[1], a[2], b[0]), orient3d(a[0], a[1], a[2], b[1]), orient3d(a[0], a[1], a[2], b[2])}};
  if (s.sign[0] != 0 && s.sign[0] == s.sign[1] && s.sign[1] == s.sign[2]) return std::nullopt;
  return s;
}

/// Returns true if the segment s-t meets the triangle. \pre the triangle has area; sides of s and t on its plane are not equal.
bool pierces(const Vec3& s, const Vec3& t, int side_s, int side_t, const Corners& a) {
  if (side_s == side_t) return false;
  // Seen from the positive side the triangle runs counter-clockwise: a line coming from there has every edge on its negative side.
  const int inside = side_s > side_t ? -1 : 1;
  for (std::size_t i = 0; i < 3; ++i) {
    if (orient3d(s, t, a[i], a[(i + 1) % 3]) == -inside) return false;
  }
  return true;
}

/// Returns true if an edge of b that is not in the plane of a meets a.
bool an_edge_pierces(const Corners& b, const Sides& sides, const Corners& a) {
  for (std::size_t i = 0; i < 3; ++i) {
    const std::size_t j = (i + 1) % 3;
    if (sides.sign[i] * sides.sign[j] > 0) continue;
    if (pierces(b[i], b[j], sides.sign[i], sides.sign[j], a)) return true;
  }
  return false;
}

// ---------------------------------------------------------------- slow path: coplanar triangles, triangles without area

struct Segment {
  Vec3 from;  ///< first in the order of x, then y, then z
  Vec3 to;
};

/// Orders points along a line of any direction.
bool is_before(const Vec3& a, const Vec3& b) { return std::tie(a.x, a.y, a.z) < std::tie(b.x, b.y, b.z); }

template <std::size_t N>
Segment span_of_collinear(const std::array<Vec3, N>& p) {
  const auto [first, last] = std::minmax_element(p.begin(), p.end(), is_before);
  return {*first, *last};
}

bool segment_meets_triangle(const Segment& s, const Corners& t, int axis) {
  const int from = orient3d(t[0], t[1], t[2], s.from);
  const int to = orient3d(t[0], t[1], t[2], s.to);
  if (from * to > 0) return false;
  if (from != to) return pierces(s.from, s.to, from, to, t);
  // The segment lies in the plane of t. It is apart if an edge of t, or its own line, separates the two.
  const Corners q = counter_clockwise(t, axis);
  if (edge_separates(q, std::array{s.from, s.to}, axis)) return false;
  const int side = orient(s.from, s.to, q[0], axis);
  return side == 0 || orient(s.from, s.to, q[1], axis) != side || orient(s.from, s.to, q[2], axis) != side;
}

bool segments_meet(const Segment& s, const Segment& t) {
  if (orient3d(s.from, s.to, t.from, t.to) != 0) return false;
  auto axis = projection_axis(s.from, s.to, t.from);
  if (!axis) axis = projection_axis(s.from, s.to, t.to);
  if (!axis) axis = projection_axis(t.from, t.to, s.from);
  // If all points are on one line, compare intervals.
  if (!axis) return !is_before(s.to, t.from) && !is_before(t.to, s.from);
  const auto straddles = [&](const Segment& u, const Segment& v) { return orient(u.from, u.to, v.from, *axis) * orient(u.from, u.to, v.to, *axis) <= 0; };
  return straddles(s, t) && straddles(t, s);
}

bool triangles_meet_slowly(const Corners& a, const Corners& b) {
  const auto axis_a = projection_axis(a[0], a[1], a[2]);
  const auto axis_b = projection_axis(b[0], b[1], b[2]);
  if (axis_a && axis_b) return coplanar_triangles_meet(a, b, *axis_a);
  if (axis_a) return segment_meets_triangle(span_of_collinear(b), a, *axis_a);
  if (axis_b) return segment_meets_triangle(span_of_collinear(a), b, *axis_b);
  return segments_meet(span_of_collinear(a), span_of_collinear(b));
}

bool is_same_ray(const Vec3& apex, const Vec3& p, const Vec3& q) {
  return p != apex && q != apex && !projection_axis(apex, p, q) && is_before(apex, p) == is_before(apex, q);
}

/// Returns true if the ray from b[0] to p runs within the sector of b at b[0]. \pre b has area.
bool ray_is_in_sector(const Vec3& p, const Corners& b, int axis) {
  if (p == b[0] || orient3d(b[0], b[1], b[2], p) != 0) return false;
  const Corners q = counter_clockwise(b, axis);
  return is_in_sector(q[0], q[1], q[2], p, axis);
}

/// Returns true if two triangles with a common first corner have common points besides that corner.
bool cross_beyond_corner_slowly(const Corners& a, const Corners& b) {
  const auto axis_a = projection_axis(a[0], a[1], a[2]);
  const auto axis_b = projection_axis(b[0], b[1], b[2]);
  if (axis_a && axis_b) return coplanar_sectors_meet(a, b, *axis_a);
  // A triangle without area is the union of its two edges at the common corner.
  if (axis_a) return ray_is_in_sector(b[1], a, *axis_a) || ray_is_in_sector(b[2], a, *axis_a);
  if (axis_b) return ray_is_in_sector(a[1], b, *axis_b) || ray_is_in_sector(a[2], b, *axis_b);
  return is_same_ray(a[0], a[1], b[1]) || is_same_ray(a[0], a[1], b[2]) || is_same_ray(a[0], a[2], b[1]) || is_same_ray(a[0], a[2], b[2]);
}

/// Returns true if two triangles with the common edge 0-1 and coplanar third corners have common points besides that edge.
bool cross_beyond_edge_slowly(const Corners& a, const Corners& b) {
  const auto axis_a = projection_axis(a[0], a[1], a[2]);
  const auto axis_b = projection_axis(b[0], b[1], b[2]);
  if (axis_a && axis_b) return orient(a[0], a[1], a[2], *axis_a) == orient(b[0], b[1], b[2], *axis_a);
  // A triangle with area has only the edge on the edge's line, on which the other one lies (if the edge is a point, neither has area).
  if (axis_a || axis_b) return false;
  // The edge is a point, and the triangles are two segments that start there.
  if (a[0] == a[1]) return is_same_ray(a[0], a[2], b[2]);
  // Both third corners are on the edge's line: the triangles overlap if these corners lie beyond the same end of the edge.
  const Segment edge = span_of_collinear(std::array{a[0], a[1]});
  return (is_before(a[2], edge.from) && is_before(b[2], edge.from)) || (is_before(edge.to, a[2]) && is_before(edge.to, b[2]));
}

// ---------------------------------------------------------------- two triangles that share a corner or an edge

/// Returns true if two triangles with a common first corner have more points in common. As the intersection is convex, this is so iff the sectors at the corner
/// have a common ray.
bool cross_beyond_corner(const Corners& a, const Corners& b) {
  const int side_1 = orient3d(b[0], b[1], b[2], a[1]);
  const int side_2 = orient3d(b[0], b[1], b[2], a[2]);
  if (side_1 * side_2 > 0) return false;
  if (side_1 == side_2) return cross_beyond_corner_slowly(a, b);
  // The edge a[1]-a[2] meets the plane of b in one point; is that point within b's sector?
  const int inside = side_1 > side_2 ? -1 : 1;
  const int first = orient3d(a[1], a[2], b[0], b[1]);
  const int second = orient3d(a[1], a[2], b[2], b[0]);
  // The point is on both edges, so it is the corner itself: a has no area.
  if (first == 0 && second == 0) return cross_beyond_corner_slowly(a, b);
  return first != -inside && second != -inside;
}

bool cross_beyond_edge(const Corners& a, const Corners& b) { return orient3d(a[0], a[1], a[2], b[2]) == 0 && cross_beyond_edge_slowly(a, b); }

/// Moves the shared corners to the front, in the same order in both triangles, and returns their number. A corner that a triangle repeats counts once; its
/// copies stay behind the shared corners.
std::size_t move_shared_to_front(std::array<std::uint32_t, 3>& a, std::array<std::uint32_t, 3>& b) {
  std::size_t n = 0;
  for (std::size_t i = 0; i < 3; ++i) {
    if (std::find(a.begin(), a.begin() + static_cast<std::ptrdiff_t>(n), a[i]) != a.begin() + static_cast<std::ptrdiff_t>(n)) continue;
    const auto found = std::find(b.begin() + static_cast<std::ptrdiff_t>(n), b.end(), a[i]);
    if (found == b.end()) continue;
    std::swap(a[n], a[i]);
    std::iter_swap(b.begin() + static_cast<std::ptrdiff_t>(n), found);
    ++n;
  }
  return n;
}

}  // namespace

bool triangles_intersect(const std::array<Vec3, 3>& a, const std::array<Vec3, 3>& b) {
  const auto a_on_b = sides_of(b, a);
  if (!a_on_b) return false;
  const auto b_on_a = sides_of(a, b);
  if (!b_on_a) return false;
  if (a_on_b->all_zero() || b_on_a->all_zero()) return triangles_meet_slowly(a, b);
  // Both triangles have area, in different planes. The intersection is a segment or a point; each of its ends is on an edge of one triangle and in the other.
  // Edges in the other's plane need no test: their ends, and the points where they cross edges, belong to other edges, too.
  return an_edge_pierces(a, *a_on_b, b) || an_edge_pierces(b, *b_on_a, a);
}

bool triangles_cross(std::span<const Vec3> points, const std::array<std::uint32_t, 3>& a, const std::array<std::uint32_t, 3>& b) {
  std::array<std::uint32_t, 3> va = a;
  std::array<std::uint32_t, 3> vb = b;
  const std::size_t n_shared = move_shared_to_front(va, vb);
  if (n_shared == 3) return true;
  const Corners p = {points[va[0]], points[va[1]], points[va[2]]};
  const Corners q = {points[vb[0]], points[vb[1]], points[vb[2]]};
  if (n_shared == 2) return cross_beyond_edge(p, q);
  return n_shared == 1 ? cross_beyond_corner(p, q) : triangles_intersect(p, q);
}

}  // namespace sterna
