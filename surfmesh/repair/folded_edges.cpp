#include "surfmesh/repair/folded_edges.h"

#include "geom/base/run_context.h"
#include "geom/math/measures.h"
#include "geom/mesh/topology.h"

namespace sterna::surfmesh {

std::int64_t count_folded_edges(const TriMesh& mesh) {
  const Topology topology(mesh, RunContext());
  std::int64_t n = 0;
  for (std::size_t i = 0; i < topology.n_halfedges(); ++i) {
    const HalfedgeId h(i), o = topology.twin(h);
    if (!o.is_valid() || o < h) continue;
    // Directions from the edge to the two apexes, in projection along the edge.
    const Point &a = mesh.points[topology.from(h)], &b = mesh.points[topology.to(h)];
    const Vec3 along = normalized(b - a);
    const auto across = [&](HalfedgeId e) {
      const Vec3 to_apex = mesh.points[topology.from(previous(e))] - a;
      return to_apex - dot(to_apex, along) * along;
    };
    if (angle_between(across(h), across(o)) < k_folded_angle) ++n;
  }
  return n;
}

}  // namespace sterna::surfmesh
