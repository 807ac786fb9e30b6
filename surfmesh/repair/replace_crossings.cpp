#include <algorithm>

#include "geom/mesh/find_crossings.h"
#include "surfmesh/repair/repair_state.h"

namespace sterna::surfmesh {
namespace {

constexpr int k_max_rings = 5;            ///< largest number of rings of facets around the crossing facets that are removed
constexpr double k_own_hole = 2.0;        ///< L: largest hole made by the removal that is filled
constexpr double k_most_replaced = 0.05;  ///< largest fraction of the facets that is replaced at one time; a larger fraction is not a local defect

}  // namespace

bool replace_crossings(RepairState& state, const RepairOptions& given, const Contacts& contacts, const RunContext& context) {
  RepairOptions options = given;
  options.hole = options.flat_hole = k_own_hole;  // removed regions are filled again, whatever their size
  for (int round = 0; round < options.rounds; ++round) {
    if (!find_loops(state).empty()) fill_holes(state, options, RepairKind::replaced, context);
    separate_touching(state, contacts, context);
    const CrossingPairs crossings = find_crossings(state.points, state.facets, context);
    const EdgeTable edges = state.edges();
    std::vector<char> is_out(state.facets.size(), 0);
    for (const auto& [i, j] : crossings.pairs) is_out[i] = is_out[j] = 1;
    for (const Edge& edge : edges.edges())
      if (edge.count > 2)
        for (const std::uint32_t h : edges.at(edge)) is_out[h / 3] = 1;
    if (std::find(is_out.begin(), is_out.end(), 1) == is_out.end()) return true;
    for (int ring = 0; ring < std::min(round, k_max_rings); ++ring) {
      std::vector<char> at(state.points.size(), 0);
      for (std::uint32_t t = 0; t < state.facets.size(); ++t)
        if (is_out[t])
          for (const std::uint32_t v : state.facets[t]) at[v] = 1;
      for (std::uint32_t t = 0; t < state.facets.size(); ++t)
        for (const std::uint32_t v : state.facets[t]) is_out[t] |= at[v];
    }
    std::size_t n_out = 0;
    for (std::uint32_t t = 0; t < state.facets.size(); ++t) {
      if (state.info[t].mark == FacetMark::cap) is_out[t] = 0;
      n_out += is_out[t];
    }
    if (n_out > std::max<std::size_t>(200, static_cast<std::size_t>(k_most_replaced * static_cast<double>(state.facets.size())))) return false;
    std::vector<char> is_kept(state.facets.size(), 1);
    for (std::uint32_t t = 0; t < state.facets.size(); ++t) is_kept[t] = !is_out[t];
    state.keep(is_kept);
    const std::size_t n_left = fill_holes(state, options, RepairKind::replaced, context);
    context.debug("repair: replaced " + std::to_string(n_out) + " facets for " + std::to_string(crossings.total) +
                  " crossings; holes left: " + std::to_string(n_left));
    weld_rounded(state, true);
  }
  return find_loops(state).empty() && find_crossings(state.points, state.facets, context).total == 0;
}

}  // namespace sterna::surfmesh
