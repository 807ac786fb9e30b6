// Treats facets of zero area with three different vertices: p, q, and r between them. Removing such a facet would open the surface (p-q on one side, p-r-q on
// the other). The edge p-q is flipped to r-d instead, where d is the far vertex of the neighbour. The surface stays the same set of points, because r lies
// exactly on p-q.
//   1. A flip with a neighbour that has an area leaves one flat facet less.
//   2. A flip between two flat facets that share their long edge leaves two flat facets with a shorter long edge. The pair (number of flat facets, sum of edge
// lengths) therefore decreases, and the loop ends.
#include <algorithm>

#include "geom/math/predicates.h"
#include "geom/mesh/edit_mesh.h"
#include "surfmesh/stitch/clean_facets.h"
#include "surfmesh/stitch/edge_table.h"

namespace sterna::surfmesh {
namespace {

/// Error bound for the components of a cross product, relative to the square of the largest edge component. It covers three roundings of 2^-53 in each of two
/// products, rounded up.
constexpr double k_cross_error = 16.0 * 0x1p-53;

bool is_between(const Vec3& r, const Vec3& p, const Vec3& q) {
  for (std::size_t axis = 0; axis < 3; ++axis) {
    const auto [low, high] = std::minmax({p[axis], q[axis]});
    if (r[axis] < low || r[axis] > high) return false;
  }
  return true;
}

class FlatFlipper {
 public:
  explicit FlatFlipper(WorkingSurface& surface) : surface_(surface) {
    const EdgeTable edges(surface.facets, surface.points.size());
    Column<TriangleId, TriangleVertices> triangles;
    triangles.reserve(surface.n_facets());
    for (const Facet& f : surface.facets) triangles.push_back({VertexId(f[0]), VertexId(f[1]), VertexId(f[2])});
    Column<HalfedgeId, HalfedgeId> twins(3 * surface.n_facets());
    for (const Edge& edge : edges.edges()) {
      if (edge.count != 2) continue;
      const HalfedgeId h(edges.at(edge)[0]), g(edges.at(edge)[1]);
      twins[h] = g;
      twins[g] = h;
    }
    mesh_ = EditMesh(surface.points.size(), std::move(triangles), std::move(twins));
  }

  bool is_flat(std::uint32_t facet) const {
    const auto c = surface_.corners(facet);
    return is_collinear(c[0], c[1], c[2]);
  }

  /// Flips the long edge of a flat facet if the current state allows it. With `with_flat` the neighbour may be flat, too.
  bool flip(std::uint32_t facet, bool with_flat) {
    const HalfedgeId h = long_edge(facet), g = mesh_.twins[h];
    if (!g.is_valid()) return false;
    const VertexId p = mesh_.from(h), q = mesh_.to(h), r = mesh_.apex(h), d = mesh_.apex(g);
    if (r == d || mesh_.is_edge(r, d)) return false;
    const std::uint32_t neighbour = triangle_of(g).value();
    if (is_flat(neighbour) && !(with_flat && long_edge(neighbour) == g)) return false;
    mesh_.flip(h, {r, p, d}, {d, q, r});
    surface_.facets[facet] = {r.value(), p.value(), d.value()};
    surface_.facets[neighbour] = {d.value(), q.value(), r.value()};
    surface_.patch[facet] = surface_.patch[neighbour];
    surface_.origin[facet] = surface_.origin[neighbour];
    return true;
  }

 private:
  /// Returns the half-edge between whose ends the third vertex lies.
  HalfedgeId long_edge(std::uint32_t facet) const {
    const HalfedgeId first = halfedge(TriangleId(facet), 0);
    const auto point = [&](VertexId v) { return surface_.points[v.index()]; };
    for (const HalfedgeId h : {first, next(first), previous(first)})
      if (is_between(point(mesh_.apex(h)), point(mesh_.from(h)), point(mesh_.to(h)))) return h;
    return first;
  }

  WorkingSurface& surface_;
  EditMesh mesh_;  ///< the facets of the surface
};

}  // namespace

bool is_collinear(const Vec3& a, const Vec3& b, const Vec3& c) {
  const Vec3 u = b - a, v = c - a, n = cross(u, v);
  const auto largest = [](const Vec3& w) { return std::max({std::abs(w.x), std::abs(w.y), std::abs(w.z)}); };
  if (largest(n) > k_cross_error * largest(u) * largest(v)) return false;
  return orient2d({a.x, a.y}, {b.x, b.y}, {c.x, c.y}) == 0 && orient2d({a.y, a.z}, {b.y, b.z}, {c.y, c.z}) == 0 &&
         orient2d({a.z, a.x}, {b.z, b.x}, {c.z, c.x}) == 0;
}

std::vector<std::uint32_t> flip_flat_facets(WorkingSurface& surface, StitchReport& report) {
  std::vector<std::uint32_t> flat;
  for (std::uint32_t t = 0; t < surface.n_facets(); ++t) {
    const auto c = surface.corners(t);
    if (is_collinear(c[0], c[1], c[2])) flat.push_back(t);
  }
  if (flat.empty()) return flat;
  const std::size_t n_before = flat.size();
  FlatFlipper flipper(surface);
  bool with_flat = false;
  while (!flat.empty()) {
    bool has_flipped = false;
    std::vector<std::uint32_t> left;
    for (const std::uint32_t t : flat) {
      // An earlier flip of this round may have given the facet an area.
      if (!flipper.is_flat(t)) continue;
      // After a flip of two flat facets, flips with neighbours that have an area are tried again first.
      if (!(with_flat && has_flipped)) has_flipped |= flipper.flip(t, with_flat);
      if (flipper.is_flat(t)) left.push_back(t);
    }
    flat.swap(left);
    if (!has_flipped && with_flat) break;
    with_flat = !has_flipped;
  }
  const std::size_t n_removed = n_before - flat.size();
  if (n_removed > 0) {
    report.n_degenerate_removed += static_cast<std::int64_t>(n_removed);
    report.messages.push_back("removed with edge flips: " + count_of(static_cast<std::int64_t>(n_removed), "facet", "facets") +
                              " of zero area (the shape of the surface is unchanged)");
  }
  return flat;
}

}  // namespace sterna::surfmesh
