// ModelWall: nearest locations on single trimmed faces, with normals.
#include <algorithm>
#include <cmath>

#include "surfmesh/model/model_wall.h"

namespace sterna::surfmesh {
namespace {

/// Lower limit for the ratio of |du x dv| to the product of both lengths. Below the limit rounding dominates the direction of the normal.
constexpr double k_least_sine = 1e-8;
/// Lower limit for the length of du or dv, relative to the larger one. Below the limit, at poles, the parameter has no direction.
constexpr double k_least_speed = 1e-9;
/// Distances from a pole at which a normal is searched, as fractions of the face's parameter box.
constexpr std::array<double, 3> k_beside = {1e-6, 1e-4, 1e-2};

std::optional<Vec3> normal_there(const Surface& surface, Uv at) {
  const SurfaceDerivatives d = surface.derivatives(at);
  const double u = norm(d.du), v = norm(d.dv);
  if (std::min(u, v) <= k_least_speed * std::max(u, v)) return std::nullopt;
  const Vec3 n = cross(d.du, d.dv);
  return norm(n) > k_least_sine * u * v ? std::optional(normalized(n)) : std::nullopt;
}

}  // namespace

const FaceRegion& ModelWall::region_of(Knowledge& known, FaceId f) {
  LazyRegion& region = known.regions[f.index()];
  std::call_once(region.once, [&] { region.made = std::make_unique<const FaceRegion>(known.model, f); });
  return *region.made;
}

bool ModelWall::is_inner(TriangleId triangle, VertexId v) const {
  return locations_.locations[v].face == locations_.triangle_face[triangle] && !locations_.edge_locations[v].edge.is_valid() &&
         !knowledge().corner_of[v].is_valid();
}

std::vector<Uv> ModelWall::locations_in(const Knowledge& known, FaceId f, VertexId v) const {
  if (const EdgeLocation& on_edge = locations_.edge_locations[v]; on_edge.edge.is_valid()) {
    std::vector<Uv> locations;
    for (const EdgeUseLocation& use : known.uses[on_edge.edge])
      if (use.face == f) locations.push_back(known.model.faces[f].borders[use.border][use.location].parameter->point(on_edge.t));
    return locations;
  }
  if (locations_.locations[v].face == f) return {locations_.locations[v].at};
  return {};
}

ModelProjection ModelWall::projection(const Point& p, TriangleId triangle, const std::array<double, 3>& weights) const {
  Knowledge& known = knowledge();
  const FaceId f = locations_.triangle_face[triangle];
  const TriangleVertices& v = triangles_[triangle];
  const SurfaceProjector& projector = projector_of(known, f);
  const Surface& surface = *projector.surface();
  std::optional<Uv> seed;
  double nearest = std::numeric_limits<double>::infinity();
  const auto try_seed = [&](Uv at) {
    if (const double d2 = norm2(surface.point(at) - p); d2 < nearest) {
      nearest = d2;
      seed = at;
    }
  };
  Uv middle{};
  bool is_plain = true;
  for (std::size_t k = 0; k < 3; ++k) {
    const std::vector<Uv> locations = locations_in(known, f, v[k]);
    for (const Uv& at : locations) try_seed(at);
    if (locations.size() == 1) middle = middle + weights[k] * locations.front();
    else is_plain = false;
  }
  if (is_plain) try_seed(middle);  // beyond a seam the middle lies elsewhere and is no nearer
  const SurfaceProjection found = seed ? projector.seeded(p, *seed) : projector.nearest(p);
  ModelProjection projection{.face = f, .at = found.at, .point = found.point, .distance = found.distance};
  if (!(is_inner(triangle, v[0]) && is_inner(triangle, v[1]) && is_inner(triangle, v[2]))) projection.is_inside = region_of(known, f).contains(found.at);
  return projection;
}

std::optional<ModelProjection> ModelWall::edge_projection(const Point& p, TriangleId triangle, std::size_t k) const {
  const Knowledge& known = knowledge();
  const TriangleVertices& v = triangles_[triangle];
  const Segment* segment = segment_of(known, v[(k + 1) % 3], v[(k + 2) % 3]);
  if (!segment) return std::nullopt;
  const FaceId f = locations_.triangle_face[triangle];
  const Interval range{std::min(segment->t_low, segment->t_high), std::max(segment->t_low, segment->t_high)};
  const CurveProjection on_curve = CurveProjector(known.model.edges[segment->edge].curve, range).nearest(p);
  std::optional<ModelProjection> projection;
  for (const EdgeUseLocation& use : known.uses[segment->edge])
    if (use.face == f && !projection)
      projection = ModelProjection{.face = f,
                                   .at = known.model.faces[f].borders[use.border][use.location].parameter->point(on_curve.t),
                                   .point = on_curve.point,
                                   .distance = on_curve.distance};
  return projection;
}

std::optional<Point> ModelWall::location_of(VertexId v) const {
  const Knowledge& known = knowledge();
  if (const CornerId c = known.corner_of[v]; c.is_valid()) return known.model.corners[c].point;
  if (const EdgeLocation& on_edge = locations_.edge_locations[v]; on_edge.edge.is_valid()) {
    const ModelEdge& edge = known.model.edges[on_edge.edge];
    return edge.is_degenerate() ? known.model.corners[edge.start].point : edge.curve->point(on_edge.t);
  }
  const VertexLocation& location = locations_.locations[v];
  if (!location.face.is_valid()) return std::nullopt;
  return known.model.faces[location.face].surface->point(location.at);
}

std::optional<ModelNormal> ModelWall::normal(FaceId id, Uv at) const {
  const ModelFace& face = knowledge().model.faces[id];
  const double side = face.is_reversed ? -1.0 : 1.0;
  if (const std::optional<Vec3> n = normal_there(*face.surface, at)) return ModelNormal{side * *n, false};
  const ParameterBox box = face.surface->domain();
  const Uv middle{0.5 * (box.u.from + box.u.to), 0.5 * (box.v.from + box.v.to)};
  for (const double share : k_beside) {
    // Each parameter is moved separately. Along a pole the other parameter is undetermined, and the location would rotate around the pole.
    const double du = share * box.u.length() * (at.u < middle.u ? 1.0 : -1.0), dv = share * box.v.length() * (at.v < middle.v ? 1.0 : -1.0);
    for (const Uv beside : {Uv{at.u, at.v + dv}, Uv{at.u + du, at.v}})
      if (const std::optional<Vec3> n = normal_there(*face.surface, beside)) return ModelNormal{side * *n, true};
  }
  return std::nullopt;
}

const std::string& ModelWall::name_of(FaceId face) const { return knowledge().model.faces[face].name; }

}  // namespace sterna::surfmesh
