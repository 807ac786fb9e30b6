// TriangleTree: finds the nearest point, hits of a ray, and the winding number.
//
// Based on: C. Ericson, "Real-Time Collision Detection" (2005), section 5.3, for the slab test; A. Van Oosterom,
// J. Strackee, IEEE Trans. Biomed. Eng. 30 (1983), for the solid angle; G. Barill et al., "Fast winding numbers for soups and clouds", ACM Trans. Graph.
// 37 (2018), for the far field of a node.
#include <algorithm>
#include <cmath>
#include <numbers>
#include <optional>
#include <string>

#include "geom/base/error.h"
#include "geom/base/parallel.h"
#include "geom/math/nearest.h"
#include "geom/mesh/bvh.h"

namespace sterna {
namespace {

using TreeCorners = std::array<Point, 3>;

/// A node's far field is used beyond this many radii from its centre. The winding number is then accurate to 0.05 in the tests (0.013 on aircraft surfaces,
/// 0.12 without the second moments). An error of 1/2 would leave it undecided.
constexpr double k_far_radii = 3.0;
/// Rounding of a distance between a point and a triangle, in units of the largest coordinate: a few operations on each coordinate. The margin ensures that no
/// box is skipped if one of its triangles is, as computed, equally near.
constexpr double k_distance_rounding = 16 * 0x1p-53;
/// Rounding of a ray's slab parameters (relative) and of its barycentric coordinates (relative to the absolute values of their terms). The margin is generous,
/// because both triangles at an edge must not miss a hit near it.
constexpr double k_ray_rounding = 64 * 0x1p-53;
/// As in BoxTree::for_each_overlap.
constexpr int k_stack = 64;

double squared(double x) { return x * x; }

double squared_distance_to_box(const Point& p, const Box& box) {
  const auto gap = [](double x, double low, double high) { return std::max(std::max(low - x, x - high), 0.0); };
  return squared(gap(p.x, box.min.x, box.max.x)) + squared(gap(p.y, box.min.y, box.max.y)) + squared(gap(p.z, box.min.z, box.max.z));
}

double largest_coordinate(const Point& p) { return std::max({std::abs(p.x), std::abs(p.y), std::abs(p.z)}); }

/// Returns true if the ray p + t d, t >= 0, may hit the box; all rounding is on the safe side.
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

/// Returns t of the hit, by Cramer's rule (Moeller & Trumbore 1997); none for a miss beyond rounding.
std::optional<double> hit_parameter(const Point& p, const Vec3& d, const TreeCorners& c) {
  const Vec3 u = c[1] - c[0], v = c[2] - c[0], w = p - c[0];
  const Vec3 h = cross(d, v);
  const Vec3 q = cross(w, u);
  const double determinant = dot(u, h);
  if (determinant == 0.0) return std::nullopt;
  const double beta = dot(w, h) / determinant;
  const double gamma = dot(d, q) / determinant;
  const double t = dot(v, q) / determinant;
  const double size = std::max(norm(u), norm(v));
  const double slack = k_ray_rounding * norm(d) * (norm(w) + size) * size / std::abs(determinant);
  if (beta < -slack || gamma < -slack || beta + gamma > 1.0 + slack || t < 0.0) return std::nullopt;
  return t;
}

/// Returns the solid angle of the triangle seen from p, positive if the normal points away from p.
double solid_angle(const Point& p, const TreeCorners& t) {
  const Vec3 a = t[0] - p, b = t[1] - p, c = t[2] - p;
  const double la = norm(a), lb = norm(b), lc = norm(c);
  // Computed as a . (b x c) with the edges of the triangle, so that no digits cancel if p is far away.
  const double volume = dot(a, cross(t[1] - t[0], t[2] - t[0]));
  return 2.0 * std::atan2(volume, la * lb * lc + dot(a, b) * lc + dot(b, c) * la + dot(c, a) * lb);
}

std::vector<TreeCorners> corners_of(const TriMesh& mesh, const RunContext& context) {
  std::vector<TreeCorners> result(mesh.n_triangles());
  parallel_for(context, result.size(), [&](std::size_t t) {
    result[t] = corners(mesh, TriangleId(t));
    for (const Point& p : result[t]) {
      if (is_finite(p)) continue;
      throw Error({.code = ErrorCode::bad_argument,
                   .attempted = "building a triangle tree",
                   .problem = "a corner of triangle " + std::to_string(t) + " is not finite"});
    }
  });
  return result;
}

std::vector<Box> boxes_of(const std::vector<TreeCorners>& triangles, const RunContext& context) {
  std::vector<Box> boxes(triangles.size());
  parallel_for(context, boxes.size(), [&](std::size_t t) {
    for (const Point& p : triangles[t]) boxes[t].add(p);
  });
  return boxes;
}

}  // namespace

TriangleTree::TriangleTree(const TriMesh& mesh, const RunContext& context) : corners_(corners_of(mesh, context)), tree_(boxes_of(corners_, context), context) {
  far_field_.resize(tree_.nodes().size());
  if (far_field_.empty()) return;
  // Children are computed before their parents.
  const auto begins = tree_.level_begins();
  for (std::size_t level = begins.size() - 1; level-- > 0;) {
    parallel_for(context, begins[level + 1] - begins[level], [&](std::size_t i) { far_field_[begins[level] + i] = far_field_of(begins[level] + i); });
  }
}

/// Returns the moments of a node's area vectors about its area-weighted centre.
TriangleTree::FarField TriangleTree::far_field_of(std::size_t index) const {
  const auto& node = tree_.nodes()[index];
  FarField f;
  Vec3 weighted;
  const auto add_center = [&](double area, const Vec3& center) {
    f.area += area;
    weighted += area * center;
  };
  const auto add_moments = [&](const Vec3& dipole, const Vec3& center) {
    const Vec3 r = center - f.center;
    f.dipole += dipole;
    const double terms[6] = {
        r.x * dipole.x, r.y * dipole.y, r.z * dipole.z, r.x * dipole.y + r.y * dipole.x, r.y * dipole.z + r.z * dipole.y, r.z * dipole.x + r.x * dipole.z};
    for (std::size_t k = 0; k < 6; ++k) f.second[k] += terms[k];
  };
  const auto set_center = [&] {
    f.center = f.area > 0.0 ? weighted / f.area : node.box.center();
    const Vec3 low = f.center - node.box.min, high = node.box.max - f.center;
    f.radius = norm({std::max(low.x, high.x), std::max(low.y, high.y), std::max(low.z, high.z)});
  };
  if (node.count == 0) {
    const FarField* children = &far_field_[node.first];
    for (std::size_t k = 0; k < 2; ++k) add_center(children[k].area, children[k].center);
    set_center();
    for (std::size_t k = 0; k < 2; ++k) {
      add_moments(children[k].dipole, children[k].center);
      for (std::size_t m = 0; m < 6; ++m) f.second[m] += children[k].second[m];
    }
    return f;
  }
  const auto items = tree_.order().subspan(node.first, node.count);
  const auto area_vector_of = [&](std::uint32_t t) { return 0.5 * cross(corners_[t][1] - corners_[t][0], corners_[t][2] - corners_[t][0]); };
  const auto centroid_of = [&](std::uint32_t t) { return (corners_[t][0] + corners_[t][1] + corners_[t][2]) / 3.0; };
  for (const std::uint32_t t : items) add_center(norm(area_vector_of(t)), centroid_of(t));
  set_center();
  for (const std::uint32_t t : items) add_moments(area_vector_of(t), centroid_of(t));
  return f;
}

NearestHit TriangleTree::nearest(const Point& p, double limit) const {
  NearestHit best;
  const auto nodes = tree_.nodes();
  if (nodes.empty()) return best;
  const double rounding = k_distance_rounding * (largest_coordinate(p) + largest_coordinate(nodes[0].box.min) + largest_coordinate(nodes[0].box.max));
  double squared_bound = squared(limit + rounding);
  struct Pending {
    std::uint32_t node;
    double squared_distance;
  };
  Pending stack[k_stack];
  int n = 0;
  stack[n++] = {0, squared_distance_to_box(p, nodes[0].box)};
  while (n > 0) {
    const auto [index, squared_box_distance] = stack[--n];
    if (squared_box_distance > squared_bound) continue;
    const auto& node = nodes[index];
    if (node.count == 0) {
      // Visits the nearer child first.
      Pending near{node.first, squared_distance_to_box(p, nodes[node.first].box)};
      Pending far{node.first + 1, squared_distance_to_box(p, nodes[node.first + 1].box)};
      if (far.squared_distance < near.squared_distance) std::swap(near, far);
      stack[n++] = far;
      stack[n++] = near;
      continue;
    }
    for (const std::uint32_t t : tree_.order().subspan(node.first, node.count)) {
      if (squared_distance_to_box(p, tree_.boxes()[t]) > squared_bound) continue;
      const Point q = nearest_on_triangle(p, corners_[t]);
      const double d = distance(p, q);
      const bool is_better = best.triangle.is_valid() ? d < best.distance || (d == best.distance && t < best.triangle.value()) : d <= limit;
      if (!is_better) continue;
      best = {TriangleId(t), q, d};
      squared_bound = squared(d + rounding);
    }
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
      if (const auto parameter = hit_parameter(p, direction, corners_[t])) hits.push_back({TriangleId(t), *parameter});
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
    const FarField& f = far_field_[index];
    const Vec3 r = f.center - p;
    const double d2 = norm2(r);
    if (d2 > squared(k_far_radii * f.radius)) {
      // Taylor series of r / |r|^3 about the centre, to first order.
      const auto& m = f.second;
      const double along = m[0] * r.x * r.x + m[1] * r.y * r.y + m[2] * r.z * r.z + m[3] * r.x * r.y + m[4] * r.y * r.z + m[5] * r.z * r.x;
      angle += (dot(f.dipole, r) + (m[0] + m[1] + m[2]) - 3.0 * along / d2) / (d2 * std::sqrt(d2));
      continue;
    }
    if (node.count == 0) {
      stack[n++] = node.first + 1;
      stack[n++] = node.first;
      continue;
    }
    for (const std::uint32_t t : tree_.order().subspan(node.first, node.count)) angle += solid_angle(p, corners_[t]);
  }
  return angle / (4.0 * std::numbers::pi);
}

}  // namespace sterna
