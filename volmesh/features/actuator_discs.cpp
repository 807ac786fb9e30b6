// Actuator discs as a feature of a domain: free discs, and discs that end on walls with layers.
#include <algorithm>
#include <utility>

#include "volmesh/adjacent/wall_discs.h"
#include "volmesh/domain/cut_discs.h"
#include "volmesh/domain/disc_baffles.h"
#include "volmesh/features/domain_feature.h"

namespace sterna::volmesh {
namespace {

/// Returns the discs that end on no wall.
std::vector<ActuatorDisc> free_discs(const std::vector<ActuatorDisc>& discs, const auto& on_walls) {
  std::vector<ActuatorDisc> free;
  for (std::size_t i = 0; i < discs.size(); ++i)
    if (std::ranges::none_of(on_walls, [i](const auto& of_wall) { return of_wall.disc == i; })) free.push_back(discs[i]);
  return free;
}

class ActuatorDiscs final : public DomainFeature {
 public:
  void prepare(const DomainTask& task, FluidBoundary& boundary) override {
    require_own_names(task.options.discs, boundary.mesh.patches, {});
    cuts_ = cut_discs(boundary.mesh, boundary.has_layer, task.options.discs, task.context);
  }

  void extend(const DomainTask& task, const FluidBoundary& boundary, Domain& domain) override {
    const MeshCase& options = task.options;
    domain.outer = with_discs(std::move(domain.outer), domain.wall, free_discs(options.discs, cuts_.discs), options.size.size_growth, task.context);
    if (!domain.links.empty()) {  // free discs share no vertices with the wall
      domain.links.line.resize(domain.outer.n_vertices());
      domain.links.surface.resize(domain.outer.n_triangles(), -1);
    }
    add_wall_discs(boundary.mesh, cuts_, options.discs, options.size.size_growth, task.context, domain);
  }

  void trace(FluidBoundary& boundary, Domain& domain) override {
    if (cuts_.sources.empty()) return;
    for (TriangleId& t : domain.wall2surface) t = cuts_.sources[t];
    boundary.slivers.weights = {};  // of the parts of a triangle they are not known
    cuts_ = {};
  }

  DomainNeeds needs(const Domain& domain) const override {
    const bool is_cut = !domain.wall_discs.empty();
    return {.keeps_boundary = true, .remeshes_outer = is_cut, .has_own_wall = is_cut, .traits = {.has_baffles = true}};
  }

  void add_boundary(const LayerTask& task, ClosedOuter& outer) const override {
    const auto& [options, domain, base, envelope, context] = task;
    outer.mesh = with_second_sides(std::move(outer.mesh), free_discs(options.discs, domain.wall_discs));
    outer.line.resize(outer.mesh.n_vertices());
    close_wall_discs(domain, base, envelope, options.discs, {options.size.size_growth, options.ends, end_sizes(options)}, context, outer);
  }

  void cut_columns(const Domain& domain, LayerBlock& layers, std::vector<Point>& points) const override { open_wall_discs(domain, layers, points); }

  void label(const Domain& domain, HybridMesh& layer) const override { open_wall_discs(domain, layer.request); }

 private:
  DiscCuts cuts_;  ///< from prepare() to trace()
};

}  // namespace

std::shared_ptr<DomainFeature> actuator_discs(const MeshCase& options) { return options.discs.empty() ? nullptr : std::make_shared<ActuatorDiscs>(); }

}  // namespace sterna::volmesh
