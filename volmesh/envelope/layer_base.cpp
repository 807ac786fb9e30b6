#include "volmesh/envelope/layer_base.h"

#include <algorithm>
#include <vector>

#include "geom/base/parallel.h"
#include "geom/math/measures.h"

namespace sterna::volmesh {
namespace {

/// A normal this much (in cosine) outside a cap still counts as inside: far below any angle that matters, far above rounding.
constexpr double k_cap_slack = 1e-12;

Vec3 cap_axis(const Vec3& a, const Vec3& b) { return normalized(a + b); }

/// Axis of the circle through three unit vectors, on their side; falls back on two of them when they are nearly collinear on the sphere.
Vec3 cap_axis(const Vec3& a, const Vec3& b, const Vec3& c) {
  const Vec3 axis = normalized(cross(b - a, c - a));
  if (norm2(axis) == 0.0) return cap_axis(a, b);
  return dot(axis, a) < 0.0 ? -axis : axis;
}

}  // namespace

// Incremental smallest enclosing cap (Welzl 1991, on the sphere): a normal outside the cap of its predecessors lies on the new cap's border.
Cap smallest_cap(std::span<const Vec3> normals) {
  Cap cap{normals[0], 1.0};
  const auto is_outside = [&](const Vec3& n) { return dot(n, cap.axis) < cap.cosine - k_cap_slack; };
  const auto fit = [&](const Vec3& axis, const Vec3& border) { cap = {axis, dot(axis, border)}; };
  for (std::size_t i = 1; i < normals.size(); ++i) {
    if (!is_outside(normals[i])) continue;
    fit(cap_axis(normals[i], normals[0]), normals[i]);
    for (std::size_t j = 1; j < i; ++j) {
      if (!is_outside(normals[j])) continue;
      fit(cap_axis(normals[i], normals[j]), normals[i]);
      for (std::size_t k = 0; k < j; ++k)
        if (is_outside(normals[k])) fit(cap_axis(normals[i], normals[j], normals[k]), normals[i]);
    }
  }
  cap.cosine = 1.0;
  for (const Vec3& n : normals) cap.cosine = std::min(cap.cosine, dot(n, cap.axis));
  return cap;
}

LayerBase::LayerBase(const TriMesh& mesh, const RunContext& context, Constraints constraints)
    : wall(mesh),
      topology(mesh, context),
      body_length(sterna::body_length(mesh)),
      constraint(std::move(constraints.vertex)),
      surfaces(std::move(constraints.surfaces)),
      unit_normal(mesh.n_triangles()),
      area(mesh.n_triangles()),
      vertex_normal(mesh.n_vertices()),
      visible_direction(mesh.n_vertices()),
      visibility(mesh.n_vertices()),
      mean_edge(mesh.n_vertices()),
      vertex_area(mesh.n_vertices()) {
  if (constraint.empty()) constraint.resize(mesh.n_vertices());
  parallel_for(context, mesh.n_triangles(), [&](std::size_t i) {
    const TriangleId t(i);
    const auto [a, b, c] = corners(mesh, t);
    const Vec3 n = area_vector(a, b, c);
    area[t] = norm(n);
    unit_normal[t] = normalized(n);
  });
  parallel_for(context, mesh.n_vertices(), [&](std::size_t i) {
    const VertexId v(i);
    Vec3 sum;
    double third = 0.0;
    std::vector<Vec3> normals;
    for (const HalfedgeId h : topology.outgoing(v)) {
      const TriangleId t = triangle_of(h);
      const Point p = mesh.points[v];
      const double angle = corner_angle(p, mesh.points[topology.to(h)], mesh.points[topology.from(previous(h))]);
      sum += angle * unit_normal[t];
      third += area[t] / 3.0;
      normals.push_back(unit_normal[t]);
    }
    vertex_area[v] = third;
    double length = 0.0;
    const auto around = topology.neighbours(v);
    for (const VertexId other : around) length += distance(mesh.points[v], mesh.points[other]);
    mean_edge[v] = around.empty() ? 0.0 : length / static_cast<double>(around.size());
    vertex_normal[v] = normalized(sum);
    if (normals.empty()) return;
    const Cap cap = smallest_cap(normals);
    visible_direction[v] = cap.axis;
    visibility[v] = cap.cosine;
    const double own = worst_cosine(v, vertex_normal[v]);
    if (own > cap.cosine) {  // caps beyond a right angle: the angle-weighted mean may see more
      visible_direction[v] = vertex_normal[v];
      visibility[v] = own;
    }
  });
}

double LayerBase::worst_cosine(VertexId v, const Vec3& d) const {
  double worst = 1.0;
  for (const HalfedgeId h : topology.outgoing(v)) worst = std::min(worst, dot(unit_normal[triangle_of(h)], d));
  return worst;
}

}  // namespace sterna::volmesh
