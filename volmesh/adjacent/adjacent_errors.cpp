#include "volmesh/adjacent/adjacent_errors.h"

namespace sterna::volmesh {

ErrorInfo adjacent_error(const AdjacentRegion& region, ErrorCode code, std::string problem) {
  ErrorInfo info{.code = code, .attempted = "triangulating patch \"" + region.name + "\" around the layers that end on it", .problem = std::move(problem)};
  info.geometry.points = region.points;
  for (const auto& edge : region.edges)
    if (edge[0] < region.points.size() && edge[1] < region.points.size()) info.geometry.edges.push_back(edge);
  return info;
}

}  // namespace sterna::volmesh
