// Wake sheets as a feature of a domain.
#include <utility>

#include "volmesh/domain/sheeted_boundary.h"
#include "volmesh/features/domain_feature.h"
#include "volmesh/layer/close_wakes.h"

namespace sterna::volmesh {
namespace {

class WakeSheets final : public DomainFeature {
 public:
  void prepare(const DomainTask& task, FluidBoundary& boundary) override {
    const auto& [options, closed, given_ends, context] = task;
    context.warn(
        "wake sheets are experimental: at their sides, beside wing tips, cells fail gates that pass without sheets; compare the gate results with those of a "
        "mesh without wakes");
    const std::vector<PeriodicPatches> sides = move_onto_images(boundary.mesh, options.periodic, context);
    const auto complete_again = [&](const TriMesh& with_sheets) {
      FluidBoundary again = completed_boundary(with_sheets, task.options, task.context);
      boundary.planes = std::move(again.planes);
      return std::move(again.mesh);
    };
    sheeted_ = with_wake_sheets(boundary.mesh, boundary.n_given, boundary.slivers, sides, options.wakes, least_first_height(options), complete_again, context);
    apply_patch_kinds(sheeted_.boundary, options.patches);
    boundary.mesh = sheeted_.boundary;
    boundary.has_layer = patches_with_layers(boundary.mesh, options, context);
    boundary.slivers = sheeted_.slivers;
  }

  void trace(FluidBoundary& /*boundary*/, Domain& domain) override {
    hold_sheets(sheeted_, domain);
    sheeted_ = {};  // a large mesh that is no longer needed
  }

  DomainNeeds needs(const Domain& /*domain*/) const override {
    return {.keeps_boundary = true, .has_own_wall = true, .converts_cells = true, .traits = {.has_wakes = true}};
  }

  void finish(const Domain& domain, HybridMesh& layer, FillBoundary& boundary) const override { close_wakes(domain.sheets, layer, boundary); }

 private:
  SheetedBoundary sheeted_;  ///< from prepare() to trace()
};

}  // namespace

std::shared_ptr<DomainFeature> wake_sheets(const MeshCase& options) { return options.wakes.empty() ? nullptr : std::make_shared<WakeSheets>(); }

}  // namespace sterna::volmesh
