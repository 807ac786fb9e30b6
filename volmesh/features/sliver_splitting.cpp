// Sliver triangles of the wall, which are split before all other changes of the boundary.
#include "volmesh/features/domain_feature.h"

namespace sterna::volmesh {
namespace {

class SliverSplitting final : public DomainFeature {
 public:
  void prepare(const DomainTask& task, FluidBoundary& boundary) override {
    boundary.slivers = split_slivers(boundary.mesh, boundary.has_layer, task.options.needles, task.context);
  }

  void trace(FluidBoundary& boundary, Domain& domain) override {
    const SliverSplits& slivers = boundary.slivers;
    domain.slivers = slivers.report;
    if (slivers.sources.empty()) return;
    if (!slivers.weights.empty())
      for (const TriangleId t : domain.wall2surface) domain.wall_weights.push_back(slivers.weights[t]);
    for (TriangleId& t : domain.wall2surface) t = slivers.sources[t];
  }
};

}  // namespace

std::shared_ptr<DomainFeature> sliver_splitting(const MeshCase& /*options*/) { return std::make_shared<SliverSplitting>(); }

}  // namespace sterna::volmesh
