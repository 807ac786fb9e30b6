// TriangleTree: nearest point, ray, winding number.
//
// Based on: C. Ericson, "Real-Time Collision Detection" (2005), sections 5.1 and 5.3, for the nearest point and the slab test; A. Van Oosterom,
// J. Strackee, IEEE Trans. Biomed. Eng. 30 (1983), for the solid angle; G. Barill et al., "Fast winding numbers for soups and clouds", ACM Trans. Graph.
// 37 (2018), for the far field of a node.
#include <algorithm>
#include <cmath>
#include <numbers>

#include "geom/base/parallel.h"
#include "geom/math/bvh.h"

namespace sterna {
namespace {

using Corners = std::array<Point, 3>;

/// A node's far field is used beyond this many radii from its centre: dipole error below 1e-2 in the sum, to be told apart from 1/2.
constexpr double k_far_radii = 3.0;
/// Rounding of a distance between a point and a triangle, in units of the largest coordinate: keeps a box from being skipped although one of its
/// triangles is, as computed, equally near. A few operations on each coordinate.
constexpr double k_distance_rounding = 16 * 0x1p-53;
/// Rounding of a ray's barycentric coordinates and slab parameters, relative: a hit at an edge is never lost between two triangles.
constexpr double k_ray_rounding = 64 * 0x1p-53;
/// As in BoxTree::for_each_overlap.
constexpr int k_stack = 64;

Point nearest_on_segment(const Point& p, const Point& a, const Point& b) {
  const Vec3 e = b - a;
  const double length2 = norm2(e);
  return length2 > 0.0 ? a + std::clamp(dot(p - a, e) / length2, 0.0, 1.0) * e : a;
}

/// A triangle without area is its edges.
Point nearest_on_triangle(const Point& p, const Corners& t) {
  const Vec3 u = t[1] - t[0];
  const Vec3 v = t[2] - t[0];
  const Vec3 normal = cross(u, v);
  const double n2 = norm2(normal);
  const Vec3 w = p - t[0];
  const double beta = dot(cross(w, v), normal);
  const double gamma = dot(cross(u, w), normal);
  if (n2 > 0.0 && beta >= 0.0 && gamma >= 0.0 && beta + gamma <= n2) return t[0] + (beta / n2) * u + (gamma / n2) * v;
  Point best = nearest_on_segment(p, t[0], t[1]);
  for (const Point& q : {nearest_on_segment(p, t[1], t[2]), nearest_on_segment(p, t[2], t[0])}) {
    if (norm2(q - p) < norm2(best - p)) best = q;
  }
  return best;
}

double distance_to_box(const Point& p, const Box& box) {
  const auto gap = [](double x, double low, double high) { return std::max({low - x, 0.0, x - high}); };
  return norm({gap(p.x, box.min.x, box.max.x), gap(p.y, box.min.y, box.max.y), gap(p.z, box.min.z, box.max.z)});
}

double largest_coordinate(const Point& p) { return std::max({std::abs(p.x), std::abs(p.y), std::abs(p.z)}); }

/// Whether the ray p + t d, t >= 0, may hit the box; with all rounding on the safe side.
bool may_hit(const Point& p, const Vec3& d, const Box& box) {
  double t_in = 0.0;
  double t_out = std::numeric_limits<double>::infinity();
  for (std::size_t axis = 0; axis < 3; ++axis) {
    if (d[axis] == 0.0) {
      if (p[axis] < box.min[axis] || p[axis] > box.max[axis]) return false;
      continue;
    }
    const double t0 = (box.min[axis] - p[axis]) / d[axis];
    const double t1 = (box.max[axis] - p[axis]) / d[axis];
    t_in = std::max(t_in, std::min(t0, t1));
    t_out = std::min(t_out, std::max(t0, t1));
  }
  return t_in <= t_out * (1.0 + k_ray_rounding);
}

/// Solid angle of the triangle seen from p, positive when the normal points away from p.
double solid_angle(const Point& p, const Corners& t) {
  const Vec3 a = t[0] - p, b = t[1] - p, c = t[2] - p;
  const double la = norm(a), lb = norm(b), lc = norm(c);
  // a . (b x c) with the edges of the triangle: no cancellation when p is far away.
  const double volume = dot(a, cross(t[1] - t[0], t[2] - t[0]));
  return 2.0 * std::atan2(volume, la * lb * lc + dot(a, b) * lc + dot(b, c) * la + dot(c, a) * lb);
}

std::vector<Corners> corners_of(const TriMesh& mesh) {
  std::vector<Corners> result;
  result.reserve(mesh.n_triangles());
  for (const TriangleId t : mesh.triangles.ids()) result.push_back(corners(mesh, t));
  return result;
}

std::vector<Box> boxes_of(const std::vector<Corners>& triangles) {
  std::vector<Box> boxes(triangles.size());
  for (std::size_t t = 0; t < triangles.size(); ++t) {
    for (const Point& p : triangles[t]) boxes[t].add(p);
  }
  return boxes;
}

}  // namespace

TriangleTree::TriangleTree(const TriMesh& mesh, const RunContext& context)
    : corners_(corners_of(mesh)), tree_(boxes_of(corners_), context) {
  // Far field of each node from its children's, children before parents: dipole = area vector, at the area-weighted centre.
  const auto nodes = tree_.nodes();
  node_dipole_.resize(nodes.size());
  node_center_.resize(nodes.size());
  node_radius_.resize(nodes.size());
  std::vector<double> area(nodes.size());
  for (std::size_t i = nodes.size(); i-- > 0;) {
    const auto& node = nodes[i];
    Vec3 weighted;
    for (std::uint32_t j = node.first; j < node.first + node.count; ++j) {
      const Corners& t = corners_[tree_.order()[j]];
      const Vec3 vector = 0.5 * cross(t[1] - t[0], t[2] - t[0]);
      node_dipole_[i] += vector;
      area[i] += norm(vector);
      weighted += (norm(vector) / 3.0) * (t[0] + t[1] + t[2]);
    }
    if (node.count == 0) {
      for (const std::size_t child : {node.first, node.first + 1}) {
        node_dipole_[i] += node_dipole_[child];
        area[i] += area[child];
        weighted += area[child] * node_center_[child];
      }
    }
    node_center_[i] = area[i] > 0.0 ? weighted / area[i] : node.box.center();
    const Vec3 low = node_center_[i] - node.box.min, high = node.box.max - node_center_[i];
    node_radius_[i] = norm({std::max(low.x, high.x), std::max(low.y, high.y), std::max(low.z, high.z)});
  }
}

NearestHit TriangleTree::nearest(const Point& p, double limit) const {
  NearestHit best;
  const auto nodes = tree_.nodes();
  if (nodes.empty()) return best;
  double bound = limit;
  const double rounding =
      k_distance_rounding * (largest_coordinate(p) + largest_coordinate(nodes[0].box.min) + largest_coordinate(nodes[0].box.max));
  struct Pending {
    std::uint32_t node;
    double distance;
  };
  Pending stack[k_stack];
  int n = 0;
  stack[n++] = {0, distance_to_box(p, nodes[0].box)};
  while (n > 0) {
    const auto [index, box_distance] = stack[--n];
    if (box_distance > bound + rounding) continue;
    const auto& node = nodes[index];
    for (std::uint32_t j = node.first; j < node.first + node.count; ++j) {
      const std::uint32_t t = tree_.order()[j];
      const Point q = nearest_on_triangle(p, corners_[t]);
      const double d = distance(p, q);
      const bool is_better = best.triangle.is_valid() ? d < best.distance || (d == best.distance && t < best.triangle.value()) : d <= limit;
      if (!is_better) continue;
      best = {TriangleId(t), q, d};
      bound = d;
    }
    if (node.count > 0) continue;
    // The nearer child first.
    Pending near{node.first, distance_to_box(p, nodes[node.first].box)};
    Pending far{node.first + 1, distance_to_box(p, nodes[node.first + 1].box)};
    if (far.distance < near.distance) std::swap(near, far);
    stack[n++] = far;
    stack[n++] = near;
  }
  return best;
}

std::vector<TriangleTree::RayHit> TriangleTree::ray(const Point& p, const Vec3& direction) const {
  std::vector<RayHit> hits;
  const auto nodes = tree_.nodes();
  if (nodes.empty()) return hits;
  std::uint32_t stack[k_stack];
  int n = 0;
  stack[n++] = 0;
  while (n > 0) {
    const auto& node = nodes[stack[--n]];
    if (!may_hit(p, direction, node.box)) continue;
    for (std::uint32_t j = node.first; j < node.first + node.count; ++j) {
      const std::uint32_t t = tree_.order()[j];
      const Corners& c = corners_[t];
      // Volumes of the tetrahedra between the ray and each edge, by Cramer's rule (Moeller & Trumbore 1997).
      const Vec3 u = c[1] - c[0], v = c[2] - c[0], w = p - c[0];
      const Vec3 h = cross(direction, v);
      const Vec3 q = cross(w, u);
      const double determinant = dot(u, h);
      if (determinant == 0.0) continue;
      const double beta = dot(w, h) / determinant;
      const double gamma = dot(direction, q) / determinant;
      const double slack = k_ray_rounding * (1.0 + norm(direction) * norm(u) * norm(v) / std::abs(determinant) * (1.0 + norm(w) / std::min(norm(u), norm(v))));
      const double parameter = dot(v, q) / determinant;
      if (beta >= -slack && gamma >= -slack && beta + gamma <= 1.0 + slack && parameter >= 0.0) hits.push_back({TriangleId(t), parameter});
    }
    if (node.count > 0) continue;
    stack[n++] = node.first + 1;
    stack[n++] = node.first;
  }
  std::sort(hits.begin(), hits.end(), [](const RayHit& a, const RayHit& b) { return a.t != b.t ? a.t < b.t : a.triangle < b.triangle; });
  return hits;
}

double TriangleTree::winding_number(const Point& p) const {
  const auto nodes = tree_.nodes();
  if (nodes.empty()) return 0.0;
  double angle = 0.0;
  std::uint32_t stack[k_stack];
  int n = 0;
  stack[n++] = 0;
  while (n > 0) {
    const std::uint32_t index = stack[--n];
    const auto& node = nodes[index];
    const Vec3 r = node_center_[index] - p;
    const double d = norm(r);
    if (d > k_far_radii * node_radius_[index]) {
      angle += dot(node_dipole_[index], r) / (d * d * d);
      continue;
    }
    for (std::uint32_t j = node.first; j < node.first + node.count; ++j) angle += solid_angle(p, corners_[tree_.order()[j]]);
    if (node.count > 0) continue;
    stack[n++] = node.first + 1;
    stack[n++] = node.first;
  }
  return angle / (4.0 * std::numbers::pi);
}

}  // namespace sterna
