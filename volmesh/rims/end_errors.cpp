#include "volmesh/rims/end_errors.h"

namespace sterna::volmesh {

ErrorInfo end_error(const EndRegion& region, ErrorCode code, std::string problem) {
  ErrorInfo info{.code = code, .attempted = "triangulating patch \"" + region.name + "\" around the layers that end on it", .problem = std::move(problem)};
  info.geometry.points = region.points;
  for (const auto& edge : region.edges)
    if (edge[0] < region.points.size() && edge[1] < region.points.size()) info.geometry.edges.push_back(edge);
  return info;
}

void add_place(ErrorInfo& info, const Point& position, std::string what) {
  constexpr std::size_t k_places = 10;
  ++info.n_places;
  if (info.places.size() < k_places) info.places.push_back({position, std::move(what)});
}

}  // namespace sterna::volmesh
