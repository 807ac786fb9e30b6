#include "volmesh/adjacent/adjacent_surface.h"

#include <algorithm>
#include <utility>

#include "geom/base/schema.h"
#include "volmesh/adjacent/adjacent_errors.h"
#include "volmesh/adjacent/adjacent_part.h"
#include "volmesh/adjacent/check_adjacent.h"
#include "volmesh/adjacent/curved_parts.h"

namespace sterna::volmesh {
namespace {

void check_input(const AdjacentRegion& region) {
  if (region.surface == nullptr) throw Error(adjacent_error(region, ErrorCode::bad_argument, "the surface is missing"));
  if (region.edges.empty()) throw Error(adjacent_error(region, ErrorCode::bad_argument, "there are no loops"));
  ErrorInfo info = adjacent_error(region, ErrorCode::bad_argument, "edges of the loops are invalid");
  for (const AdjacentEdge& edge : region.edges) {
    if (edge[0] >= region.points.size() || edge[1] >= region.points.size()) {
      info.add_location(Point{}, "edge from point " + std::to_string(edge[0]) + " to " + std::to_string(edge[1]) + ", of " +
                                     std::to_string(region.points.size()) + " points");
      continue;
    }
    const Point &a = region.points[edge[0]], &b = region.points[edge[1]];
    if (!is_finite(a) || !is_finite(b))
      info.add_location(Point{}, "edge from point " + std::to_string(edge[0]) + " to " + std::to_string(edge[1]) + " has a coordinate that is not finite");
    if (a == b) info.add_location(a, "edge from point " + std::to_string(edge[0]) + " to " + std::to_string(edge[1]) + " has no length");
  }
  if (info.n_locations > 0) throw Error(std::move(info));
}

/// Checks that the parts and the kept triangles together have exactly the border of the region.
void prove_whole(const AdjacentRegion& region, const AdjacentTriangles& result) {
  const AdjacentCheck check = check_adjacent(region.edges, result.triangles);
  if (check.missing.empty() && check.open.empty() && check.repeated.empty()) return;
  ErrorInfo info =
      adjacent_error(region, ErrorCode::geometry_failed, "the retained triangles of the patch and the new triangles around the layers do not match");
  const auto add = [&](const std::vector<AdjacentEdge>& edges, const char* what) {
    for (const AdjacentEdge& edge : edges) info.add_location(0.5 * (point_of(region, result, edge[0]) + point_of(region, result, edge[1])), what);
  };
  add(check.missing, "edge of the loops without a triangle");
  add(check.open, "edge where triangles end");
  add(check.repeated, "edge of more than two triangles");
  info.hint =
      "footprints of layers must not cross sharp edges of the patch or leave the patch: split the patch at its sharp edges into several named patches, or "
      "lower max_thickness of the layers that end here";
  throw Error(std::move(info));
}

}  // namespace

AdjacentTriangles triangulate_adjacent(const AdjacentRegion& region, const EndOptions& options, const RunContext& context) {
  check_input(region);
  AdjacentTriangles result;
  check_closed(region, result, region.edges, adjacent_error(region, ErrorCode::bad_argument, "loops of edges are not closed"));
  result.min_angle = std::numbers::pi;
  if (const std::optional<AdjacentFrame> plane = plane_of(region)) {
    mesh_part(region, {region.edges, *plane, {}, {}}, options, result, context);
    return result;
  }
  for (const AdjacentPart& part : split_curved(region, result, context)) mesh_part(region, part, options, result, context);
  prove_whole(region, result);
  return result;
}

std::function<double(const Point&)> limited_size(const AdjacentRegion& region, double edge, double size_growth, std::function<double(const Point&)> size) {
  if (is_automatic(edge)) return size;
  std::vector<std::pair<Point, double>> coarse;  // middles of loop edges that are longer than the limit
  for (const AdjacentEdge& of_loop : region.edges) {
    const Point &a = region.points[of_loop[0]], &b = region.points[of_loop[1]];
    if (distance(a, b) > edge) coarse.emplace_back(0.5 * (a + b), distance(a, b));
  }
  return [edge, slope = size_growth - 1.0, coarse = std::move(coarse), size = std::move(size)](const Point& p) {
    double h = edge;
    for (const auto& [middle, length] : coarse) h = std::max(h, length - slope * distance(middle, p));
    return size ? std::min(h, size(p)) : h;
  };
}

}  // namespace sterna::volmesh
