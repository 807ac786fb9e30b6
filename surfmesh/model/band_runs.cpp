#include "surfmesh/model/band_runs.h"

#include <algorithm>
#include <cmath>
#include <numbers>

namespace sterna::surfmesh {
namespace {

bool goes_straight(const std::vector<BorderPoint>& loop, std::size_t i) {
  const std::size_t n = loop.size();
  const Vec3 before = loop[i].point - loop[(i + n - 1) % n].point, after = loop[(i + 1) % n].point - loop[i].point;
  return dot(before, after) > std::cos(k_largest_kink) * norm(before) * norm(after);
}

}  // namespace

BorderSegments segments_of(const Model& model, const ModelTopology& topology, const Column<EdgeId, EdgeCut>& cuts, const BorderVertices& numbers,
                           const LabelledBorder& labelled) {
  BorderSegments result;
  std::size_t first = 0;
  for (const auto& loop : labelled.border.loops) {
    const std::size_t n = loop.size();
    std::vector<BorderSegment> segments(n);
    std::size_t start = 0;
    const auto is_corner = [&](std::size_t i) { return labelled.ids[first + i % n].value() < numbers.n_corners; };
    while (start < n && !is_corner(start)) ++start;
    BorderSegment current;
    for (std::size_t k = 0; k < n; ++k) {
      const std::size_t i = (start + k) % n;
      const EdgeId own = labelled.edges[first + i];
      const bool is_first = is_corner(i);
      if (is_first || !own.is_valid()) {
        current = {};
        if (own.is_valid() && !model.edges[own].is_degenerate() && topology.is_point[own] == 0) {
          current.edge = topology.same_as[own].edge;
          // The vertices of an edge are numbered along its parameter. An edge with fewer than two vertices gets its direction from its corners.
          const VertexId id = labelled.ids[first + i], next = labelled.ids[first + (i + 1) % n], second = labelled.ids[first + (i + 2) % n];
          const VertexId from = numbers.of_corner[topology.corner[model.edges[current.edge].start]];
          const bool has_two = cuts[current.edge].t.size() > 1;
          current.is_forward = has_two ? next < second : id == from;
          const auto& rows = cuts[current.edge].n_rows;
          current.n_rows_at_start = rows[current.is_forward ? 0 : 1];
          current.n_rows_at_end = rows[current.is_forward ? 1 : 0];
        }
      }
      segments[i] = current;
      segments[i].is_first = is_first;
    }
    result.push_back(std::move(segments));
    first += n;
  }
  return result;
}

std::vector<BandRun> band_runs(FaceId f, const LabelledBorder& labelled, const BorderSegments& all, const WingBands& bands, const CurvatureLimits& limits) {
  std::vector<BandRun> runs;
  if (bands.is_empty() || bands.strips[f]) return runs;
  for (std::size_t l = 0; l < labelled.border.loops.size(); ++l) {
    const auto& loop = labelled.border.loops[l];
    const auto& segments = all[l];
    const std::size_t n = loop.size();
    const auto band_at = [&](std::size_t i) -> const BandEdge* {
      const EdgeId e = segments[i % n].edge;
      return e.is_valid() && bands.edges[e] ? &*bands.edges[e] : nullptr;
    };
    const auto begins = [&](std::size_t i) {
      if (!band_at(i)) return false;
      if (!segments[i % n].is_first) return false;
      const BandEdge* before = band_at(i + n - 1);
      return !before || before->kind != band_at(i)->kind || !goes_straight(loop, i % n);
    };
    bool is_any = false;
    for (std::size_t i = 0; i < n; ++i) {
      if (!begins(i)) continue;
      is_any = true;
      BandRun run{.loop = l, .first = i, .n_points = 1};
      const BandEdge& band = *band_at(i);
      run.law = {band.first, band.growth, limits};
      while (run.n_points <= n && band_at(i + run.n_points - 1) && (run.n_points == 1 || !begins(i + run.n_points - 1))) {
        run.law.first = std::min(run.law.first, band_at(i + run.n_points - 1)->first);
        ++run.n_points;
      }
      // A band that continues beyond the face has columns on the edges that leave the band there.
      const std::size_t last = i + run.n_points - 1;
      if (const BorderSegment& before = segments[(i + n - 1) % n]; before.edge.is_valid() && bands.crossings[before.edge][before.is_forward ? 1 : 0].is_any)
        run.n_before = before.n_rows_at_end;
      if (const BorderSegment& after = segments[last % n]; after.edge.is_valid() && bands.crossings[after.edge][after.is_forward ? 0 : 1].is_any)
        run.n_after = after.n_rows_at_start;
      runs.push_back(run);
    }
    // The band covers the whole loop: it may begin anywhere.
    if (!is_any && n > 0 && band_at(0)) runs.push_back({.loop = l, .first = 0, .n_points = n + 1, .law = {band_at(0)->first, band_at(0)->growth, limits}});
  }
  return runs;
}

std::optional<BandedFace> mesh_base(const Surface& surface, const LabelledBorder& labelled, const BorderSegments& all, const BaseStrip& strip) {
  if (labelled.border.loops.size() != 1) return std::nullopt;
  const auto& segments = all.front();
  const std::size_t n = segments.size();
  std::array<std::size_t, 2> first{n, n}, count{};
  for (std::size_t i = 0; i < n; ++i)
    for (const std::size_t s : {0u, 1u})
      if (segments[i].edge == strip.long_edge[s]) {
        if (segments[i].is_first) first[s] = i;
        ++count[s];
      }
  if (first[0] == n || first[1] == n || count[0] != count[1]) return std::nullopt;
  const std::size_t from_first_to_second = (first[1] + n - first[0] - count[0]) % n, from_second_to_first = (first[0] + n - first[1] - count[1]) % n;
  const StripSides sides{.first_long = first[0],
                         .n_along = count[0],
                         .n_across = strip.n_cells,
                         .is_end_pointed = from_first_to_second == 0,
                         .is_start_pointed = from_second_to_first == 0};
  return mesh_strip(surface, labelled.border, sides);
}

}  // namespace sterna::surfmesh
