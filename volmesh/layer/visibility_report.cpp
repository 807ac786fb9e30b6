#include "volmesh/layer/visibility_report.h"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "geom/math/constants.h"

namespace sterna::volmesh {
namespace {}  // namespace

VisibilityReport report_visibility(const LayerBase& base) {
  VisibilityReport report;
  report.angle.resize(base.visibility.size());
  std::vector<VertexId> hard;
  for (const VertexId v : base.visibility.ids()) {
    const double angle = std::acos(std::clamp(base.visibility[v], -1.0, 1.0));
    report.angle[v] = angle;
    report.max_angle = std::max(report.max_angle, angle);
    for (std::size_t i = 0; i < k_visibility_limits_deg.size(); ++i)
      if (angle > k_visibility_limits_deg[i] * k_degree) report.share_above[i] += 1.0;
    if (angle > k_visibility_limits_deg[0] * k_degree) hard.push_back(v);
  }
  for (double& share : report.share_above) share /= static_cast<double>(base.visibility.size());
  std::stable_sort(hard.begin(), hard.end(), [&](VertexId a, VertexId b) { return report.angle[a] > report.angle[b]; });
  hard.resize(std::min(hard.size(), k_max_places));
  for (const VertexId v : hard)
    report.hardest.push_back({base.wall.points[v], "vertex " + std::to_string(v.value()) + ": its faces are seen at " +
                                                       std::to_string(std::lround(report.angle[v] / k_degree)) + " degrees at best"});
  return report;
}

}  // namespace sterna::volmesh
