#include "surfmesh/model/model_topology.h"

#include <algorithm>
#include <cmath>
#include <map>

namespace sterna::surfmesh {
namespace {

/// Entities smaller than this fraction of the shortest target edge are absorbed, because a mesh with such edges cannot resolve them.
constexpr double k_shortest = 0.05;

CornerId find(Column<CornerId, CornerId>& stands_for, CornerId c) {
  while (stands_for[c] != c) c = stands_for[c] = stands_for[stands_for[c]];
  return c;
}

SameEdge find(const ModelTopology& topology, EdgeId e) {
  SameEdge same{e, false};
  while (topology.same_as[same.edge].edge != same.edge) {
    const SameEdge& next = topology.same_as[same.edge];
    same = {next.edge, same.is_reversed != next.is_reversed};
  }
  return same;
}

double limit_of(const ModelEdge& edge, const std::vector<EdgeUseLocation>& uses, const ModelSizes& sizes) {
  double shortest = sizes.largest;
  for (const EdgeUseLocation& location : uses) shortest = std::min(shortest, sizes.faces[location.face].limits.min_edge);
  return std::max(k_shortest * shortest, edge.tolerance);
}

bool is_border(const std::vector<EdgeUseLocation>& uses) { return uses.size() == 1; }

/// Flags the corners at the end of an edge with only one face: in a half model they lie in the plane of symmetry, and must not move.
Column<CornerId, std::uint8_t> corners_on_borders(const Model& model, const Column<EdgeId, std::vector<EdgeUseLocation>>& uses) {
  Column<CornerId, std::uint8_t> on_border(model.corners.size(), 0);
  for (const EdgeId e : model.edges.ids())
    if (is_border(uses[e]) && !model.edges[e].is_degenerate()) on_border[model.edges[e].start] = on_border[model.edges[e].end] = 1;
  return on_border;
}

void absorb_short_edges(const Model& model, const Column<EdgeId, EdgeSamples>& edges, const Column<EdgeId, std::vector<EdgeUseLocation>>& uses,
                        const ModelSizes& sizes, ModelTopology& topology, std::vector<AbsorbedPart>& absorbed) {
  const Column<CornerId, std::uint8_t> on_border = corners_on_borders(model, uses);
  for (const EdgeId e : model.edges.ids()) {
    const ModelEdge& edge = model.edges[e];
    bool is_point = edge.is_degenerate();
    if (!is_point && !uses[e].empty()) {
      is_point = edges[e].length <= limit_of(edge, uses[e], sizes);
      if (is_point) {
        std::string names;
        for (const EdgeUseLocation& location : uses[e]) names += (names.empty() ? "" : ", ") + model.faces[location.face].name;
        absorbed.push_back({"short edge of " + names, edges[e].samples.front().point, edges[e].length});
      }
    }
    if (!is_point) continue;
    topology.is_point[e] = 1;
    const CornerId a = find(topology.corner, edge.start), b = find(topology.corner, edge.end);
    const bool keeps_first = on_border[a] != on_border[b] ? on_border[a] != 0 : a < b;
    (keeps_first ? topology.corner[b] : topology.corner[a]) = keeps_first ? a : b;
  }
  for (const CornerId c : model.corners.ids()) topology.corner[c] = find(topology.corner, c);
}

/// Returns the largest distance from the samples of one edge to the polyline of the other; above `limit` the value is not exact.
double distance_of(const EdgeSamples& a, const EdgeSamples& b, double limit) {
  double largest = 0.0;
  for (const EdgeSample& s : a.samples) {
    double nearest = std::numeric_limits<double>::infinity();
    for (std::size_t k = 0; k + 1 < b.samples.size() && nearest > 0.0; ++k)
      nearest = std::min(nearest, distance_to_segment(s.point, b.samples[k].point, b.samples[k + 1].point));
    largest = std::max(largest, nearest);
    if (largest > limit) break;
  }
  return largest;
}

/// Absorbs faces that are a line or a point. Every edge of such a face is traversed in both directions, and the face has no area. (A face with a seam also
/// traverses the seam in both directions, but has an area.)
void absorb_lines(const Model& model, const Column<EdgeId, EdgeSamples>& edges, const Column<EdgeId, std::vector<EdgeUseLocation>>& uses,
                  const ModelSizes& sizes, ModelTopology& topology, std::vector<AbsorbedPart>& absorbed) {
  for (const FaceId f : model.faces.ids()) {
    std::map<EdgeId, int> balance;
    double length = 0.0, limit = 0.0;
    EdgeId longest;
    for (const Border& border : model.faces[f].borders)
      for (const EdgeUse& use : border) {
        if (topology.is_point[use.edge] != 0) continue;
        const SameEdge same = find(topology, use.edge);
        balance[same.edge] += use.is_reversed != same.is_reversed ? -1 : 1;
        length += 0.5 * edges[use.edge].length;
        limit = std::max(limit, limit_of(model.edges[use.edge], uses[use.edge], sizes));
        if (!longest.is_valid() || edges[use.edge].length > edges[longest].length) longest = use.edge;
      }
    if (balance.empty() || topology.is_absorbed[f] != 0) continue;
    if (std::any_of(balance.begin(), balance.end(), [](const auto& entry) { return entry.second != 0; }) || sizes.faces[f].curvature->area() > limit * length)
      continue;
    topology.is_absorbed[f] = 1;
    absorbed.push_back({"face " + model.faces[f].name + ", which is a line", edges[longest].samples[edges[longest].samples.size() / 2].point,
                        sizes.faces[f].curvature->area() / length});
  }
}

/// Absorbs faces whose border consists of two edges that coincide within the limit.
void absorb_strips(const Model& model, const Column<EdgeId, EdgeSamples>& edges, const Column<EdgeId, std::vector<EdgeUseLocation>>& uses,
                   const ModelSizes& sizes, ModelTopology& topology, std::vector<AbsorbedPart>& absorbed) {
  for (const FaceId f : model.faces.ids()) {
    std::vector<EdgeId> left;
    for (const Border& border : model.faces[f].borders)
      for (const EdgeUse& use : border)
        if (topology.is_point[use.edge] == 0) left.push_back(use.edge);
    if (left.empty()) topology.is_absorbed[f] = 1;
    if (left.empty())
      absorbed.push_back({"face " + model.faces[f].name + ", whose edges all have zero length",
                          model.corners[model.edges[model.faces[f].borders.front().front().edge].start].point, 0.0});
    if (left.size() != 2 || left[0] == left[1] || model.faces[f].borders.size() != 1) continue;
    const SameEdge a = find(topology, left[0]), b = find(topology, left[1]);
    if (a.edge == b.edge) continue;
    const ModelEdge &edge_a = model.edges[a.edge], &edge_b = model.edges[b.edge];
    const CornerId from_a = topology.corner[edge_a.start], to_a = topology.corner[edge_a.end], from_b = topology.corner[edge_b.start],
                   to_b = topology.corner[edge_b.end];
    const bool is_along = from_a == from_b && to_a == to_b, is_against = from_a == to_b && to_a == from_b;
    if (from_a == to_a || (!is_along && !is_against)) continue;
    const double limit = std::max(limit_of(edge_a, uses[a.edge], sizes), limit_of(edge_b, uses[b.edge], sizes));
    const double width = std::max(distance_of(edges[a.edge], edges[b.edge], limit), distance_of(edges[b.edge], edges[a.edge], limit));
    if (width > limit) continue;
    topology.is_absorbed[f] = 1;
    const bool keeps_a = is_border(uses[a.edge]) != is_border(uses[b.edge]) ? is_border(uses[a.edge]) : a.edge < b.edge;
    const EdgeId kept = keeps_a ? a.edge : b.edge, other = keeps_a ? b.edge : a.edge;
    topology.same_as[other] = {kept, is_against};
    absorbed.push_back({"narrow face " + model.faces[f].name, edges[kept].samples[edges[kept].samples.size() / 2].point, width});
  }
  for (const EdgeId e : model.edges.ids()) topology.same_as[e] = find(topology, e);
}

}  // namespace

ModelTopology absorb_small_parts(const Model& model, const Column<EdgeId, EdgeSamples>& edges, const ModelSizes& sizes, std::vector<AbsorbedPart>& absorbed) {
  ModelTopology topology{Column<CornerId, CornerId>(model.corners.size()), Column<EdgeId, std::uint8_t>(model.edges.size(), 0),
                         Column<EdgeId, SameEdge>(model.edges.size()), Column<FaceId, std::uint8_t>(model.faces.size(), 0)};
  for (const CornerId c : model.corners.ids()) topology.corner[c] = c;
  for (const EdgeId e : model.edges.ids()) topology.same_as[e] = {e, false};
  const Column<EdgeId, std::vector<EdgeUseLocation>> uses = uses_of_edges(model);
  absorb_short_edges(model, edges, uses, sizes, topology, absorbed);
  absorb_strips(model, edges, uses, sizes, topology, absorbed);
  absorb_lines(model, edges, uses, sizes, topology, absorbed);
  return topology;
}

}  // namespace sterna::surfmesh
