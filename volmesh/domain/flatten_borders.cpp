#include "volmesh/domain/flatten_borders.h"

#include <algorithm>
#include <cmath>
#include <optional>
#include <vector>

#include "geom/base/disjoint_sets.h"
#include "geom/base/number_text.h"
#include "geom/math/measures.h"
#include "volmesh/envelope/constrain_borders.h"

namespace sterna::volmesh {
namespace {

using BorderVertices = std::vector<VertexId>;

/// Returns the vertices of each connected part of the open boundary, ascending.
std::vector<BorderVertices> open_borders_of(const Topology& topology, const TriMesh& mesh) {
  DisjointSets sets(mesh.n_vertices());
  const auto root = [&](VertexId v) { return sets.root(v.value()); };
  std::vector<VertexId> on_borders;
  for (std::size_t i = 0; i < topology.n_halfedges(); ++i) {
    const HalfedgeId h(i);
    if (!topology.is_boundary(h)) continue;
    sets.join(topology.from(h).value(), topology.to(h).value());
    on_borders.push_back(topology.from(h));
  }
  std::sort(on_borders.begin(), on_borders.end(), [&](VertexId a, VertexId b) { return std::pair(root(a), a) < std::pair(root(b), b); });
  on_borders.erase(std::unique(on_borders.begin(), on_borders.end()), on_borders.end());
  std::vector<BorderVertices> borders;
  for (const VertexId v : on_borders) {
    if (borders.empty() || root(borders.back().front()) != root(v)) borders.emplace_back();
    borders.back().push_back(v);
  }
  return borders;
}

/// Returns the coordinates of an open-boundary loop on one axis, ascending.
std::vector<double> coordinates(const BorderVertices& border, const TriMesh& mesh, std::size_t axis) {
  std::vector<double> values;
  for (const VertexId v : border) values.push_back(mesh.points[v][axis]);
  std::sort(values.begin(), values.end());
  return values;
}

double plane_through(const std::vector<double>& values) {
  if (values.front() <= 0.0 && values.back() >= 0.0) return 0.0;
  double best = values[values.size() / 2];
  std::size_t most = 1;
  for (std::size_t begin = 0, end = 0; begin < values.size(); begin = end) {
    while (end < values.size() && values[end] == values[begin]) ++end;
    if (end - begin <= most) continue;
    most = end - begin;
    best = values[begin];
  }
  return best;
}

/// Returns the axis on which the loop is narrowest, if the loop is nearly but not exactly flat.
std::optional<std::size_t> nearly_flat_axis(const BorderVertices& border, const TriMesh& mesh, double length) {
  std::size_t axis = 0;
  double least = 0.0;
  for (std::size_t k = 0; k < 3; ++k) {
    const std::vector<double> values = coordinates(border, mesh, k);
    const double width = values.back() - values.front();
    if (k == 0 || width < least) {
      least = width;
      axis = k;
    }
  }
  if (least <= k_border_tolerance * length || least > k_flat_border * length) return std::nullopt;
  return axis;
}

bool turns_over(const std::vector<TriangleId>& triangles, const std::vector<Point>& moved, const BorderVertices& border, const TriMesh& mesh) {
  const auto location = [&](VertexId v) {
    const auto at = std::lower_bound(border.begin(), border.end(), v);
    return at != border.end() && *at == v ? moved[static_cast<std::size_t>(at - border.begin())] : mesh.points[v];
  };
  for (const TriangleId t : triangles) {
    const TriangleVertices& v = mesh.triangles[t];
    const auto [a, b, c] = corners(mesh, t);
    if (dot(area_vector(a, b, c), area_vector(location(v[0]), location(v[1]), location(v[2]))) <= 0.0) return true;
  }
  return false;
}

/// Returns for each open-boundary loop the triangles with a corner on it.
std::vector<std::vector<TriangleId>> triangles_beside(const std::vector<BorderVertices>& borders, const TriMesh& mesh) {
  Column<VertexId, std::uint32_t> border_of(mesh.n_vertices(), 0);
  std::vector<std::vector<TriangleId>> result(borders.size());
  for (std::size_t r = 0; r < borders.size(); ++r)
    for (const VertexId v : borders[r]) border_of[v] = static_cast<std::uint32_t>(r + 1);
  for (const TriangleId t : mesh.triangles.ids())
    for (const VertexId v : mesh.triangles[t])
      if (border_of[v] != 0) result[border_of[v] - 1].push_back(t);
  return result;
}

}  // namespace

void flatten_borders(const Topology& topology, TriMesh& mesh, const RunContext& context) {
  if (topology.n_boundary_halfedges() == 0) return;
  const double length = body_length(mesh);
  const std::vector<BorderVertices> borders = open_borders_of(topology, mesh);
  const auto beside = triangles_beside(borders, mesh);
  for (std::size_t r = 0; r < borders.size(); ++r) {
    const BorderVertices& border = borders[r];
    const std::optional<std::size_t> axis = nearly_flat_axis(border, mesh, length);
    if (!axis) continue;
    const double at = plane_through(coordinates(border, mesh, *axis));
    std::vector<Point> moved;
    double farthest = 0.0;
    std::size_t n_off = 0;
    for (const VertexId v : border) {
      moved.push_back(mesh.points[v]);
      const double off = std::abs(moved.back()[*axis] - at);
      farthest = std::max(farthest, off);
      n_off += off > 0.0 ? 1 : 0;
      moved.back()[*axis] = at;
    }
    if (turns_over(beside[r], moved, border, mesh)) continue;
    for (std::size_t i = 0; i < border.size(); ++i) mesh.points[border[i]] = moved[i];
    context.warn("an open boundary of " + std::to_string(border.size()) + " vertices lies near, but not in, the plane " + "xyz"[*axis] + " = " +
                 number_text(at) + ": " + std::to_string(n_off) + " vertices were moved into the plane, by up to " + number_text(farthest, 3) + " m (" +
                 number_text(farthest / length, 2) + " of the length)");
  }
}

}  // namespace sterna::volmesh
