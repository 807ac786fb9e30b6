#include <algorithm>

#include "geom/base/disjoint_sets.h"
#include "geom/math/measures.h"
#include "surfmesh/repair/repair_state.h"

namespace sterna::surfmesh {
namespace {

/// Relative to the box's diagonal: the open boundary of a flap is longer than this; that of a body with a hole is mostly shorter.
constexpr double k_open_share = 0.9;
constexpr double k_flat_share = 1e-6;  ///< relative to L: largest distance of the vertices of a flat baffle from its plane

/// Returns the piece number of each facet. Pieces are connected across edges with two facets.
std::vector<std::uint32_t> smooth_pieces(const RepairState& state, const EdgeTable& edges) {
  DisjointSets sets(state.facets.size());
  for (const Edge& edge : edges.edges())
    if (edge.count == 2) sets.join(edges.at(edge)[0] / 3, edges.at(edge)[1] / 3);
  return std::move(sets).roots();
}

/// Removes flaps if the rest is closed without them. A flap is a piece with open edges that is attached to crowded edges.
bool remove_flaps(RepairState& state) {
  const EdgeTable edges = state.edges();
  const std::vector<std::uint32_t> piece = smooth_pieces(state, edges);
  std::vector<double> open_length(state.facets.size(), 0.0);
  std::vector<Box> box(state.facets.size());
  for (std::uint32_t t = 0; t < state.facets.size(); ++t)
    for (const Vec3& p : state.corners(t)) box[piece[t]].add(p);
  std::vector<char> is_open(state.facets.size(), 0), hangs(state.facets.size(), 0), is_needed(state.facets.size(), 0);
  for (const Edge& edge : edges.edges()) {
    const auto at = edges.at(edge);
    if (edge.count == 1) {
      const std::uint32_t of = piece[at[0] / 3];
      open_length[of] += distance(state.points[edge.low], state.points[edge.high]);
      is_open[of] = open_length[of] >= k_open_share * norm(box[of].max - box[of].min);
    }
    if (edge.count < 3) continue;
    for (const std::uint32_t h : at) {
      const std::uint32_t of = piece[h / 3];
      hangs[of] = 1;
      std::size_t n_own = 0;
      for (const std::uint32_t g : at) n_own += piece[g / 3] == of;
      if ((at.size() - n_own) % 2 != 0) is_needed[of] = 1;
    }
  }
  std::vector<char> is_flap(state.facets.size(), 0), is_kept(state.facets.size(), 1);
  bool any = false, all = true;
  for (std::uint32_t t = 0; t < state.facets.size(); ++t) {
    is_flap[t] = is_open[piece[t]] && hangs[piece[t]] && !is_needed[piece[t]];
    is_kept[t] = !is_flap[t];
    any |= is_flap[t] != 0;
    all &= is_flap[t] != 0;
  }
  if (!any || all) return false;
  // With two flaps at one edge, each may be mistaken for part of the rest. Therefore only the first is removed, and the next pass decides on the other.
  std::vector<char> is_gone(state.facets.size(), 0);
  for (const Edge& edge : edges.edges()) {
    if (edge.count < 3) continue;
    std::uint32_t first = k_none;
    for (const std::uint32_t h : edges.at(edge)) {
      const std::uint32_t of = piece[h / 3];
      if (!is_flap[of] || is_gone[of]) continue;
      if (first == k_none) first = of;
      else if (first != of) is_gone[of] = 1;
    }
  }
  for (std::uint32_t t = 0; t < state.facets.size(); ++t) {
    if (is_gone[piece[t]]) is_flap[t] = 0;
    is_kept[t] = !is_flap[t];
  }
  if (std::find(is_flap.begin(), is_flap.end(), 1) == is_flap.end()) return false;
  state.note_parts(RepairKind::removed_sheet, is_flap, edges);
  state.keep(is_kept);
  return true;
}

void remove_flat_parts(RepairState& state) {
  const EdgeTable edges = state.edges();
  const Parts parts = connected_parts(state.facets.size(), edges);
  if (parts.count < 2) return;
  std::vector<char> is_open(parts.count, 0), is_flat(parts.count, 1);
  for (const Edge& edge : edges.edges())
    if (edge.count == 1) is_open[parts.part[edges.at(edge)[0] / 3]] = 1;
  std::vector<Vec3> at(parts.count), normal(parts.count);
  for (std::uint32_t t = 0; t < state.facets.size(); ++t) {
    const auto c = state.corners(t);
    const Vec3 n = area_vector(c[0], c[1], c[2]);
    if (norm2(n) <= norm2(normal[parts.part[t]])) continue;
    normal[parts.part[t]] = n;
    at[parts.part[t]] = c[0];
  }
  for (Vec3& n : normal) n = normalized(n);
  for (std::uint32_t t = 0; t < state.facets.size(); ++t)
    for (const Vec3& p : state.corners(t))
      if (std::abs(dot(p - at[parts.part[t]], normal[parts.part[t]])) > k_flat_share * state.length) is_flat[parts.part[t]] = 0;
  std::vector<char> is_sheet(state.facets.size(), 0), is_kept(state.facets.size(), 1);
  bool any = false, has_body = false;
  for (std::uint32_t t = 0; t < state.facets.size(); ++t) {
    is_sheet[t] = is_open[parts.part[t]] && is_flat[parts.part[t]];
    is_kept[t] = !is_sheet[t];
    any |= is_sheet[t] != 0;
    // True if one part is closed. If no part is closed, flat open parts may be the sides of a body.
    has_body |= !is_open[parts.part[t]];
  }
  if (!any || !has_body) return;
  state.note_parts(RepairKind::removed_sheet, is_sheet, edges);
  state.keep(is_kept);
}

}  // namespace

void remove_sheets(RepairState& state, const RunContext& context) {
  for (int round = 0; round < 20; ++round) {
    context.check_stop();
    if (!remove_flaps(state)) break;
  }
  remove_flat_parts(state);
}

}  // namespace sterna::surfmesh
