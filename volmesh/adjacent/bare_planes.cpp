#include "volmesh/adjacent/bare_planes.h"

#include <algorithm>
#include <vector>

#include "geom/mesh/topology.h"
#include "volmesh/adjacent/adjacent_surface.h"

namespace sterna::volmesh {
namespace {

struct PatchPart {
  PatchId patch;
  std::vector<TriangleId> triangles;
};

/// Returns the triangles that were added in the plane, grouped by patch, in the order of the boundary.
std::vector<PatchPart> parts_in(const AddedPlane& plane, std::size_t n_given, const TriMesh& boundary) {
  std::vector<PatchPart> parts;
  for (std::size_t i = n_given; i < boundary.n_triangles(); ++i) {
    const TriangleId t(i);
    if (!std::ranges::all_of(corners(boundary, t), [&](const Point& p) { return p[plane.axis] == plane.at; })) continue;
    const PatchId patch = boundary.triangle_patch[t];
    auto found = std::ranges::find(parts, patch, &PatchPart::patch);
    if (found == parts.end()) found = parts.insert(parts.end(), PatchPart{patch, {}});
    found->triangles.push_back(t);
  }
  return parts;
}

/// Border of some triangles, and a flag that layers of other patches end on them.
struct PartBorders {
  AdjacentRegion region;
  std::vector<VertexId> vertices;  ///< vertex of the boundary that corresponds to each point of the region
  bool has_border = false;
};

PartBorders borders_of(const PatchPart& part, const Topology& topology, const Column<PatchId, std::uint8_t>& has_layer, const TriMesh& boundary) {
  PartBorders borders;
  constexpr std::uint32_t k_no_point = 0xffffffffu;
  Column<VertexId, std::uint32_t> number(boundary.n_vertices(), k_no_point);
  const auto number_of = [&](VertexId v) {
    if (number[v] == k_no_point) {
      number[v] = static_cast<std::uint32_t>(borders.vertices.size());
      borders.vertices.push_back(v);
      borders.region.points.push_back(boundary.points[v]);
    }
    return number[v];
  };
  for (const TriangleId t : part.triangles)
    for (int k = 0; k < 3; ++k) {
      const HalfedgeId h = halfedge(t, k);
      const TriangleId beyond = triangle_of(topology.twin(h));
      if (std::ranges::binary_search(part.triangles, beyond)) continue;
      borders.has_border = borders.has_border || has_layer[boundary.triangle_patch[beyond]] != 0;
      const std::uint32_t from = number_of(topology.from(h)), to = number_of(topology.to(h));
      borders.region.edges.push_back({from, to});
    }
  borders.region.name = boundary.patches[part.patch].name;
  return borders;
}

}  // namespace

void mesh_bare_planes(std::span<const AddedPlane> planes, std::size_t n_given, const Column<PatchId, std::uint8_t>& has_layer, const PlaneSizes& sizes,
                      TriMesh& boundary, const RunContext& context) {
  if (planes.empty()) return;
  const Topology topology(boundary, context);
  Column<TriangleId, std::uint8_t> is_replaced(boundary.n_triangles(), 0);
  TriMesh made;  // new triangles, with vertices of the boundary
  Column<VertexId, Point> points = boundary.points;
  for (const AddedPlane& plane : planes) {
    Vec3 normal, at;
    normal[plane.axis] = plane.inward;
    at[plane.axis] = plane.at;
    const ConstraintPlane surface(at, normal);
    for (const PatchPart& part : parts_in(plane, n_given, boundary)) {
      PartBorders borders = borders_of(part, topology, has_layer, boundary);
      if (borders.has_border && has_layer[part.patch] == 0) continue;
      borders.region.surface = &surface;
      borders.region.size = limited_size(borders.region, plane.edge, sizes.ends.size_growth, sizes.size);
      const AdjacentTriangles triangles = triangulate_adjacent(borders.region, sizes.ends, context);
      for (const Point& p : triangles.new_points) borders.vertices.push_back(points.push_back(p));
      for (const TriangleId t : part.triangles) is_replaced[t] = 1;
      for (const auto& t : triangles.triangles) {
        made.triangles.push_back({borders.vertices[t[0]], borders.vertices[t[1]], borders.vertices[t[2]]});
        made.triangle_patch.push_back(part.patch);
      }
    }
  }
  TriMesh result{.points = std::move(points), .triangles = {}, .triangle_patch = {}, .patches = boundary.patches};
  for (const TriangleId t : boundary.triangles.ids()) {
    if (is_replaced[t]) continue;
    result.triangles.push_back(boundary.triangles[t]);
    result.triangle_patch.push_back(boundary.triangle_patch[t]);
  }
  for (const TriangleId t : made.triangles.ids()) {
    result.triangles.push_back(made.triangles[t]);
    result.triangle_patch.push_back(made.triangle_patch[t]);
  }
  boundary = std::move(result);
}

}  // namespace sterna::volmesh
