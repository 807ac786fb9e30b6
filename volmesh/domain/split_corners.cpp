#include "volmesh/domain/split_corners.h"

#include <algorithm>
#include <cmath>
#include <map>
#include <numbers>
#include <vector>

#include "geom/base/disjoint_sets.h"
#include "geom/math/measures.h"
#include "geom/mesh/topology.h"

namespace sterna::volmesh {
namespace {

/// Rad: the limit equals that for edges of curved adjacent surfaces, which footprints may not cross (adjacent/adjacent_surface.h).
constexpr double k_corner_angle = 40.0 * std::numbers::pi / 180.0;

/// Edges of the boundary, classified by the patches on both sides.
class Corners {
 public:
  Corners(const TriMesh& boundary, const Column<PatchId, std::uint8_t>& has_layer, const RunContext& context)
      : boundary_(boundary), has_layer_(has_layer), topology_(boundary, context), is_on_border_(boundary.n_vertices(), 0) {
    for_each_edge([&](HalfedgeId h, TriangleId t, TriangleId beyond) {
      if (is_layered(t) == is_layered(beyond)) return;
      is_on_border_[topology_.from(h)] = is_on_border_[topology_.to(h)] = 1;
    });
  }

  /// Returns 1 for patches without layers that have a sharp edge at a layer boundary, or at an edge shared with another patch on which layers end. The latter
  /// edge is divided again along its whole length.
  std::vector<std::uint8_t> patches_with_corners() const {
    std::vector<std::uint8_t> has_corner(boundary_.patches.size(), 0);
    const Column<VertexId, std::uint8_t> is_shared = vertices_between_ends();
    for_each_edge([&](HalfedgeId h, TriangleId t, TriangleId beyond) {
      const PatchId patch = boundary_.triangle_patch[t];
      if (is_layered(t) || patch != boundary_.triangle_patch[beyond] || !is_sharp(t, beyond)) return;
      for (const VertexId v : {topology_.from(h), topology_.to(h)})
        if (is_on_border_[v] || is_shared[v]) has_corner[patch.index()] = 1;
    });
    return has_corner;
  }

  /// Returns for each triangle of such patches the lowest triangle of the smooth part of the patch that contains it.
  std::vector<std::uint32_t> smooth_parts(const std::vector<std::uint8_t>& patches) const {
    DisjointSets parts(boundary_.n_triangles());
    for_each_edge([&](HalfedgeId, TriangleId t, TriangleId beyond) {
      const PatchId patch = boundary_.triangle_patch[t];
      if (patches[patch.index()] && patch == boundary_.triangle_patch[beyond] && !is_sharp(t, beyond)) parts.join(t.value(), beyond.value());
    });
    return std::move(parts).roots();
  }

  /// Returns for each part, stored at its lowest triangle, 1 if a layer ends on the part along an edge.
  std::vector<std::uint8_t> parts_with_borders(const std::vector<std::uint32_t>& parts) const {
    std::vector<std::uint8_t> has_border(boundary_.n_triangles(), 0);
    for_each_edge([&](HalfedgeId, TriangleId t, TriangleId beyond) {
      if (!is_layered(t) && is_layered(beyond)) has_border[parts[t.index()]] = 1;
    });
    return has_border;
  }

 private:
  /// Returns for each vertex 1 if two patches on which layers end share an edge at the vertex.
  Column<VertexId, std::uint8_t> vertices_between_ends() const {
    std::vector<std::uint8_t> is_end(boundary_.patches.size(), 0);
    for_each_edge([&](HalfedgeId, TriangleId t, TriangleId beyond) {
      if (!is_layered(t) && is_layered(beyond)) is_end[boundary_.triangle_patch[t].index()] = 1;
    });
    Column<VertexId, std::uint8_t> is_shared(boundary_.n_vertices(), 0);
    for_each_edge([&](HalfedgeId h, TriangleId t, TriangleId beyond) {
      const PatchId patch = boundary_.triangle_patch[t], other = boundary_.triangle_patch[beyond];
      if (patch != other && is_end[patch.index()] && is_end[other.index()]) is_shared[topology_.from(h)] = is_shared[topology_.to(h)] = 1;
    });
    return is_shared;
  }
  bool is_layered(TriangleId t) const { return has_layer_[boundary_.triangle_patch[t]] != 0; }
  bool is_sharp(TriangleId t, TriangleId beyond) const {
    const auto normal = [&](TriangleId of) {
      const auto [a, b, c] = corners(boundary_, of);
      return normalized(area_vector(a, b, c));
    };
    return dot(normal(t), normal(beyond)) < std::cos(k_corner_angle);
  }
  template <class F>
  void for_each_edge(const F& f) const {
    for (std::size_t i = 0; i < topology_.n_halfedges(); ++i)
      if (const HalfedgeId h(i); !topology_.is_boundary(h)) f(h, triangle_of(h), triangle_of(topology_.twin(h)));
  }

  const TriMesh& boundary_;
  const Column<PatchId, std::uint8_t>& has_layer_;
  Topology topology_;
  Column<VertexId, std::uint8_t> is_on_border_;
};

}  // namespace

void split_at_corners(TriMesh& boundary, Column<PatchId, std::uint8_t>& has_layer, const RunContext& context) {
  const Corners corners_of(boundary, has_layer, context);
  const std::vector<std::uint8_t> is_split = corners_of.patches_with_corners();
  if (std::ranges::find(is_split, 1) == is_split.end()) return;
  const std::vector<std::uint32_t> part = corners_of.smooth_parts(is_split);
  const std::vector<std::uint8_t> has_border = corners_of.parts_with_borders(part);
  std::map<std::uint32_t, PatchId> own;  // the key is the lowest triangle of the part
  for (const TriangleId t : boundary.triangles.ids()) {
    const PatchId patch = boundary.triangle_patch[t];
    const std::uint32_t root = part[t.index()];
    if (patch.index() >= is_split.size() || !is_split[patch.index()] || !has_border[root]) continue;
    const auto [found, is_new] = own.emplace(root, PatchId());
    if (is_new) {
      found->second = boundary.patches.push_back(Patch(boundary.patches[patch]));
      has_layer.push_back(0);
    }
  }
  for (const TriangleId t : boundary.triangles.ids()) {
    if (const auto found = own.find(part[t.index()]); found != own.end()) boundary.triangle_patch[t] = found->second;
  }
}

}  // namespace sterna::volmesh
