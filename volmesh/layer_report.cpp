#include "volmesh/layer_report.h"

#include <algorithm>
#include <array>

namespace sterna::volmesh {
namespace {

constexpr double k_full_height_share = 0.9;  ///< of h_target that counts as covered

}  // namespace

LayerReport report_layer(const LayerBase& base, const EnvelopeOptions& options, const Envelope& envelope) {
  LayerReport report;
  report.body_length = base.body_length;
  report.n_vertices = static_cast<std::int64_t>(base.wall.n_vertices());
  const double compressed_below = options.layers * options.first_height;
  std::array<double, k_height_limits> lost{};
  double area = 0.0, covered = 0.0, heights = 0.0, targets = 0.0, ratios = 0.0;
  for (const VertexId v : envelope.height.ids()) {
    const double a = base.vertex_area[v];
    const double h = envelope.height[v];
    area += a;
    heights += a * h;
    targets += a * envelope.target[v];
    ratios += a * envelope.target[v] / envelope.eq1[v];
    if (h >= k_full_height_share * envelope.target[v]) covered += a;
    else lost[static_cast<std::size_t>(envelope.limit[v])] += a;
    if (h > 0.0 && h < compressed_below) ++report.n_compressed;
    if (h > 0.0) continue;
    const TriangleId t = triangle_of(base.topology.outgoing(v).front());
    const Patch& patch = base.wall.patches[base.wall.triangle_patch[t]];
    report.collapsed.push_back({base.wall.points[v], "vertex " + std::to_string(v.value()) + " of patch " + patch.name + ": " + std::string(to_string(envelope.limit[v]))});
  }
  report.coverage = covered / area;
  for (std::size_t i = 0; i < lost.size(); ++i)
    if (lost[i] > 0.0) report.lost_area.emplace_back(to_string(static_cast<HeightLimit>(i)), lost[i] / area);
  std::stable_sort(report.lost_area.begin(), report.lost_area.end(), [](const auto& x, const auto& y) { return x.second > y.second; });
  report.target_over_eq1 = ratios / area;
  report.mean_height_share = heights / targets;
  report.mean_height = heights / area;
  return report;
}

LayerRequest layer_request(const EnvelopeOptions& options, const Envelope& envelope) {
  LayerRequest request;
  request.first_height = options.first_height;
  request.max_growth = options.max_growth;
  request.target_height = envelope.target.raw();
  for (std::size_t i = 0; i < k_height_limits; ++i) request.reasons.emplace_back(to_string(static_cast<HeightLimit>(i)));
  request.reason.reserve(envelope.limit.size());
  for (const HeightLimit limit : envelope.limit) request.reason.push_back(static_cast<std::uint8_t>(limit));
  return request;
}

}  // namespace sterna::volmesh
