#include "surfmesh/model/join_parts.h"

#include <algorithm>
#include <map>
#include <string>

#include "surfmesh/model/estimate.h"
#include "surfmesh/model/mesh_report.h"

namespace sterna::surfmesh {
namespace {

/// Offsets of the numbers of a part.
struct Offsets {
  std::size_t vertices = 0, faces = 0, edges = 0;
};

template <class IdType>
IdType shifted(IdType id, std::size_t by) {
  return id.is_valid() ? IdType(static_cast<std::uint64_t>(id.index() + by)) : id;
}

void append_mesh(const SurfaceMesh& part, const Transform& placement, const Offsets& at, std::map<std::pair<std::string, PatchKind>, PatchId>& known,
                 SurfaceMesh& all) {
  Column<VertexId, Point> points = part.mesh.points;
  move_points(placement, points);
  for (const Point& p : points) all.mesh.points.push_back(p);
  Column<PatchId, PatchId> patch_of(part.mesh.patches.size());
  for (const PatchId p : part.mesh.patches.ids()) {
    const Patch& patch = part.mesh.patches[p];
    const auto [found, is_new] = known.try_emplace({patch.name, patch.kind}, PatchId(static_cast<std::uint64_t>(all.mesh.patches.size())));
    if (is_new) all.mesh.patches.push_back(patch);
    patch_of[p] = found->second;
  }
  for (const TriangleId t : part.mesh.triangles.ids()) {
    TriangleVertices v = part.mesh.triangles[t];
    for (VertexId& corner : v) corner = shifted(corner, at.vertices);
    all.mesh.triangles.push_back(v);
    all.mesh.triangle_patch.push_back(patch_of[part.mesh.triangle_patch[t]]);
    all.triangle_face.push_back(shifted(part.triangle_face[t], at.faces));
    all.is_band.push_back(part.is_band[t]);
  }
  for (const VertexLocation& location : part.locations) all.locations.push_back({shifted(location.face, at.faces), location.at});
  for (const EdgeLocation& location : part.edge_locations) all.edge_locations.push_back({shifted(location.edge, at.edges), location.t});
  for (const VertexId v : part.corner_vertices) all.corner_vertices.push_back(shifted(v, at.vertices));
}

void append_bands(const BandSummary& part, BandSummary& all) {
  all.n_edges += part.n_edges;
  all.n_strips += part.n_strips;
  all.n_triangles += part.n_triangles;
  all.max_stretch = std::max(all.max_stretch, part.max_stretch);
  all.max_strip_stretch = std::max(all.max_strip_stretch, part.max_strip_stretch);
  all.max_growth = std::max(all.max_growth, part.max_growth);
  all.notes.insert(all.notes.end(), part.notes.begin(), part.notes.end());
}

/// Appends a report. The locations in `part` are already final.
void append_report(SurfaceMeshReport part, const Offsets& at, bool is_first, SurfaceMeshReport& all) {
  const auto excess = [](const SurfaceMeshReport& report, FaceId face, std::size_t shift) {
    return face.is_valid() ? report.faces[face.index() - shift].max_normal_angle - report.faces[face.index() - shift].curvature_angle : 0.0;
  };
  if (excess(part, part.worst_normal_face, 0) > excess(all, all.worst_normal_face, 0)) all.worst_normal_face = shifted(part.worst_normal_face, at.faces);
  if (is_first || part.min_angle < all.min_angle) {
    all.min_angle = part.min_angle;
    all.worst_face = shifted(part.worst_face, at.faces);
  }
  all.max_angle = std::max(all.max_angle, part.max_angle);
  if (part.max_edge_distance > all.max_edge_distance) {
    all.max_edge_distance = part.max_edge_distance;
    all.edge_distance_location = part.edge_distance_location;
  }
  if (part.max_smooth_angle > all.max_smooth_angle) {
    all.max_smooth_angle = part.max_smooth_angle;
    all.smooth_angle_location = part.smooth_angle_location;
  }
  all.n_free_edges += part.n_free_edges;
  all.n_rounds = std::max(all.n_rounds, part.n_rounds);
  for (FaceMeshSummary& face : part.faces) {
    face.face = shifted(face.face, at.faces);
    all.faces.push_back(std::move(face));
  }
  for (LooseEdge& loose : part.loose_edges) {
    loose.edge = shifted(loose.edge, at.edges);
    loose.face = shifted(loose.face, at.faces);
    all.loose_edges.push_back(loose);
  }
  all.absorbed.insert(all.absorbed.end(), part.absorbed.begin(), part.absorbed.end());
  append_bands(part.bands, all.bands);
}

double share_of_normals(const std::vector<FaceMeshSummary>& faces) {
  double area = 0.0, above = 0.0;
  for (const FaceMeshSummary& face : faces) {
    area += face.area;
    above += face.area_above;
  }
  return area > 0.0 ? 1.0 - above / area : 1.0;
}

}  // namespace

void move_points(const Transform& placement, Column<VertexId, Point>& points) {
  if (placement == Transform{}) return;
  for (Point& p : points) p = placement.point(p);
}

void move_locations(const Transform& placement, SurfaceMeshReport& report) {
  if (placement == Transform{}) return;
  const auto move = [&](Point& p) { p = placement.point(p); };
  for (FaceMeshSummary& face : report.faces) {
    move(face.worst_location);
    move(face.normal_location);
  }
  for (AbsorbedPart& part : report.absorbed) move(part.location);
  for (LooseEdge& loose : report.loose_edges) move(loose.location);
  for (CrossingFaces& crossing : report.crossings) move(crossing.location);
  move(report.edge_distance_location);
  move(report.smooth_angle_location);
}

std::optional<SurfaceMesh> join_parts(const Model& model, std::span<const PlacedMesh> parts, const SurfaceMeshOptions& options, const RunContext& context) {
  SurfaceMesh all;
  std::map<std::pair<std::string, PatchKind>, PatchId> known;
  Offsets at;
  for (const PlacedMesh& part : parts) {
    append_mesh(*part.mesh, part.placement, at, known, all);
    SurfaceMeshReport report = part.mesh->report;
    move_locations(part.placement, report);
    append_report(std::move(report), at, &part == parts.data(), all.report);
    at.vertices += part.mesh->mesh.n_vertices();
    at.faces += part.model->faces.size();
    at.edges += part.model->edges.size();
  }
  all.report.share_normals = share_of_normals(all.report.faces);
  sort_loose_edges(all.report.loose_edges);
  measure_triangles(all);
  check_count(all, options);
  if (options.crossings == "ignore") return all;
  const MeshCrossings crossings = find_mesh_crossings(model, all, context);
  if (!crossings.refinable.empty() && parts.size() > 1) return std::nullopt;
  report_crossings(model, options, crossings, all, context);
  return all;
}

}  // namespace sterna::surfmesh
