#include "surfmesh/model/model_wall.h"

#include <algorithm>
#include <tuple>
#include <utility>

#include "geom/model/deform.h"

namespace sterna::surfmesh {
namespace {

struct CutVertex {
  EdgeId edge;
  double t;
  VertexId vertex;
};

std::pair<VertexId, VertexId> ordered(VertexId a, VertexId b) { return {std::min(a, b), std::max(a, b)}; }

}  // namespace

ModelWall::ModelWall(Model model, const SurfaceMesh& mesh)
    : ModelWall([model = std::move(model)] { return model; }, WallLocations{mesh.locations, mesh.edge_locations, mesh.corner_vertices, mesh.triangle_face},
                mesh.mesh.triangles) {}

ModelWall::ModelWall(std::function<Model()> model, WallLocations locations, Column<TriangleId, TriangleVertices> triangles)
    : model_(std::move(model)), locations_(std::move(locations)), triangles_(std::move(triangles)) {}

ModelWall::Knowledge& ModelWall::knowledge() const {
  std::call_once(once_, [&] {
    Model model = model_();
    std::vector<Segment> segments = find_segments(model);
    const std::size_t n_faces = model.faces.size();
    Column<EdgeId, std::vector<EdgeUseLocation>> uses = uses_of_edges(model);
    Column<VertexId, CornerId> corner_of(locations_.locations.size());
    for (const CornerId c : locations_.corner_vertices.ids())
      if (const VertexId v = locations_.corner_vertices[c]; v.is_valid()) corner_of[v] = c;
    knowledge_ = std::make_unique<Knowledge>(Knowledge{std::move(model), std::move(segments), std::vector<LazyProjector>(n_faces),
                                                       std::vector<LazyRegion>(n_faces), std::move(uses), std::move(corner_of)});
  });
  return *knowledge_;
}

std::vector<ModelWall::Segment> ModelWall::find_segments(const Model& model) const {
  std::vector<Segment> segments;
  std::vector<CutVertex> cuts;
  for (const VertexId v : locations_.edge_locations.ids())
    if (const EdgeLocation& location = locations_.edge_locations[v]; location.edge.is_valid()) cuts.push_back({location.edge, location.t, v});
  std::sort(cuts.begin(), cuts.end(), [](const CutVertex& a, const CutVertex& b) { return std::pair(a.edge, a.t) < std::pair(b.edge, b.t); });
  std::size_t next = 0;
  for (const EdgeId e : model.edges.ids()) {
    const ModelEdge& edge = model.edges[e];
    CutVertex last{e, edge.range.from, locations_.corner_vertices[edge.start]};
    const auto go_to = [&](const CutVertex& to) {
      if (last.vertex.is_valid() && to.vertex.is_valid() && last.vertex != to.vertex) {
        const bool is_up = last.vertex < to.vertex;
        segments.push_back({is_up ? last.vertex : to.vertex, is_up ? to.vertex : last.vertex, e, is_up ? last.t : to.t, is_up ? to.t : last.t});
      }
      last = to;
    };
    for (; next < cuts.size() && cuts[next].edge == e; ++next) go_to(cuts[next]);
    if (!edge.is_degenerate()) go_to({e, edge.range.to, locations_.corner_vertices[edge.end]});
  }
  std::sort(segments.begin(), segments.end(),
            [](const Segment& a, const Segment& b) { return std::tuple(a.low, a.high, a.edge) < std::tuple(b.low, b.high, b.edge); });
  return segments;
}

ModelWall::ModelWall(const ModelWall& other, const Transform& motion)
    : ModelWall([make = other.model_, motion] { return transformed(make(), motion); }, other.locations_, other.triangles_) {}

const ModelWall::Segment* ModelWall::segment_of(const Knowledge& known, VertexId a, VertexId b) {
  const auto key = ordered(a, b);
  const auto at =
      std::lower_bound(known.segments.begin(), known.segments.end(), key, [](const Segment& s, const auto& k) { return std::pair(s.low, s.high) < k; });
  return at != known.segments.end() && std::pair(at->low, at->high) == key ? &*at : nullptr;
}

const SurfaceProjector& ModelWall::projector_of(Knowledge& known, FaceId f) {
  LazyProjector& projector = known.projectors[f.index()];
  std::call_once(projector.once, [&] { projector.made = std::make_unique<const SurfaceProjector>(known.model.faces[f].surface); });
  return *projector.made;
}

Point ModelWall::nearest(const Point& p, TriangleId triangle, const std::array<double, 3>& weights) const {
  Knowledge& known = knowledge();
  const TriangleVertices& v = triangles_[triangle];
  for (std::size_t k = 0; k < 3; ++k) {
    const std::size_t a = (k + 1) % 3, b = (k + 2) % 3;
    if (weights[k] != 0.0 || weights[a] == 0.0 || weights[b] == 0.0) continue;
    const Segment* segment = segment_of(known, v[a], v[b]);
    if (!segment) continue;
    const double share = segment->high == v[b] ? weights[b] : weights[a];
    const Interval range{std::min(segment->t_low, segment->t_high), std::max(segment->t_low, segment->t_high)};
    return CurveProjector(known.model.edges[segment->edge].curve, range).seeded(p, segment->t_low + share * (segment->t_high - segment->t_low)).point;
  }
  // A corner with a known (u, v) on this face is used as start value. If there are several, the corner nearest to the point is used.
  const FaceId f = locations_.triangle_face[triangle];
  double best = 0.0;
  Uv seed{};
  for (std::size_t k = 0; k < 3; ++k)
    if (locations_.locations[v[k]].face == f && weights[k] > best) {
      best = weights[k];
      seed = locations_.locations[v[k]].at;
    }
  const SurfaceProjector& projector = projector_of(known, f);
  return (best > 0.0 ? projector.seeded(p, seed) : projector.nearest(p)).point;
}

}  // namespace sterna::surfmesh
