// Treats facets of zero area with three different vertices: p, q, and r between them. Removing such a facet would open the surface (p-q on one side, p-r-q on
// the other). The edge p-q is flipped to r-d instead, where d is the far vertex of the neighbour. The surface stays the same set of points, because r lies
// exactly on p-q.
//   1. A flip with a neighbour that has an area leaves one flat facet less.
//   2. A flip between two flat facets that share their long edge leaves two flat facets with a shorter long edge. The pair (number of flat facets, sum of edge
// lengths) therefore decreases, and the loop ends.
#include <algorithm>

#include "geom/math/predicates.h"
#include "surfmesh/stitch/clean_facets.h"
#include "surfmesh/stitch/edge_table.h"

namespace sterna::surfmesh {
namespace {

constexpr std::uint32_t k_no_twin = 0xffffffffu;

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
    twin_.assign(3 * surface.n_facets(), k_no_twin);
    for (const Edge& edge : edges.edges()) {
      if (edge.count != 2) continue;
      const auto h = edges.at(edge);
      twin_[h[0]] = h[1];
      twin_[h[1]] = h[0];
    }
    first_out_.assign(surface.points.size(), k_no_twin);
    for (std::uint32_t h = 0; h < twin_.size(); ++h) first_out_[from(h)] = h;
  }

  bool is_flat(std::uint32_t facet) const {
    const auto c = surface_.corners(facet);
    return is_collinear(c[0], c[1], c[2]);
  }

  /// Flips the long edge of a flat facet if the current state allows it. With `with_flat` the neighbour may be flat, too.
  bool flip(std::uint32_t facet, bool with_flat) {
    const std::uint32_t h = long_edge(facet);
    const std::uint32_t g = twin_[h];
    if (g == k_no_twin) return false;
    const std::uint32_t p = from(h), q = from(next_halfedge(h)), r = from(previous_halfedge(h)), d = from(previous_halfedge(g));
    if (r == d || is_edge(r, d)) return false;
    if (is_flat(g / 3) && !(with_flat && long_edge(g / 3) == g)) return false;
    // The facets (p, q, r) and (q, p, d) become (r, p, d) and (d, q, r).
    const std::uint32_t t = h / 3, u = g / 3;
    const std::uint32_t qr = twin_[next_halfedge(h)], rp = twin_[previous_halfedge(h)];
    const std::uint32_t pd = twin_[next_halfedge(g)], dq = twin_[previous_halfedge(g)];
    surface_.facets[t] = {r, p, d};
    surface_.facets[u] = {d, q, r};
    surface_.patch[t] = surface_.patch[u];
    surface_.origin[t] = surface_.origin[u];
    join(3 * t, rp);
    join(3 * t + 1, pd);
    join(3 * t + 2, 3 * u + 2);
    join(3 * u, dq);
    join(3 * u + 1, qr);
    first_out_[r] = 3 * t;
    first_out_[p] = 3 * t + 1;
    first_out_[d] = 3 * u;
    first_out_[q] = 3 * u + 1;
    return true;
  }

 private:
  std::uint32_t from(std::uint32_t h) const { return surface_.facets[h / 3][h % 3]; }

  void join(std::uint32_t h, std::uint32_t g) {
    twin_[h] = g;
    if (g != k_no_twin) twin_[g] = h;
  }

  /// Returns the half-edge between whose ends the third vertex lies.
  std::uint32_t long_edge(std::uint32_t facet) const {
    for (std::uint32_t k = 0; k < 3; ++k) {
      const std::uint32_t h = 3 * facet + k;
      if (is_between(surface_.points[from(previous_halfedge(h))], surface_.points[from(h)], surface_.points[from(next_halfedge(h))])) return h;
    }
    return 3 * facet;
  }

  /// Returns true if a facet contains both vertices. The fan of `v` is traversed in both directions, because a boundary may interrupt it.
  bool is_edge(std::uint32_t v, std::uint32_t w) const {
    const std::uint32_t start = first_out_[v];
    const auto has_w = [&](std::uint32_t h) { return from(next_halfedge(h)) == w || from(previous_halfedge(h)) == w; };
    std::uint32_t h = start;
    do {
      if (has_w(h)) return true;
      h = twin_[previous_halfedge(h)];
    } while (h != k_no_twin && h != start);
    if (h == start) return false;
    for (std::uint32_t g = twin_[start]; g != k_no_twin; g = twin_[h]) {
      h = next_halfedge(g);
      if (has_w(h)) return true;
    }
    return false;
  }

  WorkingSurface& surface_;
  std::vector<std::uint32_t> twin_;
  std::vector<std::uint32_t> first_out_;
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
