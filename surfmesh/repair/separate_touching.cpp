// At an edge with four facets or more, the two on the sides of one wedge of the solid stay together. Fans of facets that hang together so at a vertex get a
// copy of it each; all of them move a little into their solid, so that they no longer touch.
#include <algorithm>
#include <map>

#include "geom/math/measures.h"
#include "geom/math/predicates.h"
#include "surfmesh/repair/repair_state.h"

namespace sterna::surfmesh {
namespace {

constexpr double k_apart_share = 1e-5;    ///< of L
constexpr double k_apart_of_edge = 0.02;  ///< of the shortest edge at the vertex: no facet turns over
constexpr std::uint32_t k_no_partner = 0xffffffffu;

/// Twins of half-edges; at crowded edges by wedges of the solid. \pre normals out of the solid
std::vector<std::uint32_t> wedge_twins(const RepairState& state, const EdgeTable& edges) {
  std::vector<std::uint32_t> twin(3 * state.facets.size(), k_no_partner);
  for (const Edge& edge : edges.edges()) {
    const auto at = edges.at(edge);
    if (at.size() == 2) {
      twin[at[0]] = at[1];
      twin[at[1]] = at[0];
      continue;
    }
    // The solid is behind a facet: clockwise about its own direction. Its partner is the first facet that way, which runs against it.
    const Vec3 &u = state.points[edge.low], &v = state.points[edge.high];
    const Vec3 axis = normalized(v - u);
    for (const std::uint32_t h : at) {
      const bool is_along = state.facets[h / 3][h % 3] == edge.low;
      const Vec3 own = state.points[state.facets[h / 3][previous_halfedge(h) % 3]] - u;
      const Vec3 e1 = normalized(own - dot(own, axis) * axis), e2 = cross(axis, e1);
      double best = 1e300;
      for (const std::uint32_t g : at) {
        if (g == h || (state.facets[g / 3][g % 3] == edge.low) == is_along) continue;
        const Vec3 other = state.points[state.facets[g / 3][previous_halfedge(g) % 3]] - u;
        double angle = std::atan2(dot(other, e2), dot(other, e1));  // counter-clockwise about the axis
        if (is_along) angle = -angle;
        if (angle <= 0.0) angle += 6.283185307179586;
        if (angle < best) {
          best = angle;
          twin[h] = g;
        }
      }
    }
    for (const std::uint32_t h : at)
      if (twin[h] != k_no_partner && twin[twin[h]] != h) twin[h] = k_no_partner;  // no alternation: left to the verdict
  }
  return twin;
}

}  // namespace

void separate_touching(RepairState& state) {
  const EdgeTable edges = state.edges();
  const std::vector<std::uint32_t> twin = wedge_twins(state, edges);
  std::vector<std::vector<std::uint32_t>> corners_at(state.points.size());  // half-edges that start there
  for (std::uint32_t h = 0; h < twin.size(); ++h) corners_at[state.facets[h / 3][h % 3]].push_back(h);
  const std::size_t n_points = state.points.size();
  const std::vector<Vec3> before = state.points;
  for (std::uint32_t v = 0; v < n_points; ++v) {
    std::map<std::uint32_t, std::uint32_t> fan;  // by half-edge
    std::vector<std::vector<std::uint32_t>> fans;
    for (const std::uint32_t start : corners_at[v]) {
      if (fan.count(start)) continue;
      auto& members = fans.emplace_back();
      std::vector<std::uint32_t> stack{start};
      fan[start] = 1;
      while (!stack.empty()) {
        const std::uint32_t h = stack.back();
        stack.pop_back();
        members.push_back(h);
        // The neighbours over both edges of this corner, whatever their sense.
        for (const std::uint32_t over : {previous_halfedge(h), h}) {
          if (twin[over] == k_no_partner) continue;
          const std::uint32_t facet = twin[over] / 3;
          for (std::uint32_t g = 3 * facet; g < 3 * facet + 3; ++g) {
            if (state.facets[facet][g % 3] != v || fan.count(g)) continue;
            fan[g] = 1;
            stack.push_back(g);
          }
        }
      }
    }
    if (fans.size() < 2) continue;
    double farthest = 0.0;
    std::vector<std::uint32_t> concerned;
    for (std::size_t i = 0; i < fans.size(); ++i) {
      Vec3 normal;
      double shortest = 1e300;
      bool is_cap = false;
      for (const std::uint32_t h : fans[i]) {
        const Facet& f = state.facets[h / 3];
        normal += normalized(area_vector(before[f[0] < n_points ? f[0] : v], before[f[1] < n_points ? f[1] : v], before[f[2] < n_points ? f[2] : v]));
        shortest = std::min({shortest, distance(state.points[f[h % 3]], state.points[f[next_halfedge(h) % 3]]),
                             distance(state.points[f[h % 3]], state.points[f[previous_halfedge(h) % 3]])});
        is_cap |= state.info[h / 3].mark == FacetMark::cap;
      }
      if (is_cap && state.report.half) normal[static_cast<std::size_t>(state.report.half->axis[0] - 'x')] = 0.0;
      const double by = std::min(k_apart_share * state.length, k_apart_of_edge * shortest);
      const Vec3 to = before[v] - by * normalized(normal);
      farthest = std::max(farthest, distance(to, before[v]));
      std::uint32_t copy = v;
      if (i > 0) {
        copy = static_cast<std::uint32_t>(state.points.size());
        state.points.push_back(to);
      } else {
        state.points[v] = to;
      }
      for (const std::uint32_t h : fans[i]) {
        state.facets[h / 3][h % 3] = copy;
        state.info[h / 3].is_touched = true;
        concerned.push_back(h / 3);
      }
    }
    state.note(RepairKind::separated, concerned, farthest);
  }
}

}  // namespace sterna::surfmesh
