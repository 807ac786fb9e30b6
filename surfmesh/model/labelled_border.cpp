#include "surfmesh/model/labelled_border.h"

#include <algorithm>
#include <cmath>
#include <map>

#include "surfmesh/model/mesh_faces.h"

namespace sterna::surfmesh {

double tolerance_of(const Model& model, FaceId f, EdgeId e) {
  const ModelEdge& edge = model.edges[e];
  // Files write tolerances of zero; what doubles of that size can hold is no fault.
  constexpr double k_rounding = 1e-12;
  const Point& p = model.corners[edge.start].point;
  return std::max({edge.tolerance, model.corners[edge.start].tolerance, model.corners[edge.end].tolerance, model.faces[f].tolerance, k_rounding * norm(p - Point{})});
}

/// Each use gives its start and its cuts; its end is the start of the next. Absorbed edges give nothing, poles their corner at their start and, by the next use, at their end.
LabelledBorder label_border(const Model& model, FaceId f, const ModelTopology& topology, const Column<EdgeId, EdgeCut>& cuts, const BorderVertices& numbers, const FaceOutline& outline) {
  LabelledBorder result;
  for (const auto& uses : outline.borders) {
    std::vector<BorderPoint> loop;
    std::vector<BorderSegment> segments;
    Uv end;
    for (const OutlineUse& entry : uses) {
      const EdgeUse& use = model.faces[f].borders[entry.place.border][entry.place.place];
      const ModelEdge& edge = model.edges[use.edge];
      if (topology.is_point[use.edge] != 0 && !edge.is_degenerate()) continue;
      const Interval range = edge.range;
      const CornerId corner = topology.corner[use.is_reversed ? edge.end : edge.start];
      loop.push_back({use.parameter->point(use.is_reversed ? range.to : range.from) + entry.shift, model.corners[corner].point});
      end = use.parameter->point(use.is_reversed ? range.from : range.to) + entry.shift;
      result.ids.push_back(numbers.of_corner[corner]);
      result.edges.push_back(use.edge);
      const EdgeCut& cut = cuts[use.edge];
      const SameEdge& same = topology.same_as[use.edge];
      BorderSegment segment{edge.is_degenerate() ? EdgeId() : same.edge, use.is_reversed == same.is_reversed, entry.place.place, true, cut.n_rows[use.is_reversed ? 1 : 0], cut.n_rows[use.is_reversed ? 0 : 1]};
      segments.push_back(segment);
      segment.is_first = false;
      for (std::size_t k = 0; k < cut.t.size(); ++k) {
        const std::size_t i = use.is_reversed ? cut.t.size() - 1 - k : k;
        loop.push_back({use.parameter->point(cut.t[i]) + entry.shift, cut.points[i]});
        segments.push_back(segment);
        result.edges.push_back(use.edge);
        result.ids.push_back(VertexId(numbers.first_of_edge[same.edge] + static_cast<std::uint32_t>(same.is_reversed ? cut.t.size() - 1 - i : i)));
      }
    }
    if (loop.empty()) continue;
    result.border.loops.push_back(std::move(loop));
    result.segments.push_back(std::move(segments));
    result.loop_ends.push_back(end);
  }
  return result;
}

LabelledBorder merge_touching(const Model& model, FaceId f, const LabelledBorder& given) {
  constexpr double k_near = 1e-5;  // of the border's extent in (u, v)
  const Surface& surface = *model.faces[f].surface;
  ParameterBox box{{1e300, -1e300}, {1e300, -1e300}};
  for (const auto& loop : given.border.loops)
    for (const BorderPoint& p : loop) {
      box.u = {std::min(box.u.from, p.uv.u), std::max(box.u.to, p.uv.u)};
      box.v = {std::min(box.v.from, p.uv.v), std::max(box.v.to, p.uv.v)};
    }
  LabelledBorder result;
  result.loop_ends = given.loop_ends;
  std::map<VertexId, std::vector<Uv>> met;
  std::size_t i = 0;
  for (std::size_t l = 0; l < given.border.loops.size(); ++l) {
    const auto& loop = given.border.loops[l];
    std::vector<BorderPoint> kept;
    std::vector<BorderSegment> segments;
    for (std::size_t k = 0; k < loop.size(); ++k) {
      BorderPoint p = loop[k];
      const EdgeId e = given.edges[i];
      const VertexId id = given.ids[i++];
      std::vector<Uv>& places = met[id];
      const auto is_same = [&](const Uv& q) {
        const Uv step = p.uv - q;
        if (std::abs(step.u) > k_near * box.u.length() || std::abs(step.v) > k_near * box.v.length()) return false;
        return distance(surface.point(p.uv), surface.point(q)) <= tolerance_of(model, f, e);
      };
      if (const auto near = std::find_if(places.begin(), places.end(), is_same); near != places.end()) p.uv = *near;
      else places.push_back(p.uv);
      if (!kept.empty() && kept.back().uv == p.uv && result.ids.back() == id) {
        segments.back() = given.segments[l][k];  // the one between them has no length
        continue;
      }
      kept.push_back(p);
      segments.push_back(given.segments[l][k]);
      result.ids.push_back(id);
      result.edges.push_back(e);
    }
    while (kept.size() > 1 && kept.back().uv == kept.front().uv && result.ids.back() == result.ids[result.ids.size() - kept.size()]) {
      kept.pop_back();
      segments.pop_back();
      result.ids.pop_back();
      result.edges.pop_back();
    }
    result.border.loops.push_back(std::move(kept));
    result.segments.push_back(std::move(segments));
  }
  return result;
}

}  // namespace sterna::surfmesh
