#include "surfmesh/model/deviation.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdio>
#include <optional>
#include <set>
#include <span>
#include <utility>

#include "geom/base/error.h"
#include "geom/base/parallel.h"
#include "geom/math/nearest.h"
#include "geom/mesh/bvh.h"

namespace sterna::surfmesh {
namespace {

/// The nearest face may have a triangle of the wall that is farther than the nearest triangle by this fraction of its longest edge: facets of 24 degrees sag by
/// a twentieth of an edge on either side.
constexpr double k_reach = 0.1;
/// Faces up to this many times as far as the nearest one are used for the comparison of normals: a facet across a crease lies between both faces.
constexpr double k_near_edges = 2.0;
/// Relative to the body length: all faces within this distance are used, even if the nearest face is much nearer. Edges of models deviate from their faces by
/// about this distance.
constexpr double k_same_location = 1e-9;
/// Relative to the body length: a node within this distance of a vertex of the wall lies on the model, and no other location is searched.
constexpr double k_same = 1e-14;
/// Queries per chunk. One query takes 5 to 50 us.
constexpr std::size_t k_chunk = 64;

struct Facet {
  std::array<std::uint32_t, 4> nodes{};
  std::uint8_t size = 3;
  PatchId patch;
  std::uint64_t number = 0;  ///< number in the boundary: triangles come first, then quads
};

/// The measured entities: facets with normals that point out of the body, and their nodes.
struct Walls {
  const std::vector<Point>& points;
  std::vector<Facet> facets;
  std::vector<std::uint32_t> nodes;  ///< node numbers, ascending
  std::vector<PatchId> node_patch;   ///< per node: patch of the first facet that contains it
  const Column<PatchId, Patch>& patches;
  std::vector<std::string> unknown;
};

std::array<double, 3> weights_of(const Point& q, const std::array<Point, 3>& t) {
  const Vec3 normal = cross(t[1] - t[0], t[2] - t[0]);
  const double n2 = norm2(normal);
  if (n2 == 0.0) return {1.0, 0.0, 0.0};
  const double b = std::clamp(dot(cross(q - t[0], t[2] - t[0]), normal) / n2, 0.0, 1.0),
               c = std::clamp(dot(cross(t[1] - t[0], q - t[0]), normal) / n2, 0.0, 1.0 - b);
  return {1.0 - b - c, b, c};
}

/// Triangles of one face near a point.
struct NearFace {
  FaceId face;
  TriangleId nearest;
  Point point;  ///< nearest point on the triangle
  double distance2 = 0.0;
  std::vector<TriangleId> triangles;
};

class Probe {
 public:
  Probe(const TriMesh& wall, const ModelWall& model, double length, const RunContext& context)
      : wall_(wall), model_(model), length_(length), tree_(wall, context) {}

  /// Returns the distance of a node from the model, m.
  double distance_of(const Point& p) const {
    const NearestHit hit = tree_.nearest(p);
    for (const VertexId v : wall_.triangles[hit.triangle])
      if (norm2(wall_.points[v] - p) <= k_same * k_same * length_ * length_)
        if (const std::optional<Point> location = model_.location_of(v))
          if (const double d = norm(*location - p); d <= k_same * length_) return d;
    return nearest(p, hit).distance;
  }

  /// Returns the nearest location on the model.
  ModelProjection nearest(const Point& p) const { return nearest(p, tree_.nearest(p)); }
  TriangleId nearest_triangle(const Point& p) const { return tree_.nearest(p).triangle; }

  /// Returns the nearest locations of all faces around the point, each within its face's border.
  std::vector<ModelProjection> projections(const Point& p, const NearestHit& hit) const {
    std::vector<NearFace> faces = faces_near(p, hit.distance + std::max(k_reach * longest_edge(hit.triangle), k_same_location * length_));
    std::vector<ModelProjection> projections;
    for (const NearFace& near : faces) projections.push_back(projection_of(p, near));
    return projections;
  }

  struct Turn {
    double angle = 0.0;  ///< rad; NaN for a facet without area
    bool is_beside = false, is_without = false;
  };
  /// \pre `normal` points out of the body.
  Turn turn_of(const Point& centroid, const Vec3& normal) const {
    const std::vector<ModelProjection> all = projections(centroid, tree_.nearest(centroid));
    const double reach = std::max(k_near_edges * least_distance(all), k_same_location * length_);
    Turn turn{.is_without = true};
    double best = std::numeric_limits<double>::infinity();
    for (const ModelProjection& projection : all) {
      if (projection.distance > reach) continue;
      const std::optional<ModelNormal> of_model = model_.normal(projection.face, projection.at);
      if (!of_model) continue;
      turn.is_without = false;
      const double angle = angle_between(of_model->normal, normal);
      if (angle >= best) continue;
      best = angle;
      turn.is_beside = of_model->is_beside;
    }
    turn.angle = norm2(normal) > 0.0 ? best : std::numeric_limits<double>::quiet_NaN();
    return turn;
  }

 private:
  static double least_distance(const std::vector<ModelProjection>& projections) {
    double least = std::numeric_limits<double>::infinity();
    for (const ModelProjection& projection : projections) least = std::min(least, projection.distance);
    return least;
  }

  double longest_edge(TriangleId t) const {
    const auto p = corners(wall_, t);
    return std::sqrt(std::max({norm2(p[1] - p[0]), norm2(p[2] - p[1]), norm2(p[0] - p[2])}));
  }

  ModelProjection nearest(const Point& p, const NearestHit& hit) const {
    ModelProjection best;
    for (const ModelProjection& projection : projections(p, hit))
      if (projection.distance < best.distance) best = projection;
    return best;
  }

  /// Returns the triangles sorted by ascending face.
  std::vector<NearFace> faces_near(const Point& p, double reach) const {
    std::vector<NearFace> faces;
    const Vec3 r{reach, reach, reach};
    tree_.boxes().for_each_overlap(Box{p - r, p + r}, [&](std::uint32_t i) {
      const TriangleId t(i);
      const Point q = nearest_on_triangle(p, corners(wall_, t));
      const double d2 = norm2(q - p);
      if (d2 > reach * reach) return true;
      const FaceId f = model_.locations().triangle_face[t];
      const auto at = std::lower_bound(faces.begin(), faces.end(), f, [](const NearFace& near, FaceId id) { return near.face < id; });
      if (at == faces.end() || at->face != f) {
        faces.insert(at, NearFace{f, t, q, d2, {t}});
        return true;
      }
      at->triangles.push_back(t);
      if (std::pair(d2, t) < std::pair(at->distance2, at->nearest)) {
        at->nearest = t;
        at->point = q;
        at->distance2 = d2;
      }
      return true;
    });
    return faces;
  }

  ModelProjection projection_of(const Point& p, const NearFace& near) const {
    const ModelProjection projection = model_.projection(p, near.nearest, weights_of(near.point, corners(wall_, near.nearest)));
    if (projection.is_inside) return projection;
    ModelProjection best;
    for (const TriangleId t : near.triangles)
      for (std::size_t k = 0; k < 3; ++k)
        if (const std::optional<ModelProjection> on_edge = model_.edge_projection(p, t, k); on_edge && on_edge->distance < best.distance) best = *on_edge;
    if (best.face.is_valid()) return best;
    // The border of the face is an edge that is too short for the mesh. The distance to the triangle is used instead.
    ModelProjection placeholder = projection;
    placeholder.distance = std::max(projection.distance, std::sqrt(near.distance2));
    return placeholder;
  }

  const TriMesh& wall_;
  const ModelWall& model_;
  double length_;
  TriangleTree tree_;
};

/// Flags the `patches` that the wall has by name. Patches of kind wall that the surface does not have are recorded.
Column<PatchId, std::uint8_t> known_patches(const TriMesh& wall, Walls& walls) {
  std::set<std::string> names;
  for (const Patch& patch : wall.patches) names.insert(patch.name);
  Column<PatchId, std::uint8_t> is_known(walls.patches.size());
  for (const PatchId id : walls.patches.ids()) {
    is_known[id] = names.contains(walls.patches[id].name) ? 1 : 0;
    if (is_known[id] == 0 && walls.patches[id].kind == PatchKind::wall) walls.unknown.push_back(walls.patches[id].name);
  }
  return is_known;
}

void find_nodes(Walls& walls) {
  std::vector<std::pair<std::uint32_t, PatchId>> uses;
  for (const Facet& facet : walls.facets)
    for (std::size_t k = 0; k < facet.size; ++k) uses.emplace_back(facet.nodes[k], facet.patch);
  std::sort(uses.begin(), uses.end());
  for (std::size_t i = 0; i < uses.size(); ++i)
    if (i == 0 || uses[i].first != uses[i - 1].first) {
      walls.nodes.push_back(uses[i].first);
      walls.node_patch.push_back(uses[i].second);
    }
}

std::string sentence(const char* pattern, double value) {
  char buffer[128];
  std::snprintf(buffer, sizeof buffer, pattern, value);
  return buffer;
}

Point centroid_of(const Walls& walls, const Facet& facet) {
  Vec3 sum{};
  for (std::size_t k = 0; k < facet.size; ++k) sum += walls.points[facet.nodes[k]];
  return (1.0 / facet.size) * sum;
}

Vec3 normal_of(const Walls& walls, const Facet& facet) {
  const auto p = [&](std::size_t k) { return walls.points[facet.nodes[k]]; };
  return facet.size == 3 ? cross(p(1) - p(0), p(2) - p(0)) : cross(p(2) - p(0), p(3) - p(1));
}

Deviation measure(const Walls& walls, const TriMesh& wall, const ModelWall& model, const GateTable& limits, const RunContext& context) {
  Deviation result;
  result.length = body_length(wall);
  result.n_nodes = static_cast<std::int64_t>(walls.nodes.size());
  result.n_facets = static_cast<std::int64_t>(walls.facets.size());
  result.unknown = walls.unknown;
  if (walls.facets.empty()) {
    std::string reason = "no patch name of the mesh matches a patch of the model's surface, such as \"" +
                         (wall.patches.empty() ? std::string() : wall.patches.raw().front().name) + "\"";
    result.distance = not_checked(Measure::cad_distance, limits, reason);
    result.normal = not_checked(Measure::cad_normal, limits, std::move(reason));
    return result;
  }
  const Probe probe(wall, model, result.length, context);
  context.progress(0.1);

  std::vector<double> distance(walls.nodes.size());
  parallel_for(
      context, distance.size(), [&](std::size_t i) { distance[i] = probe.distance_of(walls.points[walls.nodes[i]]); }, k_chunk);
  context.progress(0.4);
  GateScan distances(info_of(Measure::cad_distance), limits[Measure::cad_distance]);
  for (std::size_t i = 0; i < distance.size(); ++i) distances.add(distance[i] / result.length, i);
  result.distance = distances.result([&](std::uint64_t i) {
    const Point& p = walls.points[walls.nodes[i]];
    return std::pair(p, "node " + std::to_string(walls.nodes[i]) + ", patch " + walls.patches[walls.node_patch[i]].name +
                            sentence(", %.4g m off ", distance[i]) + "face \"" + model.name_of(probe.nearest(p).face) + "\" of the model");
  });

  std::vector<Probe::Turn> turns(walls.facets.size());
  parallel_for(
      context, turns.size(), [&](std::size_t i) { turns[i] = probe.turn_of(centroid_of(walls, walls.facets[i]), normal_of(walls, walls.facets[i])); }, k_chunk);
  GateScan normals(info_of(Measure::cad_normal), limits[Measure::cad_normal]);
  for (std::size_t i = 0; i < turns.size(); ++i) {
    if (turns[i].is_beside) ++result.n_beside;
    if (turns[i].is_without) ++result.n_without;
    else normals.add(turns[i].angle, i);
  }
  result.normal = normals.result([&](std::uint64_t i) {
    const Facet& facet = walls.facets[i];
    const Point p = centroid_of(walls, facet);
    return std::pair(p, std::string(facet.size == 3 ? "triangle " : "quad ") + std::to_string(facet.number) + ", patch " + walls.patches[facet.patch].name +
                            ", against face \"" + model.name_of(probe.nearest(p).face) + "\" of the model" +
                            (turns[i].is_beside ? ", whose normal was evaluated beside a pole" : ""));
  });
  context.progress(1.0);
  return result;
}

}  // namespace

Deviation measure_deviation(const HybridMesh& mesh, const TriMesh& wall, const ModelWall& model, const GateTable& limits, const RunContext& context) {
  Walls walls{.points = mesh.points.raw(), .facets = {}, .nodes = {}, .node_patch = {}, .patches = mesh.patches, .unknown = {}};
  const Column<PatchId, std::uint8_t> is_known = known_patches(wall, walls);
  // Boundary faces point out of the fluid, into the body. Their orientation is reversed.
  for (std::size_t i = 0; i < mesh.boundary_triangles.size(); ++i)
    if (const auto& [n, patch] = mesh.boundary_triangles[i]; is_known[patch])
      walls.facets.push_back({{n[0].value(), n[2].value(), n[1].value(), 0}, 3, patch, i});
  for (std::size_t i = 0; i < mesh.boundary_quads.size(); ++i)
    if (const auto& [n, patch] = mesh.boundary_quads[i]; is_known[patch])
      walls.facets.push_back({{n[0].value(), n[3].value(), n[2].value(), n[1].value()}, 4, patch, i});
  find_nodes(walls);
  return measure(walls, wall, model, limits, context);
}

Deviation measure_deviation(const TriMesh& surface, const TriMesh& wall, const ModelWall& model, const GateTable& limits, const RunContext& context) {
  Walls walls{.points = surface.points.raw(), .facets = {}, .nodes = {}, .node_patch = {}, .patches = surface.patches, .unknown = {}};
  const Column<PatchId, std::uint8_t> is_known = known_patches(wall, walls);
  for (const TriangleId t : surface.triangles.ids())
    if (const PatchId patch = surface.triangle_patch[t]; is_known[patch]) {
      const TriangleVertices& v = surface.triangles[t];
      walls.facets.push_back({{v[0].value(), v[1].value(), v[2].value(), 0}, 3, patch, t.index()});
    }
  find_nodes(walls);
  return measure(walls, wall, model, limits, context);
}

struct ModelDistance::Lookup {
  Probe probe;
};

ModelDistance::ModelDistance(Borrowed<const TriMesh> wall, Borrowed<const ModelWall> model, const RunContext& context)
    : lookup_(std::make_unique<const Lookup>(Lookup{Probe(wall, model, body_length(wall), context)})) {}
ModelDistance::~ModelDistance() = default;

double ModelDistance::operator()(const Point& p) const { return lookup_->probe.distance_of(p); }
TriangleId ModelDistance::nearest_triangle(const Point& p) const { return lookup_->probe.nearest_triangle(p); }

}  // namespace sterna::surfmesh
