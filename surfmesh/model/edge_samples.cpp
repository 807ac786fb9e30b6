#include "surfmesh/model/edge_samples.h"

#include <algorithm>
#include <cmath>

#include "geom/base/parallel.h"

namespace sterna::surfmesh {
namespace {

/// Number of sampling intervals for a piece between breaks, and limits for the number of intervals of an edge.
constexpr std::size_t k_per_piece = 8, k_least = 24, k_most = 800;

EdgeSamples sample_edge(const ModelEdge& edge) {
  EdgeSamples result;
  if (edge.is_degenerate()) return result;
  std::vector<double> ends{edge.range.from};
  for (const double b : edge.curve->breaks())
    if (b > edge.range.from && b < edge.range.to) ends.push_back(b);
  ends.push_back(edge.range.to);
  const std::size_t n_pieces = ends.size() - 1;
  const std::size_t target = std::clamp(n_pieces * k_per_piece, k_least, k_most);
  const std::size_t each = (target + n_pieces - 1) / n_pieces;
  const auto add = [&](double t) {
    const CurveDerivatives d = edge.curve->derivatives(t);
    const double speed2 = norm2(d.first);
    const double curvature = speed2 > 0.0 ? norm(cross(d.first, d.second)) / (speed2 * std::sqrt(speed2)) : 0.0;
    result.samples.push_back({t, d.point, std::isfinite(curvature) ? curvature : 0.0});
  };
  for (std::size_t p = 0; p < n_pieces; ++p)
    for (std::size_t k = 0; k < each; ++k) add(ends[p] + (ends[p + 1] - ends[p]) * static_cast<double>(k) / static_cast<double>(each));
  add(edge.range.to);
  measure_polyline(result);
  return result;
}

}  // namespace

void measure_polyline(EdgeSamples& samples) {
  samples.length = samples.turning = 0.0;
  Vec3 before;
  for (std::size_t i = 0; i + 1 < samples.samples.size(); ++i) {
    const Vec3 step = samples.samples[i + 1].point - samples.samples[i].point;
    samples.length += norm(step);
    if (norm2(step) > 0.0 && norm2(before) > 0.0) samples.turning += angle_between(before, step);
    if (norm2(step) > 0.0) before = step;
  }
}

Column<EdgeId, EdgeSamples> sample_edges(const Model& model, const RunContext& context) {
  Column<EdgeId, EdgeSamples> result(model.edges.size());
  parallel_for(
      context, model.edges.size(),
      [&](std::size_t i) {
        const EdgeId e(static_cast<std::uint64_t>(i));
        result[e] = sample_edge(model.edges[e]);
      },
      16);
  return result;
}

}  // namespace sterna::surfmesh
