// Opened ridges with their multi-normal fans as a feature of a domain.
#include "volmesh/domain/open_ridges.h"
#include "volmesh/envelope/patch_layers.h"
#include "volmesh/features/domain_feature.h"
#include "volmesh/layer/close_multi_normals.h"

namespace sterna::volmesh {
namespace {

class RidgeFans final : public DomainFeature {
 public:
  void extend(const DomainTask& task, const FluidBoundary& /*boundary*/, Domain& domain) override {
    const MeshCase& options = task.options;
    if (domain.wall_discs.empty())
      open_ridges(options.ridges, patches_with_open_ridges(domain.wall.patches, options.ridges.is_on(), options.patches), least_first_height(options),
                  task.closed, domain, task.context);
    else task.context.warn("ridges stay closed: an actuator disc ends on the wall");
  }

  DomainNeeds needs(const Domain& domain) const override {
    const bool is_opened = !domain.ridges.is_empty();
    return {.keeps_boundary = is_opened, .has_own_wall = is_opened, .converts_cells = is_opened};
  }

  void finish(const Domain& domain, HybridMesh& layer, FillBoundary& boundary) const override { close_multi_normals(domain.ridges, layer, boundary); }
};

}  // namespace

std::shared_ptr<DomainFeature> ridge_fans(const MeshCase& options) { return opens_ridges(options) ? std::make_shared<RidgeFans>() : nullptr; }

}  // namespace sterna::volmesh
