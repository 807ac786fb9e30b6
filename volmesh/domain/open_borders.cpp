#include "volmesh/domain/open_borders.h"

#include "geom/math/measures.h"

namespace sterna::volmesh {
namespace {

constexpr double k_open_cosine = 0.03;  ///< cosine of the angle between a wall's normal and the direction into the patch beyond: below this value, the angle of
                                        ///< the fluid is above 178 degrees

bool lets_flow_through(PatchKind kind) { return kind == PatchKind::inflow || kind == PatchKind::outflow; }

}  // namespace

bool is_open_border(const TriMesh& surface, const Topology& topology, HalfedgeId of_wall) {
  const auto [a, b, c] = corners(surface, triangle_of(of_wall));
  const Point from = surface.points[topology.from(of_wall)], to = surface.points[topology.to(of_wall)];
  const Point beyond = surface.points[topology.from(previous(topology.twin(of_wall)))];
  const Vec3 along = normalized(to - from);
  const Vec3 inward = normalized(beyond - from - dot(beyond - from, along) * along);
  return !(dot(normalized(area_vector(a, b, c)), inward) > k_open_cosine);
}

std::vector<PatchId> flow_patches_beyond_open_borders(const TriMesh& boundary, const Column<PatchId, std::uint8_t>& has_layer, const RunContext& context) {
  const auto may_be = [&](PatchId p) { return has_layer[p] == 0 && lets_flow_through(boundary.patches[p].kind); };
  Column<VertexId, std::uint8_t> is_on_wall(boundary.n_vertices(), 0);
  for (const TriangleId t : boundary.triangles.ids())
    if (has_layer[boundary.triangle_patch[t]] != 0)
      for (const VertexId v : boundary.triangles[t]) is_on_wall[v] = 1;
  bool is_any = false;
  for (const TriangleId t : boundary.triangles.ids()) {
    if (!may_be(boundary.triangle_patch[t])) continue;
    for (const VertexId v : boundary.triangles[t]) is_any = is_any || is_on_wall[v] != 0;
  }
  std::vector<PatchId> found;
  if (!is_any) return found;
  const Topology topology(boundary, context);
  Column<PatchId, std::uint8_t> is_beyond(boundary.patches.size(), 0);
  for (const TriangleId t : boundary.triangles.ids()) {
    if (has_layer[boundary.triangle_patch[t]] == 0) continue;
    for (int k = 0; k < 3; ++k) {
      const HalfedgeId h = halfedge(t, k);
      if (topology.is_boundary(h)) continue;
      const PatchId beyond = boundary.triangle_patch[triangle_of(topology.twin(h))];
      if (may_be(beyond) && is_open_border(boundary, topology, h)) is_beyond[beyond] = 1;
    }
  }
  for (const PatchId p : is_beyond.ids())
    if (is_beyond[p] != 0) found.push_back(p);
  return found;
}

}  // namespace sterna::volmesh
