#include "tests/geom/mesh/naive_dual.h"

#include <algorithm>
#include <cmath>
#include <map>
#include <numbers>

#include "geom/math/measures.h"

namespace sterna::test {
namespace {

Point mean(const HybridMesh& mesh, std::span<const NodeId> nodes) {
  Point sum;
  for (const NodeId node : nodes) sum += mesh.points[node];
  return sum / static_cast<double>(nodes.size());
}

}  // namespace

NaiveDual naive_dual(const HybridMesh& mesh) {
  const std::size_t n = mesh.points.size();
  constexpr double k_infinity = std::numeric_limits<double>::infinity();
  NaiveDual result;
  result.least_sub_volume = k_infinity;
  result.nodes.resize(n);
  std::vector<double> most(n, -k_infinity), least(n, k_infinity);
  std::map<std::pair<NodeId, NodeId>, Vec3> edges;  // from the lower to the upper node
  for_each_cell(mesh, [&](const Cell& cell) {
    const Point g = mean(mesh, cell.span());
    for (const LocalFace& face : cell_faces(cell.kind)) {
      std::vector<NodeId> nodes;
      for (std::size_t k = 0; k < face.size; ++k) nodes.push_back(cell.nodes[face.nodes[k]]);
      const Point f = mean(mesh, nodes);
      for (std::size_t k = 0; k < nodes.size(); ++k) {
        const NodeId i = nodes[k], j = nodes[(k + 1) % nodes.size()];
        const Point m = 0.5 * (mesh.points[i] + mesh.points[j]);
        const Vec3 area = area_vector(m, g, f);  // points from i to j; face f is counter-clockwise seen from outside
        edges[std::minmax(i, j)] += i < j ? area : -area;
        for (const NodeId node : {i, j}) {
          const double volume = node == i ? tet_volume(mesh.points[i], m, g, f) : tet_volume(mesh.points[j], m, f, g);
          most[node.index()] = std::max(most[node.index()], volume);
          least[node.index()] = std::min(least[node.index()], volume);
          result.least_sub_volume = std::min(result.least_sub_volume, volume);
          result.nodes[node.index()].volume += volume;
          result.volume += volume;
        }
      }
    }
  });
  std::map<std::pair<NodeId, PatchId>, Vec3> boundary;
  const auto add_boundary = [&](const auto& face) {
    const Point f = mean(mesh, face.nodes);
    const std::size_t size = face.nodes.size();
    for (std::size_t k = 0; k < size; ++k) {
      const Point& p = mesh.points[face.nodes[k]];
      const Point next = 0.5 * (p + mesh.points[face.nodes[(k + 1) % size]]), previous = 0.5 * (p + mesh.points[face.nodes[(k + size - 1) % size]]);
      boundary[{face.nodes[k], face.patch}] += area_vector(p, next, f) + area_vector(p, f, previous);
    }
  };
  for (const BoundaryTriangle& face : mesh.boundary_triangles) add_boundary(face);
  for (const BoundaryQuad& face : mesh.boundary_quads) add_boundary(face);

  std::vector<double> largest(n, 0.0), smallest(n, k_infinity), edge_area(n, 0.0), all_area(n, 0.0), weighted(n, 0.0);
  std::vector<Vec3> closure(n);
  const auto add_face = [&](NodeId node, const Vec3& normal) {
    const std::size_t i = node.index();
    largest[i] = std::max(largest[i], norm(normal));
    smallest[i] = std::min(smallest[i], norm(normal));
    all_area[i] += norm(normal);
    closure[i] += normal;
  };
  for (const auto& [ends, normal] : edges) {
    const Vec3 along = mesh.points[ends.second] - mesh.points[ends.first];
    const double angle = 0.5 * std::numbers::pi - angle_between(normal, along);
    add_face(ends.first, normal);
    add_face(ends.second, -normal);
    for (const NodeId node : {ends.first, ends.second}) {
      weighted[node.index()] += norm(normal) * angle;
      edge_area[node.index()] += norm(normal);
    }
  }
  for (const auto& [key, normal] : boundary) add_face(key.first, normal);
  for (std::size_t i = 0; i < n; ++i) {
    result.nodes[i].orthogonality = weighted[i] / edge_area[i];
    result.nodes[i].face_area_ratio = largest[i] / smallest[i];
    result.nodes[i].sub_volume_ratio = most[i] / least[i];
    result.nodes[i].closure = norm(closure[i]) / all_area[i];
  }
  return result;
}

}  // namespace sterna::test
