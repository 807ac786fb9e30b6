#include "volmesh/envelope/layer_base.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <map>
#include <vector>

#include "geom/base/parallel.h"
#include "geom/math/measures.h"
#include "geom/math/spherical_cap.h"

namespace sterna::volmesh {
namespace {

constexpr double k_least_share_of_edge = 1.0 / 3.0;  ///< lower limit of the edge as a fraction of the mean edge, for stretched triangles
constexpr int k_edge_sweeps = 20;                    ///< number of smoothing sweeps, which cover about five rings, the thickness of a layer by eq. (1)

}  // namespace

double layer_edge_of(double equilateral_edge, double mean_edge) { return std::clamp(equilateral_edge, k_least_share_of_edge * mean_edge, mean_edge); }

namespace {

double worst_cosine_of(std::span<const Vec3> normals, const Vec3& d) {
  double worst = 1.0;
  for (const Vec3& n : normals) worst = std::min(worst, dot(n, d));
  return worst;
}

/// Returns the direction in the plane with the largest minimum of the cosines. At this direction two cosines are equal, or one cosine is at its own maximum.
Cap best_in_plane(const Vec3& axis, std::span<const Vec3> normals) {
  const VertexConstraint plane{Freedom::plane, axis};
  Vec3 x;
  for (std::size_t i = 0; i < normals.size() && norm2(x) == 0.0; ++i) x = constrained(plane, normals[i]);
  if (norm2(x) == 0.0) return {tangent_axes({}, axis).axis[0], 0.0};
  const Vec3 y = cross(axis, x);
  Cap best{x, worst_cosine_of(normals, x)};
  const auto offer = [&](double u, double v) {
    const Vec3 d = normalized(u * x + v * y);
    const double cosine = norm2(d) > 0.0 ? worst_cosine_of(normals, d) : -1.0;
    if (cosine > best.cosine) best = {d, cosine};
  };
  for (std::size_t i = 0; i < normals.size(); ++i) {
    const double u = dot(normals[i], x), v = dot(normals[i], y);
    offer(u, v);
    for (std::size_t k = 0; k < i; ++k) {
      const double du = dot(normals[k], x) - u, dv = dot(normals[k], y) - v;
      offer(-dv, du);
      offer(dv, -du);
    }
  }
  return best;
}

}  // namespace

Cap best_seen(const VertexConstraint& constraint, std::span<const Vec3> normals) {
  switch (constraint.freedom) {
    case Freedom::plane:
    case Freedom::surface: return best_in_plane(constraint.axis, normals);
    case Freedom::line: {
      const double ahead = worst_cosine_of(normals, constraint.axis), back = worst_cosine_of(normals, -constraint.axis);
      return ahead >= back ? Cap{constraint.axis, ahead} : Cap{-constraint.axis, back};
    }
    case Freedom::free:
    case Freedom::fixed: break;
  }
  return smallest_cap(normals);
}

Cap smallest_cap(std::span<const Vec3> normals) {
  const Vec3 axis = smallest_spherical_cap(normals).axis;
  return {axis, worst_cosine_of(normals, axis)};
}

LayerBase::LayerBase(Borrowed<const TriMesh> mesh, const RunContext& context, Constraints constraints, const OpenedRidges* opened)
    : wall(mesh),
      topology(mesh, context),
      body_length(sterna::body_length(mesh)),
      constraint(std::move(constraints.vertex)),
      surfaces(std::move(constraints.surfaces)),
      near(std::move(constraints.near)),
      unit_normal(mesh->n_triangles()),
      area(mesh->n_triangles()),
      vertex_normal(mesh->n_vertices()),
      visible_direction(mesh->n_vertices()),
      visibility(mesh->n_vertices()),
      facet_cosine(mesh->n_vertices()),
      mean_edge(mesh->n_vertices()),
      longest_edge(mesh->n_vertices()),
      layer_edge(mesh->n_vertices()),
      vertex_area(mesh->n_vertices()),
      ridges(opened != nullptr && !opened->is_empty() ? opened : nullptr) {
  if (constraint.empty()) constraint.resize(mesh->n_vertices());
  parallel_for(context, mesh->n_triangles(), [&](std::size_t i) {
    const TriangleId t(i);
    const auto [a, b, c] = corners(mesh, t);
    const Vec3 n = area_vector(a, b, c);
    area[t] = norm(n);
    unit_normal[t] = normalized(n);
  });
  parallel_for(context, mesh->n_vertices(), [&](std::size_t i) {
    const VertexId v(i);
    derive({&v, 1});
  });
  set_layer_edges(context);
}

void LayerBase::set_layer_edges(const RunContext& context) {
  const std::size_t n = wall.n_vertices();
  parallel_for(context, n, [&](std::size_t i) {
    const VertexId v(i);
    const auto n_triangles = static_cast<double>(topology.outgoing(v).size());
    if (n_triangles == 0.0) return;
    layer_edge[v] = layer_edge_of(std::sqrt(k_equilateral * 3.0 * vertex_area[v] / n_triangles), mean_edge[v]);
  });
  if (ridges != nullptr) even_out_multi_normals();
  std::vector<double> own(n), next(n);
  for (std::size_t i = 0; i < n; ++i) own[i] = std::log(std::max(layer_edge[VertexId(i)], std::numeric_limits<double>::min()));
  for (int sweep = 0; sweep < k_edge_sweeps; ++sweep) {
    parallel_for(context, n, [&](std::size_t i) {
      const VertexId v(i);
      double sum = 0.0, weights = 0.0;
      for (const VertexId other : topology.neighbours(v)) {
        if (share_base_vertex(v, other)) continue;
        const double weight = mirror_weight(v, other);
        sum += weight * own[other.index()];
        weights += weight;
      }
      next[i] = weights > 0.0 ? 0.5 * (own[i] + sum / weights) : own[i];
    });
    own.swap(next);
  }
  parallel_for(context, n, [&](std::size_t i) { layer_edge[VertexId(i)] = std::exp(own[i]); });
}

/// Gives growth lines with a common ridge base vertex the edges of the given triangles around that vertex.
void LayerBase::even_out_multi_normals() {
  struct Sums {
    double area = 0.0, n_triangles = 0.0, edges = 0.0, n_lines = 0.0;
  };
  Column<VertexId, Sums> of_base(ridges->n_given_vertices);
  for (const VertexId v : wall.points.ids()) {
    Sums& sums = of_base[ridges->base_vertex[v]];
    for (const HalfedgeId h : topology.outgoing(v)) {
      if (is_virtual(triangle_of(h))) continue;
      sums.area += area[triangle_of(h)];
      sums.n_triangles += 1.0;
    }
    sums.edges += mean_edge[v];  // growth lines inside a corner have no edges of given triangles
    sums.n_lines += mean_edge[v] > 0.0 ? 1.0 : 0.0;
  }
  for (const VertexId v : wall.points.ids()) {
    const Sums& sums = of_base[ridges->base_vertex[v]];
    const bool is_end = std::ranges::binary_search(ridges->end_vertices, v);
    if ((sums.n_lines == 1.0 && !is_end) || sums.n_triangles == 0.0) continue;
    mean_edge[v] = sums.edges / sums.n_lines;
    layer_edge[v] = layer_edge_of(std::sqrt(k_equilateral * sums.area / sums.n_triangles), mean_edge[v]);
  }
}

/// Computes the quantities that depend on the triangles at a vertex, or at all vertices of a group. All vertices of a group get the same values, except for
/// areas.
void LayerBase::derive(std::span<const VertexId> alike) {
  Vec3 sum;
  double length = 0.0, weights = 0.0, angles = 0.0, longest = 0.0;
  std::vector<Vec3> normals;
  for (const VertexId v : alike) {
    const Point p = wall.points[v];
    double third = 0.0;
    for (const HalfedgeId h : topology.outgoing(v)) {
      const TriangleId t = triangle_of(h);
      const double angle = corner_angle(p, wall.points[topology.to(h)], wall.points[topology.from(previous(h))]);
      sum += angle * unit_normal[t];
      angles += angle;
      third += area[t] / 3.0;
      normals.push_back(unit_normal[t]);
    }
    vertex_area[v] = third;
    for (const VertexId other : topology.neighbours(v)) {
      if (share_base_vertex(v, other)) continue;
      const double weight = mirror_weight(v, other);
      const double own = distance(p, wall.points[other]);
      length += weight * own;
      longest = std::max(longest, own);
      weights += weight;
    }
  }
  const VertexId first = alike.front();
  const VertexConstraint& own = constraint[first];
  mean_edge[first] = weights > 0.0 ? length / weights : 0.0;
  vertex_normal[first] = own.freedom == Freedom::fixed ? normalized(sum) : constrained(own, sum);
  if (!normals.empty()) {
    const Cap cap = best_seen(own, normals);
    visible_direction[first] = cap.axis;
    visibility[first] = cap.cosine;
    if (norm2(vertex_normal[first]) == 0.0) vertex_normal[first] = cap.axis;
    const double seen = worst_cosine_of(normals, vertex_normal[first]);
    if (seen > cap.cosine) {  // for caps of more than a right angle, the smallest cosine of the angle-weighted mean may be better
      visible_direction[first] = vertex_normal[first];
      visibility[first] = seen;
    }
  }
  longest_edge[first] = longest;
  facet_cosine[first] = angles > 0.0 ? dot(sum, vertex_normal[first]) / angles : 1.0;
  for (const VertexId v : alike.subspan(1)) {
    longest_edge[v] = longest;
    facet_cosine[v] = facet_cosine[first];
    mean_edge[v] = mean_edge[first];
    vertex_normal[v] = vertex_normal[first];
    visible_direction[v] = visible_direction[first];
    visibility[v] = visibility[first];
  }
}

void LayerBase::let_grow_alike(const std::vector<std::array<VertexId, 2>>& partners) {
  if (partners.empty()) return;
  std::map<VertexId, VertexId> parent;
  const auto root = [&](VertexId v) {
    while (parent.at(v) != v) v = parent.at(v);
    return v;
  };
  for (const auto& pair : partners)
    for (const VertexId v : pair) parent.try_emplace(v, v);
  for (const auto& [a, b] : partners) {
    const VertexId ra = root(a), rb = root(b);
    parent[std::max(ra, rb)] = std::min(ra, rb);
  }
  std::map<VertexId, std::vector<VertexId>> by_root;
  for (const auto& entry : parent) by_root[root(entry.first)].push_back(entry.first);
  group.assign(wall.n_vertices(), k_none);
  groups.clear();
  for (auto& entry : by_root) {
    for (const VertexId v : entry.second) {
      group[v] = static_cast<std::uint32_t>(groups.size());
      // The directions of partners are equal except for rounding. From here on they are bit-identical.
      if (constraint[v].freedom == Freedom::line) constraint[v].axis = constraint[entry.second.front()].axis;
    }
    groups.push_back(std::move(entry.second));
    derive(groups.back());
    double least = layer_edge[groups.back().front()];
    for (const VertexId v : groups.back()) least = std::min(least, layer_edge[v]);
    for (const VertexId v : groups.back()) layer_edge[v] = least;
  }
}

const OpenedRidges::BaseVertex* LayerBase::multi_normal_of(VertexId v) const {
  if (ridges == nullptr) return nullptr;
  const auto multi_normal = std::ranges::lower_bound(ridges->base_vertices, ridges->base_vertex[v], {}, &OpenedRidges::BaseVertex::vertex);
  return multi_normal != ridges->base_vertices.end() && multi_normal->vertex == ridges->base_vertex[v] ? &*multi_normal : nullptr;
}

double LayerBase::cone_visibility(VertexId v) const {
  const OpenedRidges::BaseVertex* const multi_normal = multi_normal_of(v);
  return multi_normal != nullptr && std::isfinite(multi_normal->to_end) ? std::min(visibility[v], multi_normal->visibility) : visibility[v];
}

double LayerBase::mirror_weight(VertexId v, VertexId other) const {
  double weight = 1.0;
  for (const std::int32_t surface : constraint[v].on)
    if (surface >= 0 && surfaces[static_cast<std::size_t>(surface)]->is_mirror() && !constraint[other].is_on(static_cast<std::size_t>(surface))) weight *= 2.0;
  return weight;
}

double LayerBase::worst_cosine(VertexId v, const Vec3& d) const {
  double worst = 1.0;
  for (const HalfedgeId h : topology.outgoing(v)) worst = std::min(worst, dot(unit_normal[triangle_of(h)], d));
  return worst;
}

}  // namespace sterna::volmesh
