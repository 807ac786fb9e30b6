#include "geom/mesh/body_patches.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <numbers>

#include "geom/math/measures.h"

namespace sterna {
namespace {

/// Largest diagonal of a body's opening relative to the box of all walls; inflow and outflow planes of tunnels are larger.
constexpr double k_largest_opening = 0.2;

/// Smallest diagonal of an outer wall relative to that of the boundary, both of bounding boxes.
constexpr double k_least_outer = 0.25;
/// Largest distance by which the boundary may lie behind an outer wall, relative to its extent along the wall normal: tolerance for walls that are not exactly
/// flat.
constexpr double k_behind = 0.05;
/// Number of directions in which the outermost boundary points are searched.
constexpr std::size_t k_directions = 128;

double diagonal(const Box& box) { return box.empty() ? 0.0 : norm(box.max - box.min); }

bool is_within(const Box& inner, const Box& outer) {
  const double room = 1e-6 * diagonal(outer);
  return inner.min.x >= outer.min.x - room && inner.min.y >= outer.min.y - room && inner.min.z >= outer.min.z - room && inner.max.x <= outer.max.x + room &&
         inner.max.y <= outer.max.y + room && inner.max.z <= outer.max.z + room;
}

/// Calls f(nodes, patch) for every boundary face.
template <class F>
void for_each_boundary_face(const HybridMesh& mesh, const F& f) {
  for (const BoundaryTriangle& face : mesh.boundary_triangles) f(std::span<const NodeId>(face.nodes), face.patch);
  for (const BoundaryQuad& face : mesh.boundary_quads) f(std::span<const NodeId>(face.nodes), face.patch);
}

std::vector<Box> boxes_of_patches(const HybridMesh& mesh) {
  std::vector<Box> boxes(mesh.patches.size());
  for_each_boundary_face(mesh, [&](std::span<const NodeId> nodes, PatchId patch) {
    for (const NodeId node : nodes) boxes[patch.index()].add(mesh.points[node]);
  });
  return boxes;
}

/// Returns the boundary points that are outermost in at least one direction; directions are spread over the sphere by the golden angle.
std::vector<Point> outermost_points(const HybridMesh& mesh) {
  const double turn = std::numbers::pi * (3.0 - std::sqrt(5.0));
  std::array<Vec3, k_directions> directions;
  std::array<double, k_directions> best;
  best.fill(-std::numeric_limits<double>::infinity());
  std::vector<Point> points(k_directions);
  for (std::size_t i = 0; i < k_directions; ++i) {
    const double z = 1.0 - (2.0 * static_cast<double>(i) + 1.0) / static_cast<double>(k_directions), r = std::sqrt(1.0 - z * z);
    directions[i] = {r * std::cos(turn * static_cast<double>(i)), r * std::sin(turn * static_cast<double>(i)), z};
  }
  for_each_boundary_face(mesh, [&](std::span<const NodeId> nodes, PatchId) {
    for (const NodeId node : nodes) {
      const Point& p = mesh.points[node];
      for (std::size_t i = 0; i < k_directions; ++i)
        if (const double along = dot(p, directions[i]); along > best[i]) {
          best[i] = along;
          points[i] = p;
        }
    }
  });
  return points;
}

}  // namespace

std::vector<std::uint8_t> outer_walls(const HybridMesh& mesh) {
  const std::vector<Box> boxes = boxes_of_patches(mesh);
  Box all;
  for (const Box& box : boxes)
    if (!box.empty()) {
      all.add(box.min);
      all.add(box.max);
    }
  std::vector<std::uint8_t> is_outer(mesh.patches.size(), 0), is_candidate(mesh.patches.size(), 0);
  for (const PatchId p : mesh.patches.ids())
    is_candidate[p.index()] = mesh.patches[p].kind == PatchKind::wall && diagonal(boxes[p.index()]) >= k_least_outer * diagonal(all) ? 1 : 0;
  if (std::ranges::find(is_candidate, 1) == is_candidate.end()) return is_outer;
  const std::vector<Point> outermost = outermost_points(mesh);
  std::vector<double> area(mesh.patches.size(), 0.0), outer_area(mesh.patches.size(), 0.0);
  for_each_boundary_face(mesh, [&](std::span<const NodeId> nodes, PatchId patch) {
    if (is_candidate[patch.index()] == 0) return;
    const Point& at = mesh.points[nodes[0]];
    Vec3 vector = area_vector(at, mesh.points[nodes[1]], mesh.points[nodes[2]]);
    if (nodes.size() == 4) vector += area_vector(at, mesh.points[nodes[2]], mesh.points[nodes[3]]);
    double least = 0.0, most = 0.0;  // extent of the boundary along the normal, which points out of the fluid
    for (const Point& p : outermost) {
      const double along = dot(p - at, vector);
      least = std::min(least, along);
      most = std::max(most, along);
    }
    area[patch.index()] += norm(vector);
    if (most <= k_behind * (most - least)) outer_area[patch.index()] += norm(vector);
  });
  Box outer, within;
  for (const PatchId p : mesh.patches.ids()) {
    is_outer[p.index()] = is_candidate[p.index()] != 0 && outer_area[p.index()] > 0.5 * area[p.index()] ? 1 : 0;
    if (mesh.patches[p].kind != PatchKind::wall || boxes[p.index()].empty()) continue;
    Box& box = is_outer[p.index()] != 0 ? outer : within;
    box.add(boxes[p.index()].min);
    box.add(boxes[p.index()].max);
  }
  if (within.empty() || !is_within(within, outer)) std::ranges::fill(is_outer, std::uint8_t{0});  // a floor with a step encloses nothing
  return is_outer;
}

HybridMesh boundary_of(const TriMesh& surface) {
  HybridMesh mesh;
  mesh.points = Column<NodeId, Point>(surface.points.raw());
  mesh.patches = surface.patches;
  mesh.boundary_triangles.reserve(surface.n_triangles());
  for (const TriangleId t : surface.triangles.ids()) {
    const TriangleVertices& v = surface.triangles[t];
    mesh.boundary_triangles.push_back({{NodeId(v[0].value()), NodeId(v[2].value()), NodeId(v[1].value())}, surface.triangle_patch[t]});
  }
  return mesh;
}

std::vector<std::uint8_t> patches_of_bodies(const HybridMesh& mesh) { return patches_of_bodies(mesh.patches, boxes_of_patches(mesh), outer_walls(mesh)); }

std::vector<std::uint8_t> patches_of_bodies(const Column<PatchId, Patch>& patches, std::span<const Box> boxes, std::span<const std::uint8_t> is_outer) {
  const auto is_wall = [&](PatchId p) { return patches[p].kind == PatchKind::wall && (is_outer.empty() || is_outer[p.index()] == 0); };
  Box walls;
  for (const PatchId p : patches.ids())
    if (is_wall(p) && !boxes[p.index()].empty()) {
      walls.add(boxes[p.index()].min);
      walls.add(boxes[p.index()].max);
    }
  std::vector<std::uint8_t> result(patches.size(), walls.empty() ? 1 : 0);
  for (const PatchId p : patches.ids()) {
    const Box& box = boxes[p.index()];
    const bool is_opening = (patches[p].kind == PatchKind::inflow || patches[p].kind == PatchKind::outflow) && !box.empty() && !walls.empty() &&
                            is_within(box, walls) && diagonal(box) < k_largest_opening * diagonal(walls);
    if (is_wall(p) || is_opening) result[p.index()] = 1;
  }
  return result;
}

}  // namespace sterna
