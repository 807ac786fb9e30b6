// The plane of a flat patch.
#pragma once

#include <algorithm>
#include <cmath>
#include <vector>

#include "geom/base/borrowed.h"
#include "geom/math/measures.h"
#include "geom/mesh/tri_mesh.h"

namespace sterna::volmesh {

/// The plane of a flat patch. It is a plane of constant x, y or z if all vertices are nearly in such a plane, otherwise a plane through their middle.
struct FlatFit {
  bool is_flat = false;
  Point point;
  Vec3 normal;
  VertexId farthest;      ///< vertex of the mesh with the largest distance
  double distance = 0.0;  ///< m, distance of that vertex
};

/// The vertices of a patch in ascending order.
class PatchVertices {
 public:
  PatchVertices(Borrowed<const TriMesh> of, PatchId patch) : mesh_(of) {
    const TriMesh& mesh = of;
    for (const TriangleId t : mesh.triangles.ids()) {
      if (mesh.triangle_patch[t] != patch) continue;
      const auto [a, b, c] = corners(mesh, t);
      normal_ += area_vector(a, b, c);
      for (const VertexId v : mesh.triangles[t]) vertices_.push_back(v);
    }
    std::sort(vertices_.begin(), vertices_.end());
    vertices_.erase(std::unique(vertices_.begin(), vertices_.end()), vertices_.end());
  }
  const std::vector<VertexId>& vertices() const { return vertices_; }

  /// Fits a plane. \p tolerance_at returns the allowed distance of a vertex at a point, m. The patch is not flat if there are no triangles, or if their areas
  /// cancel out.
  template <class Tolerance>
  FlatFit fit(const Tolerance& tolerance_at) const {
    FlatFit result;
    if (norm2(normal_) == 0.0) return result;
    const Vec3 n = normalized(normal_);
    for (std::size_t axis = 0; axis < 3; ++axis) {
      const double value = most_common(axis);
      const bool is_all = std::ranges::all_of(vertices_, [&](VertexId v) { return std::abs(mesh_.points[v][axis] - value) <= tolerance_at(mesh_.points[v]); });
      if (!is_all) continue;
      result.is_flat = true;
      result.point = {};
      result.point[axis] = value;
      result.normal = {};
      result.normal[axis] = n[axis] > 0.0 ? 1.0 : -1.0;
      return result;
    }
    Point middle;
    for (const VertexId v : vertices_) middle += mesh_.points[v];
    middle = middle / static_cast<double>(vertices_.size());
    result.point = middle;
    result.normal = n;
    result.is_flat = true;
    for (const VertexId v : vertices_) {
      const double d = std::abs(dot(n, mesh_.points[v] - middle));
      if (d > tolerance_at(mesh_.points[v])) result.is_flat = false;
      if (d < result.distance) continue;
      result.distance = d;
      result.farthest = v;
    }
    return result;
  }

 private:
  double most_common(std::size_t axis) const {
    std::vector<double> values;
    for (const VertexId v : vertices_) values.push_back(mesh_.points[v][axis]);
    std::sort(values.begin(), values.end());
    double best = values.front();
    std::size_t most = 0;
    for (std::size_t begin = 0, end = 0; begin < values.size(); begin = end) {
      while (end < values.size() && values[end] == values[begin]) ++end;
      if (end - begin <= most) continue;
      most = end - begin;
      best = values[begin];
    }
    return most > 1 ? best : values[values.size() / 2];
  }

  const TriMesh& mesh_;
  std::vector<VertexId> vertices_;
  Vec3 normal_;
};

}  // namespace sterna::volmesh
