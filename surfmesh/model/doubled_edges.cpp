#include "surfmesh/model/doubled_edges.h"

#include <algorithm>
#include <array>
#include <map>
#include <numbers>
#include <set>

#include "geom/math/measures.h"

namespace sterna::surfmesh {
namespace {

/// Rad: limit of the angle between a new triangle and the surface at the new vertex. At a pointed tip each triangle covers a quarter of the turn, so 45
/// degrees plus the tip's slope are typical.
constexpr double k_largest_fold = 75.0 * std::numbers::pi / 180.0;

using Edge = std::pair<std::uint32_t, std::uint32_t>;
Edge edge_of(VertexId a, VertexId b) { return {std::min(a, b).value(), std::max(a, b).value()}; }

/// An edge inside a face: its end vertices and the triangles on both sides.
struct InnerEdge {
  FaceId face;
  VertexId a, b;
  std::array<std::size_t, 2> triangles{};
};

Vec3 normal_of(const FaceMesh& mesh, const TriangleVertices& v) {
  return cross(mesh.points[v[1].index()] - mesh.points[v[0].index()], mesh.points[v[2].index()] - mesh.points[v[0].index()]);
}

TriangleVertices with(TriangleVertices triangle, VertexId old, VertexId now) {
  std::replace(triangle.begin(), triangle.end(), old, now);
  return triangle;
}

bool has(const TriangleVertices& triangle, VertexId v) { return std::find(triangle.begin(), triangle.end(), v) != triangle.end(); }

bool split(const Surface& surface, const InnerEdge& edge, FaceMesh& mesh) {
  // Another edge of these triangles may already have been split.
  for (const std::size_t t : edge.triangles)
    if (!has(mesh.triangles[t], edge.a) || !has(mesh.triangles[t], edge.b)) return false;
  const Uv at = 0.5 * (mesh.uv[edge.a.index()] + mesh.uv[edge.b.index()]);
  const VertexId middle(static_cast<std::uint64_t>(mesh.points.size()));
  const SurfaceDerivatives d = surface.derivatives(at);
  const Vec3 normal = cross(d.du, d.dv);
  mesh.points.push_back(d.point);
  mesh.uv.push_back(at);
  mesh.normals.push_back(norm2(normal) > 0.0 ? normalized(normal) : Vec3{});
  for (const std::size_t t : edge.triangles)
    for (const VertexId old : {edge.a, edge.b}) {
      const Vec3 after = normal_of(mesh, with(mesh.triangles[t], old, middle));
      if (norm2(after) > 0.0 && norm2(normal) > 0.0 && angle_between(normal, after) <= k_largest_fold) continue;
      mesh.points.pop_back();
      mesh.uv.pop_back();
      mesh.normals.pop_back();
      return false;
    }
  for (const std::size_t t : edge.triangles) {
    mesh.triangles.push_back(with(mesh.triangles[t], edge.b, middle));
    mesh.triangles[t] = with(mesh.triangles[t], edge.a, middle);
  }
  return true;
}

void measure_angles(FaceMesh& mesh) {
  constexpr double k_least = 20.0 * std::numbers::pi / 180.0, k_largest = 130.0 * std::numbers::pi / 180.0;
  FaceMeshReport& report = mesh.report;
  report.min_angle = std::numbers::pi;
  report.max_angle = 0.0;
  report.n_outside_20_130 = 0;
  for (const TriangleVertices& v : mesh.triangles) {
    const Point &a = mesh.points[v[0].index()], &b = mesh.points[v[1].index()], &c = mesh.points[v[2].index()];
    const std::array<double, 3> angles{corner_angle(a, b, c), corner_angle(b, c, a), corner_angle(c, a, b)};
    const auto [least, largest] = std::minmax_element(angles.begin(), angles.end());
    if (*least < report.min_angle) {
      report.min_angle = *least;
      report.worst_location = (a + b + c) / 3.0;
    }
    report.max_angle = std::max(report.max_angle, *largest);
    if (*least < k_least || *largest > k_largest) ++report.n_outside_20_130;
  }
}

}  // namespace

std::size_t split_doubled_edges(const Model& model, const SurfaceMesh& joined, std::span<const TriangleId> wrong, Column<FaceId, MeshedFace>& faces) {
  std::set<FaceId> concerned;
  for (const TriangleId t : wrong) concerned.insert(joined.triangle_face[t]);
  // Inner edges between border vertices. The key holds the model entities of these vertices.
  std::map<Edge, std::vector<InnerEdge>> found;
  for (const FaceId f : concerned) {
    const MeshedFace& face = faces[f];
    std::map<Edge, std::vector<std::size_t>> sides;
    for (std::size_t t = 0; t < face.mesh.triangles.size(); ++t)
      for (std::size_t k = 0; k < 3; ++k) {
        const VertexId a = face.mesh.triangles[t][k], b = face.mesh.triangles[t][(k + 1) % 3];
        if (a.value() < face.mesh.n_border && b.value() < face.mesh.n_border) sides[edge_of(a, b)].push_back(t);
      }
    for (const auto& [edge, triangles] : sides) {
      if (triangles.size() != 2) continue;
      const VertexId a(edge.first), b(edge.second);
      found[edge_of(face.border_ids[a.index()], face.border_ids[b.index()])].push_back({f, a, b, {triangles[0], triangles[1]}});
    }
  }
  std::size_t n = 0;
  for (const auto& [edge, inner] : found)
    for (std::size_t i = 1; i < inner.size(); ++i) {
      MeshedFace& face = faces[inner[i].face];
      if (!split(*model.faces[inner[i].face].surface, inner[i], face.mesh)) continue;
      ++n;
      measure_angles(face.mesh);
      measure_face(face);
    }
  return n;
}

}  // namespace sterna::surfmesh
