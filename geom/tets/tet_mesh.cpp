#include "geom/tets/tet_mesh.h"

#include <algorithm>
#include <numeric>
#include <string>

#include "geom/base/error.h"
#include "geom/base/parallel.h"
#include "geom/math/predicates.h"

namespace sterna::tets {
namespace {

constexpr std::size_t k_tet_chunk = 1 << 14;
constexpr std::size_t k_tet_node_chunk = 1 << 12;

/// A face stored at its lowest node.
struct FaceAtNode {
  std::uint32_t middle = 0, high = 0;
  std::uint32_t face = 0;  ///< 4 tet + corner
  bool is_odd = false;     ///< the corners' order is an odd permutation of low, middle, high
};

/// Sorts the corners of a face in ascending order; returns true if the sort is an odd permutation.
bool sort_corners(std::array<std::uint32_t, 3>& v) {
  bool is_odd = false;
  const auto order = [&](std::size_t i, std::size_t j) {
    if (v[i] <= v[j]) return;
    std::swap(v[i], v[j]);
    is_odd = !is_odd;
  };
  order(0, 1);
  order(1, 2);
  order(0, 1);
  return is_odd;
}

std::array<std::uint32_t, 3> corners_of(const Corners& nodes, std::size_t corner) {
  return {nodes[k_face[corner][0]], nodes[k_face[corner][1]], nodes[k_face[corner][2]]};
}

struct BadLocations {
  std::int64_t count = 0;
  std::vector<std::uint32_t> tets;  ///< the first few
  void add(std::uint32_t t) {
    if (++count <= static_cast<std::int64_t>(k_max_locations)) tets.push_back(t);
  }
};

BadLocations joined(BadLocations a, const BadLocations& b) {
  a.count += b.count;
  for (const std::uint32_t t : b.tets)
    if (a.tets.size() < k_max_locations) a.tets.push_back(t);
  return a;
}

void throw_if_any(const BadLocations& bad, const TetMesh& mesh, const std::string& what) {
  if (bad.count == 0) return;
  ErrorInfo error{.code = ErrorCode::tetra_result_invalid, .attempted = "connecting tetrahedra", .problem = std::to_string(bad.count) + " " + what};
  error.n_locations = bad.count;
  for (const std::uint32_t t : bad.tets) {
    Vec3 sum;
    double n = 0.0;
    for (const std::uint32_t v : mesh.nodes[t]) {
      if (v >= mesh.points.size()) continue;
      sum += mesh.points[v];
      n += 1.0;
    }
    error.locations.push_back({n > 0.0 ? sum / n : sum, "tetrahedron " + std::to_string(t)});
  }
  throw Error(std::move(error));
}

/// Faces sorted by their lowest node. They are counted and scattered in fixed chunks.
struct FacesByNode {
  std::vector<std::uint32_t> first;  ///< index of the first face of each node, and the end
  std::vector<std::uint32_t> faces;  ///< 4 tet + corner
};

FacesByNode sort_by_lowest_node(const TetMesh& mesh) {
  FacesByNode sorted;
  sorted.first.assign(mesh.points.size() + 1, 0);
  const auto lowest = [&](std::size_t t, std::size_t corner) { return std::ranges::min(corners_of(mesh.nodes[t], corner)); };
  for (std::size_t t = 0; t < mesh.nodes.size(); ++t)
    for (std::size_t corner = 0; corner < 4; ++corner) ++sorted.first[lowest(t, corner) + 1];
  std::partial_sum(sorted.first.begin(), sorted.first.end(), sorted.first.begin());
  sorted.faces.resize(4 * mesh.nodes.size());
  std::vector<std::uint32_t> next(sorted.first.begin(), sorted.first.end() - 1);
  for (std::size_t t = 0; t < mesh.nodes.size(); ++t)
    for (std::size_t corner = 0; corner < 4; ++corner) sorted.faces[next[lowest(t, corner)]++] = static_cast<std::uint32_t>(4 * t + corner);
  return sorted;
}

}  // namespace

TetMesh connect(std::vector<Vec3> points, std::span<const Corners> tetrahedra, const RunContext& context) {
  if (tetrahedra.size() >= k_most_tets)
    throw Error({.code = ErrorCode::overflow,
                 .attempted = "connecting tetrahedra",
                 .problem = std::to_string(tetrahedra.size()) + " tetrahedra, limit " + std::to_string(k_most_tets - 1)});
  TetMesh mesh{.points = std::move(points), .nodes = {tetrahedra.begin(), tetrahedra.end()}, .neighbours = {}};
  const std::vector<Vec3>& p = mesh.points;
  const auto is_bad = [&](const Corners& v) {
    return std::ranges::any_of(v, [&](std::uint32_t i) { return i >= p.size(); }) || orient3d(p[v[0]], p[v[1]], p[v[2]], p[v[3]]) <= 0;
  };
  const BadLocations not_positive = parallel_reduce(
      context, mesh.nodes.size(), BadLocations{},
      [&](std::size_t begin, std::size_t end) {
        BadLocations bad;
        for (std::size_t t = begin; t < end; ++t)
          if (is_bad(mesh.nodes[t])) bad.add(static_cast<std::uint32_t>(t));
        return bad;
      },
      joined, k_tet_chunk);
  throw_if_any(not_positive, mesh, "tetrahedra without positive volume");

  mesh.neighbours.assign(mesh.nodes.size(), {k_none, k_none, k_none, k_none});
  const FacesByNode sorted = sort_by_lowest_node(mesh);
  const BadLocations crowded = parallel_reduce(
      context, p.size(), BadLocations{},
      [&](std::size_t begin, std::size_t end) {
        BadLocations bad;
        std::vector<FaceAtNode> faces;
        for (std::size_t v = begin; v < end; ++v) {
          faces.clear();
          for (std::uint32_t i = sorted.first[v]; i < sorted.first[v + 1]; ++i) {
            std::array<std::uint32_t, 3> corners = corners_of(mesh.nodes[sorted.faces[i] / 4], sorted.faces[i] % 4);
            const bool is_odd = sort_corners(corners);
            faces.push_back({corners[1], corners[2], sorted.faces[i], is_odd});
          }
          std::ranges::sort(faces, [](const FaceAtNode& a, const FaceAtNode& b) {
            if (a.middle != b.middle) return a.middle < b.middle;
            return a.high != b.high ? a.high < b.high : a.face < b.face;
          });
          for (std::size_t i = 0; i + 1 < faces.size(); ++i) {
            const FaceAtNode &a = faces[i], &b = faces[i + 1];
            if (a.middle != b.middle || a.high != b.high) continue;
            if (a.is_odd == b.is_odd || mesh.neighbours[a.face / 4][a.face % 4] != k_none) bad.add(b.face / 4);
            mesh.neighbours[a.face / 4][a.face % 4] = b.face;
            mesh.neighbours[b.face / 4][b.face % 4] = a.face;
          }
        }
        return bad;
      },
      joined, k_tet_node_chunk);
  throw_if_any(crowded, mesh, "faces with more than two tetrahedra, or with two on one side");
  return mesh;
}

void compact(TetMesh& mesh, std::uint32_t first_removable) {
  std::vector<std::uint32_t> new_tet(mesh.nodes.size(), k_none), new_point(mesh.points.size(), k_none);
  std::uint32_t n_tets = 0;
  for (std::uint32_t t = 0; t < mesh.nodes.size(); ++t) {
    if (!mesh.is_alive(t)) continue;
    new_tet[t] = n_tets++;
    for (const std::uint32_t v : mesh.nodes[t]) new_point[v] = 0;
  }
  std::uint32_t n_points = 0;
  for (std::uint32_t v = 0; v < mesh.points.size(); ++v) {
    if (new_point[v] == k_none && v >= first_removable) continue;
    mesh.points[n_points] = mesh.points[v];
    new_point[v] = n_points++;
  }
  for (std::uint32_t t = 0; t < mesh.nodes.size(); ++t) {
    if (new_tet[t] == k_none) continue;
    Corners nodes = mesh.nodes[t], neighbours = mesh.neighbours[t];
    for (std::uint32_t& v : nodes) v = new_point[v];
    for (std::uint32_t& n : neighbours)
      if (n != k_none) n = 4 * new_tet[n / 4] + n % 4;
    mesh.nodes[new_tet[t]] = nodes;
    mesh.neighbours[new_tet[t]] = neighbours;
  }
  mesh.nodes.resize(n_tets);
  mesh.neighbours.resize(n_tets);
  mesh.points.resize(n_points);
}

}  // namespace sterna::tets
