#include "surfmesh/model/mesh_report.h"

#include <algorithm>
#include <numbers>

#include "geom/base/error.h"
#include "geom/math/measures.h"

namespace sterna::surfmesh {
namespace {

constexpr double k_angle_class = 10.0 * std::numbers::pi / 180.0;  ///< bin width of the histogram SurfaceMeshReport::least_angles

}  // namespace

void summarise_faces(const Column<FaceId, MeshedFace>& faces, SurfaceMeshReport& report) {
  report.min_angle = std::numbers::pi;
  double area = 0.0, area_above = 0.0, worst_excess = 0.0;
  for (const MeshedFace& face : faces) {
    report.faces.push_back(face.summary);
    if (face.summary.n_triangles > face.summary.n_band && face.summary.min_angle < report.min_angle) {
      report.min_angle = face.summary.min_angle;
      report.worst_face = face.summary.face;
    }
    report.max_angle = std::max(report.max_angle, face.summary.max_angle);
    if (face.edge_distance > report.max_edge_distance) {
      report.max_edge_distance = face.edge_distance;
      report.edge_distance_location = face.edge_distance_location;
    }
    report.loose_edges.insert(report.loose_edges.end(), face.loose_edges.begin(), face.loose_edges.end());
    area += face.summary.area;
    area_above += face.summary.area_above;
    const double excess = face.summary.max_normal_angle - face.summary.curvature_angle;
    if (face.summary.n_triangles > 0 && excess > worst_excess) {
      worst_excess = excess;
      report.worst_normal_face = face.summary.face;
    }
  }
  if (area > 0.0) report.share_normals = 1.0 - area_above / area;
  sort_loose_edges(report.loose_edges);
}

void measure_triangles(SurfaceMesh& mesh) {
  SurfaceMeshReport& report = mesh.report;
  std::int64_t n = 0, n_outside = 0;
  for (const FaceMeshSummary& face : report.faces) {
    n += face.n_triangles - face.n_band;
    n_outside += face.n_outside_20_130;
  }
  if (n > 0) report.share_20_130 = 1.0 - static_cast<double>(n_outside) / static_cast<double>(n);
  std::vector<float> least;
  double twice_area = 0.0;
  for (const TriangleId t : mesh.mesh.triangles.ids()) {
    if (mesh.is_band[t] != 0) continue;
    const auto p = corners(mesh.mesh, t);
    const double angle = std::min({corner_angle(p[0], p[1], p[2]), corner_angle(p[1], p[2], p[0]), corner_angle(p[2], p[0], p[1])});
    least.push_back(static_cast<float>(angle));
    ++report.least_angles[std::min(report.least_angles.size() - 1, static_cast<std::size_t>(angle / k_angle_class))];
    // The radius ratio is 2 r / R = 16 A^2 / (a b c (a + b + c)).
    const double a = distance(p[1], p[2]), b = distance(p[2], p[0]), c = distance(p[0], p[1]), twice = norm(cross(p[1] - p[0], p[2] - p[0]));
    twice_area += twice;
    if (twice > 0.0) report.mean_radius_ratio += twice * 4.0 * twice * twice / (a * b * c * (a + b + c));
  }
  if (least.empty()) return;
  if (twice_area > 0.0) report.mean_radius_ratio /= twice_area;
  const auto at = least.begin() + static_cast<std::ptrdiff_t>(least.size() / 100);
  std::nth_element(least.begin(), at, least.end());
  report.angle_quantile_1 = *at;
}

void report_crossings(const Model& model, const SurfaceMeshOptions& options, const MeshCrossings& crossings, SurfaceMesh& mesh, const RunContext& context) {
  mesh.report.n_crossings = crossings.total;
  if (crossings.total == 0) return;
  mesh.report.crossings = crossing_faces(model, mesh, crossings);
  ErrorInfo info = crossing_error(model, mesh, crossings, mesh.report.crossings);
  if (options.crossings != "error") return context.warn(Error(std::move(info)).what());
  info.hint += "; crossings = \"warn\" keeps the mesh with its crossings";
  throw Error(std::move(info));
}

void sort_loose_edges(std::vector<LooseEdge>& edges) {
  std::stable_sort(edges.begin(), edges.end(), [](const LooseEdge& a, const LooseEdge& b) { return a.distance * b.tolerance > b.distance * a.tolerance; });
}

}  // namespace sterna::surfmesh
