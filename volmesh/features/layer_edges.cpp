// Edges at which layers end on other patches.
#include <algorithm>
#include <span>

#include "volmesh/case/ignored_requests.h"
#include "volmesh/features/domain_feature.h"

namespace sterna::volmesh {
namespace {

/// Applies the user's edge lengths of planes to the adjacent patches in these planes.
void limit_edges(std::span<const AddedPlane> planes, Domain& domain) {
  for (AdjacentPatch& end : domain.adjacent)
    for (const TriangleId t : domain.outer.triangles.ids()) {
      if (domain.outer.triangle_patch[t] != end.patch) continue;
      for (const AddedPlane& plane : planes)
        if (std::ranges::all_of(corners(domain.outer, t), [&](const Point& p) { return p[plane.axis] == plane.at; })) end.max_edge = plane.edge;
      break;
    }
}

class LayerEdges final : public DomainFeature {
 public:
  void extend(const DomainTask& task, const FluidBoundary& boundary, Domain& domain) override {
    limit_edges(boundary.planes, domain);
    if (task.given_ends && task.closed.empty() && boundary.planes.empty() && domain.adjacent.empty() && domain.wall_discs.empty())
      warn_of_unused_end_options(*task.given_ends, task.context);
  }

  DomainNeeds needs(const Domain& domain) const override {
    const bool has_edges = !domain.border.empty();
    return {.keeps_boundary = has_edges, .remeshes_outer = has_edges};
  }
};

}  // namespace

std::shared_ptr<DomainFeature> layer_edges(const MeshCase& /*options*/) { return std::make_shared<LayerEdges>(); }

}  // namespace sterna::volmesh
