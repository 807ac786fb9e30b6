// Periodic sides as a feature of a domain.
#include <utility>

#include "volmesh/features/domain_feature.h"

namespace sterna::volmesh {
namespace {

class PeriodicJoints final : public DomainFeature {
 public:
  void prepare(const DomainTask& task, FluidBoundary& boundary) override {
    JoinedSides joined = join_periodic_sides(boundary.mesh, task.options.periodic, task.context);
    boundary.periodic = std::move(joined.pairs);
    sources_ = std::move(joined.sources);
  }

  void trace(FluidBoundary& /*boundary*/, Domain& domain) override {
    if (sources_.empty()) return;
    for (TriangleId& t : domain.wall2surface) t = sources_[t];
    sources_ = {};
  }

  DomainNeeds needs(const Domain& /*domain*/) const override { return {.keeps_boundary = true}; }

  void label(const Domain& domain, HybridMesh& layer) const override {
    if (!layer.periodic.empty()) return;  // a stored layer knows its sides
    const std::size_t n_wall_patches = domain.wall.patches.size();
    for (const PeriodicPair& sides : domain.periodic)
      layer.periodic.push_back({PatchId(n_wall_patches + sides.first.index()), PatchId(n_wall_patches + sides.second.index()), sides.translation});
  }

 private:
  Column<TriangleId, TriangleId> sources_;  ///< from prepare() to trace()
};

}  // namespace

std::shared_ptr<DomainFeature> periodic_joints(const MeshCase& options) { return options.periodic.empty() ? nullptr : std::make_shared<PeriodicJoints>(); }

}  // namespace sterna::volmesh
