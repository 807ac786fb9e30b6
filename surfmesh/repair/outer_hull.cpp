// Every facet has two sides. Around an edge, the sides of two consecutive facets that face each other bound the same space, so sides form cells. Each
// edge-connected part has its own cells. Rays determine which cells of different parts are the same cell, and which cell is the outside. For closed parts this
// is equivalent to winding numbers, but it does not depend on the orientation of the facets.
#include <algorithm>
#include <cmath>
#include <memory>

#include "geom/base/disjoint_sets.h"
#include "geom/base/parallel.h"
#include "geom/math/measures.h"
#include "geom/math/predicates.h"
#include "geom/mesh/bvh.h"
#include "surfmesh/repair/repair_state.h"
#include "surfmesh/stitch/orient.h"

namespace sterna::surfmesh {
namespace {

constexpr int k_rays = 60;               ///< number of rays tried for each part
constexpr double k_from_edge = 1e-6;     ///< barycentric coordinate: a ray that passes nearer to an edge is inconclusive
constexpr double k_beside_share = 1e-7;  ///< relative to L: distance from a facet at which its sides are tested
/// Fraction of the area of facets that are solid by winding number but have the outside on both sides; with a larger fraction, the hull leaks.
constexpr double k_most_leaking = 0.005;
constexpr double k_least_kept = 0.01;          ///< fraction of the area that the hull must keep; with less, there is no body
constexpr std::size_t k_within_samples = 300;  ///< number of facets of a component that are tested for lying inside another component
/// Relative to a component's length: if it is nearer than this to the surface of another component, it touches that component.
constexpr double k_contact_share = 2e-3;
constexpr double k_mostly_within = 0.9;  ///< fraction of the samples that must be within the other component
constexpr double k_grazing = 1e-4;       ///< if the cosine of the angle to the normal is below this, the ray is inconclusive as well

struct AroundEdge {
  std::uint32_t third = 0;  ///< vertex of the facet opposite to the edge
  std::uint32_t facet = 0;
  bool is_along = false;  ///< the facet runs from the low to the high vertex of the edge
};

/// Returns the facets at an edge, sorted by their angle around low -> high, counter-clockwise from the first facet.
std::vector<AroundEdge> around(const RepairState& state, const EdgeTable& edges, const Edge& edge) {
  std::vector<AroundEdge> list;
  for (const std::uint32_t h : edges.at(edge)) {
    const Facet& f = state.facets[h / 3];
    list.push_back({f[previous_halfedge(h) % 3], h / 3, f[h % 3] == edge.low});
  }
  if (list.size() < 3) return list;
  const Vec3 &u = state.points[edge.low], &v = state.points[edge.high];
  const Vec3& w0 = state.points[list[0].third];
  const Vec3 axis = normalized(v - u);
  const auto across = [&](const Vec3& p) { return (p - u) - dot(p - u, axis) * axis; };
  const Vec3 first = across(w0);
  const auto half = [&](const AroundEdge& x) {  // 0: direction of the first facet, 1: less than half a turn from it, 2: half a turn, 3: more
    const Vec3& p = state.points[x.third];
    const int side = orient3d(u, v, w0, p);
    if (side != 0) return side > 0 ? 1 : 3;
    return dot(across(p), first) > 0.0 ? 0 : 2;
  };
  std::sort(list.begin() + 1, list.end(), [&](const AroundEdge& a, const AroundEdge& b) {
    const int ha = half(a), hb = half(b);
    if (ha != hb) return ha < hb;
    const int side = orient3d(u, v, state.points[a.third], state.points[b.third]);
    return side != 0 ? side > 0 : a.facet < b.facet;
  });
  return list;
}

/// Side 2 f is on the side of facet f to which its normal points; 2 f + 1 is the other side.
std::uint32_t side_ahead(const AroundEdge& x) { return 2 * x.facet + (x.is_along ? 0 : 1); }
std::uint32_t side_behind(const AroundEdge& x) { return 2 * x.facet + (x.is_along ? 1 : 0); }

struct Sides {
  DisjointSets cells;
  std::uint32_t outside;
};

/// Follows the ray and joins the sides that face each other. Returns false if the ray is inconclusive.
bool join_along(const TriMesh& mesh, const TriangleTree& tree, std::uint32_t start, const Vec3& direction, Sides& sides) {
  const auto c = corners(mesh, TriangleId(start));
  const Vec3 p = (c[0] + c[1] + c[2]) / 3.0;
  std::vector<std::uint32_t> crossed{start};
  for (const auto& hit : tree.ray(p, direction)) {
    if (hit.triangle.value() != start) crossed.push_back(hit.triangle.value());
  }
  const auto cosine = [&](std::uint32_t t) {
    const auto k = corners(mesh, TriangleId(t));
    return dot(normalized(area_vector(k[0], k[1], k[2])), direction);
  };
  for (std::size_t i = 0; i < crossed.size(); ++i) {
    if (std::abs(cosine(crossed[i])) < k_grazing) return false;
    if (i == 0) continue;
    const auto k = corners(mesh, TriangleId(crossed[i]));
    const double whole = dot(cross(k[1] - k[0], k[2] - k[0]), direction);
    for (std::size_t e = 0; e < 3; ++e) {
      const Vec3 a = k[e] - p, b = k[(e + 1) % 3] - p;
      if (dot(cross(a, b), direction) / whole < k_from_edge) return false;
    }
  }
  std::uint32_t before = 2 * start + (cosine(start) > 0.0 ? 0 : 1);
  for (std::size_t i = 1; i < crossed.size(); ++i) {
    const bool is_up = cosine(crossed[i]) > 0.0;
    sides.cells.join(before, 2 * crossed[i] + (is_up ? 1 : 0));
    before = 2 * crossed[i] + (is_up ? 0 : 1);
  }
  sides.cells.join(before, sides.outside);
  return true;
}

TriMesh mesh_of(const RepairState& state) {
  TriMesh mesh;
  const PatchId patch = mesh.patches.push_back({"wall", PatchKind::wall});
  mesh.points.raw() = state.points;
  for (const Facet& f : state.facets) {
    mesh.triangles.push_back({VertexId(f[0]), VertexId(f[1]), VertexId(f[2])});
    mesh.triangle_patch.push_back(patch);
  }
  return mesh;
}

/// Returns directions spread over the sphere, none along an axis.
Vec3 ray_direction(int i) {
  const double golden = 2.399963229728653, z = 1.0 - (2.0 * i + 1.0) / k_rays, r = std::sqrt(1.0 - z * z);
  return normalized(Vec3{r * std::cos(golden * i + 0.3), r * std::sin(golden * i + 0.3), z + 0.0123});
}

Sides find_cells(const RepairState& state, const EdgeTable& edges, const RunContext& context) {
  const auto n = static_cast<std::uint32_t>(2 * state.facets.size());
  Sides sides{DisjointSets(n + 1), n};
  for (const Edge& edge : edges.edges()) {
    const std::vector<AroundEdge> list = around(state, edges, edge);
    for (std::size_t i = 0; i < list.size(); ++i) sides.cells.join(side_ahead(list[i]), side_behind(list[(i + 1) % list.size()]));
  }
  const Parts parts = connected_parts(state.facets.size(), edges);
  std::vector<std::vector<std::uint32_t>> facets(parts.count);
  for (std::uint32_t t = 0; t < state.facets.size(); ++t) facets[parts.part[t]].push_back(t);
  const TriMesh mesh = mesh_of(state);
  const TriangleTree tree(mesh, context);
  for (auto& part : facets) {
    context.check_stop();
    const auto area = [&](std::uint32_t t) {
      const auto c = state.corners(t);
      return norm2(area_vector(c[0], c[1], c[2]));
    };
    const std::size_t n_first = std::min<std::size_t>(part.size(), 8);
    std::partial_sort(part.begin(), part.begin() + static_cast<std::ptrdiff_t>(n_first), part.end(), [&](std::uint32_t a, std::uint32_t b) {
      const double aa = area(a), ab = area(b);
      return aa != ab ? aa > ab : a < b;
    });
    bool is_decided = false;
    for (int i = 0; i < k_rays && !is_decided; ++i) is_decided = join_along(mesh, tree, part[static_cast<std::size_t>(i) % n_first], ray_direction(i), sides);
  }
  return sides;
}

/// A component that is connected across edges with two facets.
struct Body {
  std::vector<std::pair<std::uint32_t, bool>> facets;  ///< facet, and true if it must be reversed to point outwards
  Box box;
  double volume = 0.0;     ///< signed volume, with the orientation of its first facet
  bool is_outward = true;  ///< most of its facets point outwards in the input
  bool is_closed = true;
};

std::vector<Body> bodies_of(const RepairState& state) {
  const EdgeTable edges = state.edges();
  WorkingSurface surface;
  surface.points = state.points;
  surface.facets = state.facets;
  const Orientation orientation = flood_orientation(surface, edges);
  const Vec3 origin = surface.box().center();
  std::vector<Body> bodies(orientation.n_components);
  std::vector<double> as_given(orientation.n_components, 0.0);
  for (std::uint32_t t = 0; t < state.facets.size(); ++t) {
    Body& body = bodies[orientation.component[t]];
    const auto c = state.corners(t);
    const double sign = orientation.is_flipped[t] ? -1.0 : 1.0;
    body.volume += sign * tet_volume(origin, c[0], c[1], c[2]);
    as_given[orientation.component[t]] += sign * triangle_area(c[0], c[1], c[2]);
    for (const Vec3& p : c) body.box.add(p);
    for (std::uint32_t h = 3 * t; h < 3 * t + 3; ++h) {
      const Edge& edge = edges.edge_of(h);
      std::size_t n_own = 0;
      for (const std::uint32_t g : edges.at(edge)) n_own += orientation.component[g / 3] == orientation.component[t];
      body.is_closed &= n_own == 2;
    }
  }
  for (std::uint32_t i = 0; i < bodies.size(); ++i) bodies[i].is_outward = (bodies[i].volume > 0.0) == (as_given[i] >= 0.0);
  for (std::uint32_t t = 0; t < state.facets.size(); ++t) {
    Body& body = bodies[orientation.component[t]];
    body.facets.push_back({t, static_cast<bool>(orientation.is_flipped[t]) != (body.volume < 0.0)});
  }
  return bodies;
}

TriMesh mesh_of(const RepairState& state, const Body& body) {
  TriMesh mesh;
  const PatchId patch = mesh.patches.push_back({"wall", PatchKind::wall});
  mesh.points.raw() = state.points;
  for (const auto& [t, is_turned] : body.facets) {
    const Facet& f = state.facets[t];
    mesh.triangles.push_back({VertexId(f[0]), VertexId(f[is_turned ? 2 : 1]), VertexId(f[is_turned ? 1 : 2])});
    mesh.triangle_patch.push_back(patch);
  }
  return mesh;
}

bool is_box_within(const Box& inner, const Box& outer, double tolerance) {
  for (std::size_t k = 0; k < 3; ++k)
    if (inner.min[k] < outer.min[k] - tolerance || inner.max[k] > outer.max[k] + tolerance) return false;
  return true;
}

struct Within {
  double share = 0.0;   ///< fraction of the samples that are within the other component
  bool is_all = false;  ///< all samples are within the other component or touch it
};

Within how_within(const RepairState& state, const Body& inner, const TriangleTree& outer) {
  Within result{0.0, true};
  const std::size_t step = std::max<std::size_t>(1, inner.facets.size() / k_within_samples);
  const double near = k_contact_share * inner.box.longest_side();
  std::size_t n = 0, n_in = 0;
  for (std::size_t i = 0; i < inner.facets.size(); i += step) {
    const auto c = state.corners(inner.facets[i].first);
    for (const Vec3& p : {c[0], (c[0] + c[1] + c[2]) / 3.0}) {
      const bool is_in = std::abs(outer.winding_number(p)) > 0.5 || outer.nearest(p, near).triangle.is_valid();
      ++n;
      n_in += is_in;
      result.is_all &= is_in;
    }
  }
  result.share = n == 0 ? 0.0 : static_cast<double>(n_in) / static_cast<double>(n);
  return result;
}

}  // namespace

SolidReference solid_reference(const RepairState& state, bool is_fluid_inside, const RunContext& context) {
  const std::vector<Body> bodies = bodies_of(state);
  std::vector<std::uint32_t> level(bodies.size(), 0);
  std::uint32_t n_levels = 1;
  std::vector<std::uint32_t> order(bodies.size());
  for (std::uint32_t i = 0; i < order.size(); ++i) order[i] = i;
  std::ranges::stable_sort(order, [&](std::uint32_t a, std::uint32_t b) { return std::abs(bodies[a].volume) > std::abs(bodies[b].volume); });
  std::vector<std::unique_ptr<TriangleTree>> trees(bodies.size());
  for (std::size_t i = 1; i < order.size(); ++i) {
    const Body& inner = bodies[order[i]];
    if (!inner.is_closed) continue;
    for (std::size_t j = 0; j < i; ++j) {
      context.check_stop();
      const Body& outer = bodies[order[j]];
      if (!outer.is_closed || !is_box_within(inner.box, outer.box, k_contact_share * inner.box.longest_side())) continue;
      if (!trees[order[j]]) trees[order[j]] = std::make_unique<TriangleTree>(mesh_of(state, outer), context);
      const bool is_opposite = inner.is_outward != outer.is_outward;
      const Within within = how_within(state, inner, *trees[order[j]]);
      if (within.share < k_mostly_within) continue;
      const bool is_apart = is_opposite || (is_fluid_inside && within.is_all);
      level[order[i]] = std::max(level[order[i]], level[order[j]] + (is_apart ? 1u : 0u));
      n_levels = std::max(n_levels, level[order[i]] + 1);
    }
  }
  SolidReference reference;
  reference.is_by_winding = is_fluid_inside || n_levels > 1;
  for (std::uint32_t l = 0; l < n_levels; ++l) {
    Body all;
    for (std::uint32_t i = 0; i < bodies.size(); ++i)
      if (level[i] == l) all.facets.insert(all.facets.end(), bodies[i].facets.begin(), bodies[i].facets.end());
    reference.levels.push_back(mesh_of(state, all));
  }
  return reference;
}

bool keep_outer_hull(RepairState& state, const SolidReference& reference, const RunContext& context) {
  const EdgeTable edges = state.edges();
  Sides sides = find_cells(state, edges, context);
  const std::uint32_t outside = sides.cells.root(sides.outside);
  std::vector<std::unique_ptr<TriangleTree>> winding;
  for (const TriMesh& level : reference.levels) winding.push_back(std::make_unique<TriangleTree>(level, context));
  const double off = k_beside_share * state.length;
  const auto is_solid = [&](std::uint32_t t, double side) {
    const auto c = state.corners(t);
    const Vec3 p = (c[0] + c[1] + c[2]) / 3.0 + side * off * normalized(area_vector(c[0], c[1], c[2]));
    for (std::size_t l = winding.size(); l-- > 0;)
      if (std::abs(winding[l]->winding_number(p)) > 0.5) return l % 2 == 0;
    return false;
  };
  std::vector<char> front(state.facets.size()), back(state.facets.size());  // per facet: true if the outside is in front of it, or behind it
  double all = 0.0, leaking = 0.0;
  for (std::uint32_t t = 0; t < state.facets.size(); ++t) {
    front[t] = sides.cells.root(2 * t) == outside;
    back[t] = sides.cells.root(2 * t + 1) == outside;
    const auto c = state.corners(t);
    const double area = triangle_area(c[0], c[1], c[2]);
    all += area;
    if (front[t] && back[t] && (is_solid(t, 1.0) || is_solid(t, -1.0))) leaking += area;
  }
  if (reference.is_by_winding || leaking > k_most_leaking * all) {
    if (!reference.is_by_winding) context.debug("repair: open edges connect the inside to the outside: the sides are determined by winding numbers");
    parallel_for(
        context, state.facets.size(),
        [&](std::size_t t) {
          front[t] = !is_solid(static_cast<std::uint32_t>(t), 1.0);
          back[t] = !is_solid(static_cast<std::uint32_t>(t), -1.0);
        },
        256);
  }
  std::vector<char> is_kept(state.facets.size(), 0), is_sheet(state.facets.size(), 0), is_inside(state.facets.size(), 0), is_turned(state.facets.size(), 0);
  double kept = 0.0;
  for (std::uint32_t t = 0; t < state.facets.size(); ++t) {
    is_sheet[t] = front[t] && back[t];
    is_inside[t] = !front[t] && !back[t];
    is_kept[t] = front[t] != back[t];
    is_turned[t] = is_kept[t] && back[t];
    const auto c = state.corners(t);
    if (is_kept[t]) kept += triangle_area(c[0], c[1], c[2]);
  }
  if (kept < k_least_kept * all) return false;
  state.note_parts(RepairKind::removed_sheet, is_sheet, edges);
  state.note_parts(RepairKind::removed_inside, is_inside, edges);
  for (std::uint32_t t = 0; t < state.facets.size(); ++t)
    if (is_turned[t]) std::swap(state.facets[t][1], state.facets[t][2]);
  state.keep(is_kept);
  return true;
}

}  // namespace sterna::surfmesh
