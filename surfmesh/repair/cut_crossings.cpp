#include <algorithm>
#include <cmath>
#include <limits>

#include "geom/base/sort_unique.h"
#include "geom/boolean/cgal_arrange.h"
#include "geom/mesh/find_crossings.h"
#include "surfmesh/repair/repair_state.h"

namespace sterna::surfmesh {
namespace {

constexpr double k_grid_share = 1e-10;  ///< relative to the body length L: the grid is a hundred times finer than the welding tolerance

}  // namespace

void snap_crossings(RepairState& state, const RunContext& context) {
  // The grid is a power of two, so that numbers with few digits do not change.
  const double grid = std::exp2(std::floor(std::log2(k_grid_share * state.length)));
  const CrossingPairs crossings = find_crossings(state.points, state.facets, context);
  std::vector<std::uint32_t> crossing;
  std::vector<char> is_of(state.points.size(), 0);
  for (const auto& pair : crossings.pairs)
    for (const std::uint32_t t : pair) {
      crossing.push_back(t);
      for (const std::uint32_t v : state.facets[t]) is_of[v] = 1;
    }
  sort_unique(crossing);
  for (std::uint32_t v = 0; v < is_of.size(); ++v)
    if (is_of[v])
      for (std::size_t axis = 0; axis < 3; ++axis) state.points[v][axis] = grid * std::round(state.points[v][axis] / grid);
  for (std::uint32_t t = 0; t < state.facets.size(); ++t)
    for (const std::uint32_t v : state.facets[t]) state.info[t].is_touched = state.info[t].is_touched || is_of[v];
  state.note(RepairKind::welded, crossing, grid);
  weld_rounded(state);
}

bool cut_crossings(RepairState& state, const RepairOptions& options, const RunContext& context) {
  bool is_cut = false;
  std::int64_t fewest = std::numeric_limits<std::int64_t>::max();
  for (int round = 0; round < options.rounds; ++round) {
    const CrossingPairs crossings = find_crossings(state.points, state.facets, context);
    if (crossings.total == 0 || crossings.total >= fewest) return is_cut;
    fewest = crossings.total;
    if (round == 0) {  // later rounds only cut the effects of rounding on the crossings of the first round
      std::vector<char> crosses(state.facets.size(), 0);
      for (const auto& [i, j] : crossings.pairs) crosses[i] = crosses[j] = 1;
      state.note_parts(RepairKind::cut, crosses, state.edges());
    }
    context.debug("repair: cutting " + std::to_string(crossings.total) + " pairs of facets that cross");
    Arrangement pieces = arrange_triangles(state.points, state.facets, crossings.pairs, context);
    std::vector<FacetInfo> info;
    info.reserve(pieces.triangles.size());
    for (const std::uint32_t parent : pieces.parent) info.push_back(state.info[parent]);
    for (const auto& [i, j] : crossings.pairs) state.info[i].is_touched = state.info[j].is_touched = true;
    for (std::size_t t = 0; t < info.size(); ++t) info[t].is_touched = state.info[pieces.parent[t]].is_touched;
    state.points = std::move(pieces.points);
    state.facets = std::move(pieces.triangles);
    state.info = std::move(info);
    weld_rounded(state);
    is_cut = true;
  }
  return is_cut;
}

}  // namespace sterna::surfmesh
