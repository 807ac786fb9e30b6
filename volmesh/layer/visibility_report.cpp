#include "volmesh/layer/visibility_report.h"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "geom/math/constants.h"

namespace sterna::volmesh {
VisibilityReport report_visibility(const LayerBase& base) {
  VisibilityReport report;
  report.angle.resize(base.visibility.size());
  Column<VertexId, double> worst_line(base.visibility.size(), 0.0);  // for each ridge base vertex
  std::vector<VertexId> hard;
  for (const VertexId v : base.visibility.ids()) {
    const double angle = std::acos(std::clamp(base.visibility[v], -1.0, 1.0));
    report.angle[v] = angle;
    report.max_angle = std::max(report.max_angle, angle);
    double& of_base = worst_line[base.ridges == nullptr || base.ridges->is_empty() ? v : base.ridges->base_vertex[v]];
    of_base = std::max(of_base, angle);
    if (angle > k_visibility_limits_deg[0] * k_degree) hard.push_back(v);
  }
  const std::size_t n_given = base.ridges == nullptr || base.ridges->is_empty() ? base.visibility.size() : base.ridges->n_given_vertices;
  for (std::size_t i = 0; i < k_visibility_limits_deg.size(); ++i) {
    const auto n_above = std::ranges::count_if(worst_line, [&](double angle) { return angle > k_visibility_limits_deg[i] * k_degree; });
    report.share_above[i] = static_cast<double>(n_above) / static_cast<double>(n_given);
  }
  std::stable_sort(hard.begin(), hard.end(), [&](VertexId a, VertexId b) { return report.angle[a] > report.angle[b]; });
  hard.resize(std::min(hard.size(), k_max_locations));
  for (const VertexId v : hard)
    report.hardest.push_back({base.wall.points[v], "vertex " + std::to_string(v.value()) + ": best growth direction " +
                                                       std::to_string(std::lround(report.angle[v] / k_degree)) + " degrees from a face normal"});
  return report;
}

}  // namespace sterna::volmesh
