// The normals at both ends of an edge each give the rise of an arc over the edge. The lower rise is used, or zero if the two disagree in sign. For edges on
// lines, the tangents at both ends are used instead.
#include "surfmesh/remesh/bulges.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "geom/base/parallel.h"
#include "geom/math/measures.h"

namespace sterna::surfmesh {
namespace {

/// Rad: largest angle between an edge and the curve over it. Edges with a larger bend are lines.
constexpr double k_most_rise = 0.5;
/// Largest ratio of a bulge to the height of an adjacent triangle. A higher patch beside a short edge would overlap its neighbours.
constexpr double k_bulge_of_height = 0.2;

/// Returns the half-edge of an edge with the smaller id.
HalfedgeId smaller_of(const Topology& topology, HalfedgeId h) {
  const HalfedgeId o = topology.twin(h);
  return o.is_valid() ? std::min(h, o) : h;
}

Vec3 surface_bulge(const Reference& r, HalfedgeId h, const StraightParts& parts) {
  if (parts.is_straight[h] != 0) return {};
  const Point &a = r.mesh->points[r.topology.from(h)], &b = r.mesh->points[r.topology.to(h)];
  const double length = distance(a, b);
  const Vec3 e = (b - a) / length;
  const Vec3 na = r.normals[h], nb = r.normals[next(h)];
  const double rise_a = -dot(na, e), rise_b = dot(nb, e);
  if (!(rise_a * rise_b > 0.0)) return {};
  const double rise = std::min({std::abs(rise_a), std::abs(rise_b), parts.most_rise[h], parts.most_rise[r.topology.twin(h)], k_most_rise});
  const Vec3 up = na + nb;
  return std::copysign(0.5 * length * std::tan(0.5 * std::asin(rise)), rise_a) * normalized(up - dot(up, e) * e);
}

void find_line_bulges(const Reference& r, FeatureLine& line, const StraightParts& parts) {
  const auto at = [&](std::size_t i) -> const Point& { return r.mesh->points[line.vertices[i]]; };
  const std::size_t n = line.vertices.size();
  line.bulges.assign(n - 1, Vec3{});
  const auto is_straight = [&](std::size_t i) { return parts.is_straight[line.halfedges[i]] != 0; };
  // Tangent at a vertex of the circle through three consecutive vertices, or of a straight segment. The ends have no tangent.
  std::vector<Vec3> tangents(n);
  for (std::size_t i = 1; i + 1 < n; ++i) {
    const Vec3 in = at(i) - at(i - 1), out = at(i + 1) - at(i);
    const bool is_in = is_straight(i - 1), is_out = is_straight(i);
    tangents[i] = normalized(is_in == is_out ? norm2(out) * in + norm2(in) * out : is_in ? in : out);
  }
  // At an end, the line is continued with the bend of the last inner vertex, provided that the next vertex inwards has the same bend.
  const auto rise_at_end = [&](std::size_t near, std::size_t far, const Vec3& rise, double length) {
    if (far == 0 || far >= n - 1) return Vec3{};  // also returned for a line with a single edge, behind which there is no vertex
    const double behind = distance(at(near), at(far));
    const double bend = angle_between(tangents[near], tangents[far]) * 0.5 * length / behind;
    return norm(rise) > 0.0 ? std::min(1.0, bend / norm(rise)) * rise : rise;
  };
  for (std::size_t i = 0; i + 1 < n; ++i) {
    if (is_straight(i)) continue;
    const double length = distance(at(i), at(i + 1));
    const Vec3 e = (at(i + 1) - at(i)) / length;
    // Both rises point to the side of the curve.
    Vec3 rise_a = tangents[i] - dot(tangents[i], e) * e, rise_b = dot(tangents[i + 1], e) * e - tangents[i + 1];
    if (i == 0) rise_a = rise_at_end(1, 2, rise_b, length);
    if (i + 2 == n) rise_b = rise_at_end(n - 2, n - 3, rise_a, length);
    if (!(dot(rise_a, rise_b) > 0.0)) continue;
    const double rise = std::min({norm(rise_a), norm(rise_b), k_most_rise});
    line.bulges[i] = 0.5 * length * std::tan(0.5 * std::asin(rise)) * normalized(rise_a + rise_b);
  }
}

Vec3 limited(const Reference& r, HalfedgeId h, const Vec3& bulge) {
  double height = std::numeric_limits<double>::infinity();
  for (const HalfedgeId e : {h, r.topology.twin(h)}) {
    if (!e.is_valid()) continue;
    const Point &a = r.mesh->points[r.topology.from(e)], &b = r.mesh->points[r.topology.to(e)], &c = r.mesh->points[r.topology.from(previous(e))];
    height = std::min(height, 2.0 * triangle_area(a, b, c) / distance(a, b));
  }
  const double rise = norm(bulge), most = k_bulge_of_height * height;
  return rise > most ? most / rise * bulge : bulge;
}

/// Removes the component of the bulge that points out of the planes of flat faces beside the edge.
Vec3 in_planes(const Reference& r, HalfedgeId h, Vec3 bulge, const StraightParts& parts) {
  for (const HalfedgeId e : {h, r.topology.twin(h)}) {
    if (!e.is_valid()) continue;
    const Vec3& n = parts.plane[triangle_of(e)];
    bulge = bulge - dot(bulge, n) * n;
  }
  return bulge;
}

}  // namespace

void find_bulges(Reference& r, const Column<TriangleId, std::uint8_t>& flat, const StraightParts& parts, const RunContext& context) {
  const auto is_flat = [&](HalfedgeId h) {
    const HalfedgeId o = r.topology.twin(h);
    const auto off = [&](TriangleId t) { return r.is_kept[t] != 0 || (!flat.empty() && flat[t] != 0); };
    return off(triangle_of(h)) || (o.is_valid() && off(triangle_of(o)));
  };
  for (FeatureLine& line : r.lines) {
    find_line_bulges(r, line, parts);
    for (std::size_t i = 0; i < line.bulges.size(); ++i)
      if (is_flat(line.halfedges[i])) line.bulges[i] = {};
  }
  for (FeatureLine& line : r.lines)
    for (std::size_t i = 0; i < line.bulges.size(); ++i) line.bulges[i] = limited(r, line.halfedges[i], in_planes(r, line.halfedges[i], line.bulges[i], parts));
  parallel_for(context, r.topology.n_halfedges(), [&](std::size_t i) {
    const HalfedgeId h(i);
    if (r.line[h] != k_no_line) r.bulges[h] = r.lines[static_cast<std::size_t>(r.line[h])].bulges[r.segment[h]];
    else if (!is_flat(h)) r.bulges[h] = limited(r, h, surface_bulge(r, smaller_of(r.topology, h), parts));
  });
}

}  // namespace sterna::surfmesh
