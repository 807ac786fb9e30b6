// The features, their list, and the combinations that are not permitted.
#include <algorithm>
#include <array>
#include <span>
#include <string>
#include <utility>

#include "geom/base/error.h"
#include "volmesh/adjacent/wall_discs.h"
#include "volmesh/case/ignored_requests.h"
#include "volmesh/domain/cut_discs.h"
#include "volmesh/domain/disc_baffles.h"
#include "volmesh/domain/open_ridges.h"
#include "volmesh/domain/sheeted_boundary.h"
#include "volmesh/envelope/patch_layers.h"
#include "volmesh/features/domain_feature.h"
#include "volmesh/layer/close_multi_normals.h"
#include "volmesh/layer/close_wakes.h"

namespace sterna::volmesh {
namespace {

/// Sliver triangles of the wall, which are split before all other changes of the boundary.
class SliverSplitting final : public DomainFeature {
 public:
  static bool is_requested(const MeshCase& /*options*/) { return true; }

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

/// Wake sheets.
class WakeSheets final : public DomainFeature {
 public:
  static bool is_requested(const MeshCase& options) { return !options.wakes.empty(); }

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

/// Returns the discs that end on no wall.
std::vector<ActuatorDisc> free_discs(const std::vector<ActuatorDisc>& discs, const auto& on_walls) {
  std::vector<ActuatorDisc> free;
  for (std::size_t i = 0; i < discs.size(); ++i)
    if (std::ranges::none_of(on_walls, [i](const auto& of_wall) { return of_wall.disc == i; })) free.push_back(discs[i]);
  return free;
}

/// Actuator discs: free discs, and discs that end on walls with layers.
class ActuatorDiscs final : public DomainFeature {
 public:
  static bool is_requested(const MeshCase& options) { return !options.discs.empty(); }

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

/// Periodic sides, joined when no other feature changes them any more.
class PeriodicJoints final : public DomainFeature {
 public:
  static bool is_requested(const MeshCase& options) { return !options.periodic.empty(); }

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

/// Edges at which layers end on other patches.
class LayerEdges final : public DomainFeature {
 public:
  static bool is_requested(const MeshCase& /*options*/) { return true; }

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

/// Opened ridges with their multi-normal fans, on the complete wall.
class RidgeFans final : public DomainFeature {
 public:
  static bool is_requested(const MeshCase& options) { return opens_ridges(options); }

  void extend(const DomainTask& task, const FluidBoundary& /*boundary*/, Domain& domain) override {
    const MeshCase& options = task.options;
    if (domain.wall_discs.empty())
      open_ridges(options.ridges, patches_with_open_ridges(domain.wall.patches, options.ridges, options.patches), least_first_height(options), task.closed,
                  domain, task.context);
    else task.context.warn("ridges stay closed: an actuator disc ends on the wall");
  }

  DomainNeeds needs(const Domain& domain) const override {
    const bool is_opened = !domain.ridges.is_empty();
    return {.keeps_boundary = is_opened, .has_own_wall = is_opened, .converts_cells = is_opened};
  }

  void finish(const Domain& domain, HybridMesh& layer, FillBoundary& boundary) const override { close_multi_normals(domain.ridges, layer, boundary); }
};

using Features = std::vector<std::shared_ptr<DomainFeature>>;

template <class Feature>
void add_feature(const MeshCase& options, Features& features) {
  if (Feature::is_requested(options)) features.push_back(std::make_shared<Feature>());
}

/// All features in their order.
constexpr std::array k_features = {add_feature<SliverSplitting>, add_feature<WakeSheets>, add_feature<ActuatorDiscs>,
                                   add_feature<PeriodicJoints>,  add_feature<LayerEdges>, add_feature<RidgeFans>};

/// Checks that wake sheets are not combined with incompatible options.
void require_no_others(const MeshCase& options) {
  if (options.wakes.empty()) return;
  const auto refuse = [](std::string what, std::string hint) { throw_bad_argument("making wake sheets", std::move(what), {}, std::move(hint)); };
  if (opens_ridges(options))
    refuse("wake sheets cannot be combined with several normals at ridges (open_ridges)", "leave wakes out, or set open_ridges = \"never\"");
  if (!options.discs.empty()) refuse("wake sheets cannot be combined with actuator discs", "leave the wakes or the discs out");
}

/// Checks the rules for exactly these patches. A rule for "*" is ignored, because it is meant for other patches.
void require_no_layers_on_periodic_sides(const MeshCase& options) {
  for (const Rule& rule : options.patches)
    for (const PeriodicNames& pair : options.periodic)
      if ((rule.names == pair.first || rule.names == pair.second) && (value_or(rule, "layers", 0) > 0 || value_or(rule, "kind", std::string()) == "wall"))
        throw_bad_argument("making \"" + pair.first + "\" and \"" + pair.second + "\" periodic",
                           "patches requests kind wall or layers on \"" + rule.names + "\"", {},
                           "periodic sides carry no layers: leave out the rule or the periodic pair");
}

}  // namespace

std::vector<std::shared_ptr<DomainFeature>> domain_features(const MeshCase& options) {
  Features features;
  for (const auto add : k_features) add(options, features);
  return features;
}

void require_compatible(const MeshCase& options) {
  require_no_others(options);
  require_no_layers_on_periodic_sides(options);
}

}  // namespace sterna::volmesh
