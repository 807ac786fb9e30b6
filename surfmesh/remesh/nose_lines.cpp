#include "surfmesh/remesh/nose_lines.h"

#include <algorithm>
#include <cmath>

#include "geom/base/parallel.h"
#include "geom/math/measures.h"
#include "geom/mesh/find_crossings.h"
#include "surfmesh/model/band_target.h"
#include "surfmesh/remesh/line_rows.h"

namespace sterna::surfmesh {
namespace {

/// If a nose crosses an edge nearer to a vertex than this fraction of the edge, it is moved through the vertex.
constexpr double k_snap = 0.15;
/// If the direction across the span has an x component below this value, the nose passes through the vertex.
constexpr double k_exactly_ahead = 1e-6;
/// Smallest cosine between the span directions of neighbouring vertices.
constexpr double k_same_span = 0.5;
/// Largest x component of the normal on a nose, which faces forward.
constexpr double k_nose_ahead = -0.2;
/// Number of power iterations that find the span direction from the tensor.
constexpr int k_power_steps = 24;

/// Sum of bends times squared edge lengths around a vertex (Cohen-Steiner & Morvan 2003; Alliez et al. 2003). Its dominant direction is the span.
struct BendTensor {
  std::array<double, 6> t{};  ///< components xx, yy, zz, xy, yz, zx
  void add(double weight, const Vec3& e) {
    t[0] += weight * e.x * e.x;
    t[1] += weight * e.y * e.y;
    t[2] += weight * e.z * e.z;
    t[3] += weight * e.x * e.y;
    t[4] += weight * e.y * e.z;
    t[5] += weight * e.z * e.x;
  }
  Vec3 times(const Vec3& v) const { return {t[0] * v.x + t[3] * v.y + t[5] * v.z, t[3] * v.x + t[1] * v.y + t[4] * v.z, t[5] * v.x + t[4] * v.y + t[2] * v.z}; }
};

/// Returns the span direction at the vertex where the half-edge `corner` begins, in the smooth piece of that half-edge. The result is a unit vector along the
/// surface; it is zero if the surface is flat there or equally curved in all directions.
Vec3 span_at(const Reference& r, HalfedgeId corner) {
  BendTensor tensor;
  const Point& p = r.mesh->points[r.topology.from(corner)];
  const Vec3& normal = r.normals[corner];
  Vec3 start;
  double largest = 0.0;
  const auto add = [&](HalfedgeId h) {
    const Vec3 e = r.mesh->points[r.topology.to(h)] - p;
    const Vec3 &a = r.triangle_normals[triangle_of(h)], &b = r.triangle_normals[triangle_of(r.topology.twin(h))];
    const double bend = std::copysign(angle_between(a, b), dot(cross(a, b), e));  // positive if the edge is convex
    const double length = norm(e);
    if (!(length > 0.0)) return;
    tensor.add(bend / length, e);
    if (std::abs(bend) * length > largest) {
      largest = std::abs(bend) * length;
      start = e;
    }
  };
  // The triangles are visited clockwise up to a line or once around, then counter-clockwise.
  const auto is_line = [&](HalfedgeId h) { return r.line[h] != k_no_line || !r.topology.twin(h).is_valid(); };
  HalfedgeId h = corner;
  bool is_around = false;
  while (!is_line(h)) {
    add(h);
    h = next(r.topology.twin(h));
    if (h == corner) {
      is_around = true;
      break;
    }
  }
  for (HalfedgeId in = previous(corner); !is_around && !is_line(in); in = previous(h)) {
    h = r.topology.twin(in);
    add(h);
  }
  Vec3 span = normalized(start - dot(start, normal) * normal);
  for (int i = 0; i < k_power_steps; ++i) {
    Vec3 s = tensor.times(span);
    s = s - dot(s, normal) * normal;
    if (!(norm2(s) > 0.0)) return {};
    span = normalized(s);
  }
  return dot(tensor.times(span), span) > 0.0 ? span : Vec3{};
}

struct NoseFinder {
  const Reference& r;
  Column<HalfedgeId, Vec3> span;     ///< span direction at the start of each half-edge
  Column<HalfedgeId, double> ahead;  ///< x component of the direction across the span

  /// Returns the fraction of the edge at which a nose crosses it; negative if no nose does.
  double crossing(HalfedgeId h) const {
    const HalfedgeId a = h, b = next(h);
    if (r.line[h] != k_no_line || !r.topology.twin(h).is_valid()) return -1.0;
    const double cosine = dot(span[a], span[b]);
    if (std::abs(cosine) < k_same_span) return -1.0;
    const double fa = ahead[a], fb = std::copysign(1.0, cosine) * ahead[b];
    if (fa * fb > 0.0 || fa == fb) return -1.0;
    const double t = fa / (fa - fb);
    const double x = (1.0 - t) * r.normals[h].x + t * r.normals[next(h)].x;
    return x < k_nose_ahead ? t : -1.0;
  }
};

NoseFinder nose_finder(const Reference& r, const RunContext& context) {
  NoseFinder finder{r, Column<HalfedgeId, Vec3>(r.topology.n_halfedges()), Column<HalfedgeId, double>(r.topology.n_halfedges(), 0.0)};
  parallel_for(context, r.topology.n_halfedges(), [&](std::size_t i) {
    const HalfedgeId h(i);
    finder.span[h] = span_at(r, h);
    if (norm2(finder.span[h]) > 0.0) finder.ahead[h] = cross(r.normals[h], finder.span[h]).x;
  });
  return finder;
}

/// Marks the vertices that noses pass through, or pass so closely that they are moved there.
Column<VertexId, std::uint8_t> vertices_on_noses(const NoseFinder& finder) {
  const Reference& r = finder.r;
  Column<VertexId, std::uint8_t> is_on(r.mesh->n_vertices(), 0);
  for (std::size_t i = 0; i < r.topology.n_halfedges(); ++i) {
    const HalfedgeId h(i), o = r.topology.twin(h);
    if (norm2(finder.span[h]) > 0.0 && std::abs(finder.ahead[h]) < k_exactly_ahead && r.normals[h].x < k_nose_ahead) is_on[r.topology.from(h)] = 1;
    if (o.is_valid() && o < h) continue;
    const double t = finder.crossing(h);
    if (t >= 0.0 && t < k_snap) is_on[r.topology.from(h)] = 1;
    if (t > 1.0 - k_snap) is_on[r.topology.to(h)] = 1;
  }
  return is_on;
}

/// Adds a vertex where a nose crosses an edge elsewhere. Returns the new vertex of each half-edge.
Column<HalfedgeId, VertexId> add_crossings(const NoseFinder& finder, const Column<VertexId, std::uint8_t>& is_on, bool is_flat, NoseCut& cut) {
  const Reference& r = finder.r;
  Column<HalfedgeId, VertexId> node(r.topology.n_halfedges());
  for (std::size_t i = 0; i < r.topology.n_halfedges(); ++i) {
    const HalfedgeId h(i), o = r.topology.twin(h);
    if ((o.is_valid() && o < h) || is_on[r.topology.from(h)] != 0 || is_on[r.topology.to(h)] != 0) continue;
    const double t = finder.crossing(h);
    if (t < 0.0) continue;
    const Point &a = r.mesh->points[r.topology.from(h)], &b = r.mesh->points[r.topology.to(h)];
    node[h] = node[o] = cut.mesh.points.push_back(a + t * (b - a) + (is_flat ? 0.0 : 4.0 * t * (1.0 - t)) * r.bulges[h]);
  }
  return node;
}

/// Adds the edge of a nose within a triangle, if one passes through it. \p middle new vertices of the three edges; invalid: the edge is not split
void add_nose_edge(const TriangleVertices& v, const std::array<VertexId, 3>& middle, const Column<VertexId, std::uint8_t>& is_on, NoseCut& cut) {
  std::size_t n_through = 0;
  std::array<VertexId, 2> through;
  const auto pass = [&](VertexId p) {
    if (n_through < 2) through[n_through] = p;
    ++n_through;
  };
  for (std::size_t k = 0; k < 3; ++k) {
    if (is_on[v[k]] != 0) pass(v[k]);
    if (middle[k].is_valid()) pass(middle[k]);
  }
  if (n_through == 2) cut.edges.push_back({std::min(through[0], through[1]), std::max(through[0], through[1])});
}

/// Adds the parts of a triangle. The arguments are those of add_nose_edge().
void add_parts(const TriangleVertices& v, const std::array<VertexId, 3>& middle, PatchId patch, NoseCut& cut) {
  const auto add = [&](VertexId a, VertexId b, VertexId c) {
    cut.mesh.triangles.push_back({a, b, c});
    cut.mesh.triangle_patch.push_back(patch);
  };
  std::size_t n_split = 0, first = 0, whole = 0;
  for (std::size_t k = 0; k < 3; ++k) {
    if (!middle[k].is_valid()) whole = k;
    else if (n_split++ == 0) first = k;
  }
  if (n_split == 0) {
    add(v[0], v[1], v[2]);
  } else if (n_split == 1) {
    const VertexId m = middle[first], a = v[first], b = v[(first + 1) % 3], c = v[(first + 2) % 3];
    add(a, m, c);
    add(m, b, c);
  } else if (n_split == 2) {
    // The edge a b is not split; m lies on b c, n on c a.
    const VertexId a = v[whole], b = v[(whole + 1) % 3], c = v[(whole + 2) % 3], m = middle[(whole + 1) % 3], n = middle[(whole + 2) % 3];
    add(n, m, c);
    if (distance(cut.mesh.points[a], cut.mesh.points[m]) <= distance(cut.mesh.points[b], cut.mesh.points[n])) {
      add(a, b, m);
      add(a, m, n);
    } else {
      add(a, b, n);
      add(b, m, n);
    }
  } else {
    add(v[0], middle[0], middle[2]);
    add(middle[0], v[1], middle[1]);
    add(middle[2], middle[1], v[2]);
    add(middle[0], middle[1], middle[2]);
  }
}

}  // namespace

NoseCut cut_noses(const Reference& r, bool is_flat, const RunContext& context) {
  const TriMesh& wall = *r.mesh;
  const NoseFinder finder = nose_finder(r, context);
  NoseCut cut;
  cut.mesh.points = wall.points;
  cut.mesh.patches = wall.patches;
  const Column<VertexId, std::uint8_t> is_on = vertices_on_noses(finder);
  const Column<HalfedgeId, VertexId> node = add_crossings(finder, is_on, is_flat, cut);
  for (const TriangleId t : wall.triangles.ids()) {
    const std::array<VertexId, 3> middle{node[halfedge(t, 0)], node[halfedge(t, 1)], node[halfedge(t, 2)]};
    add_nose_edge(wall.triangles[t], middle, is_on, cut);
    add_parts(wall.triangles[t], middle, wall.triangle_patch[t], cut);
  }
  std::sort(cut.edges.begin(), cut.edges.end());
  cut.edges.erase(std::unique(cut.edges.begin(), cut.edges.end()), cut.edges.end());
  return cut;
}

std::optional<NoseCut> cut_noses_if_requested(const TriMesh& wall, const ReferenceOptions& reference_options, const RemeshOptions& options,
                                              std::span<const Rule> patches, const RunContext& context) {
  const bool is_requested = std::ranges::any_of(
      wall.patches, [&](const Patch& patch) { return band_targets(patch.name, resolve(options, patches, patch.name).sizes, patches).leading.is_any(); });
  if (!is_requested) return std::nullopt;
  const Reference reference(wall, reference_options, {}, {}, context);
  NoseCut cut = cut_noses(reference, !options.smooth, context);
  // The smooth surface between the given vertices may meet another part of the surface. The given triangles do not, so they are used in that case.
  if (options.smooth && find_crossings(cut.mesh, context).total > 0) cut = cut_noses(reference, true, context);
  // Only the candidates that are noses of wings are kept.
  ReferenceOptions with_all = reference_options;
  with_all.noses = std::move(cut.edges);
  const Reference all(cut.mesh, with_all, {}, {}, context);
  cut.edges.clear();
  for (const LineRows& rows : find_row_lines(all, SurfaceLimitTable(cut.mesh, all.topology, options, patches), options, patches).lines) {
    if (!all.lines[static_cast<std::size_t>(rows.line)].is_nose) continue;
    const std::vector<VertexId>& line = all.lines[static_cast<std::size_t>(rows.line)].vertices;
    for (std::size_t i = 0; i + 1 < line.size(); ++i) cut.edges.push_back({line[i], line[i + 1]});
  }
  return cut;
}

}  // namespace sterna::surfmesh
