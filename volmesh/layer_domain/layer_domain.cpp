#include "volmesh/layer_domain/layer_domain.h"

#include <algorithm>
#include <cstdint>
#include <iterator>
#include <memory>
#include <ranges>
#include <utility>

#include "geom/base/error.h"
#include "geom/base/glob.h"
#include "geom/base/number_text.h"
#include "geom/math/measures.h"
#include "volmesh/case/body_wake.h"
#include "volmesh/case/ignored_requests.h"
#include "volmesh/case/layer_choice.h"
#include "volmesh/domain/split_corners.h"
#include "volmesh/envelope/automatic_layers.h"
#include "volmesh/envelope/certificate.h"
#include "volmesh/envelope/feature_angle.h"
#include "volmesh/envelope/patch_layers.h"
#include "volmesh/envelope/periodic_growth.h"
#include "volmesh/envelope/sheet_heights.h"
#include "volmesh/envelope/unused_blends.h"
#include "volmesh/features/domain_feature.h"

namespace sterna::volmesh {
namespace {

constexpr std::size_t k_named_patches = 3;  ///< largest number of patches of a cavity that a message names

/// Checks a boundary without layers. It is meant for inviscid flow, in which walls have no layers. \throws if layers are requested but there is no wall
void require_no_layers(const TriMesh& boundary, const MeshCase& options, const RunContext& context) {
  const bool has_walls = std::ranges::any_of(boundary.patches, [](const Patch& patch) { return patch.kind == PatchKind::wall; });
  if (options.envelope.layers > 0 && !has_walls)
    throw Error({.code = ErrorCode::empty_surface,
                 .attempted = "volume_mesh",
                 .problem = "no patch carries a layer: none is of kind wall",
                 .hint = "give a patch the kind wall, or set layers = 0 for a mesh of tetrahedra only"});
  const std::string text = "no patch carries layers: the mesh has only tetrahedra, for inviscid flow (Euler)";
  if (options.envelope.layers == 0) context.info(text);
  else context.warn(text + "; layers = " + std::to_string(options.envelope.layers) + " has no effect, because the rules of all patches set layers = 0");
}

void warn_of_cavities(const Domain& domain, const RunContext& context) {
  std::size_t n_reported = 0;
  for (const Domain::Cavity& cavity : domain.cavities) {
    if (n_reported++ == k_max_locations) break;
    std::string names;
    for (std::size_t i = 0; i < std::min(cavity.patches.size(), k_named_patches); ++i) names += (i == 0 ? "\"" : ", \"") + cavity.patches[i] + "\"";
    context.warn("the inside of " + names + (cavity.patches.size() > k_named_patches ? " and other patches" : "") + " is a sealed cavity of " +
                 number_text(cavity.volume, 3) + " m^3 about " + format_point(cavity.box.center()) + ", " + in_metres(cavity.box.longest_side(), 3) +
                 " long: the cavity is meshed, but no flow reaches it. Leave its faces out of the surface, or open the cavity where the flow should enter");
  }
  if (!domain.cavities.empty()) context.warn("the fluid consists of " + std::to_string(domain.cavities.size() + 1) + " regions that are not connected");
}

/// Returns the surface with the kinds of the rules for its own patches. The other rules are for added patches.
TriMesh with_own_kinds(const TriMesh& surface, const MeshCase& options) {
  TriMesh given = surface;
  std::vector<Rule> of_given;
  std::ranges::copy_if(options.patches, std::back_inserter(of_given), [&](const Rule& rule) {
    return std::ranges::any_of(given.patches, [&](const Patch& patch) { return matches_glob(patch.name, rule.names); });
  });
  apply_patch_kinds(given, of_given);
  return given;
}

Domain make_domain(const TriMesh& surface, const DomainTask& task) {
  const auto& [options, closed, given_ends, context] = task;
  const StageTimer timer(context, "domain");
  FluidBoundary boundary = completed_boundary(with_own_kinds(surface, options), options, context);
  require_used_requests(boundary.mesh.patches, boundary.has_layer, options, context);
  if (closed.empty()) warn_of_sources_outside(boundary.mesh, options, context);  // in repeated rounds the warning was already given
  const std::vector<std::shared_ptr<DomainFeature>> features = domain_features(options);
  for (const auto& feature : features) feature->prepare(task, boundary);
  split_at_corners(boundary.mesh, boundary.has_layer, context);
  Domain domain = split_domain(boundary.mesh, boundary.has_layer, context, boundary.periodic);
  warn_of_cavities(domain, context);
  if (domain.wall.n_triangles() == 0) require_no_layers(boundary.mesh, options, context);
  for (const auto& feature : features) feature->extend(task, boundary, domain);
  for (const auto& feature : features | std::views::reverse) feature->trace(boundary, domain);
  for (const auto& feature : features) domain.needs.add(feature->needs(domain));
  domain.features.assign(features.begin(), features.end());
  return domain;
}

}  // namespace

MeshCase validated(const TriMesh& wall, MeshCase options, const RunContext& context) {
  require_options(required_options_of(options), "volume_mesh");
  if (wall.n_triangles() == 0) throw Error({.code = ErrorCode::empty_surface, .attempted = "volume_mesh", .problem = "the wall has no triangles"});
  require_compatible(options);
  return with_automatic_layers(wall, effective_options(with_family_wake(wall, std::move(options), context), context), context);
}

Domain domain_around(const TriMesh& surface, const MeshCase& options, const RunContext& context, std::span<const VertexId> closed) {
  return make_domain(surface, {options, closed, nullptr, context});
}

LayerBase base_of(const Domain& domain, const MeshCase& options, const RunContext& context) {
  LayerBase base(domain.wall, context, domain.constraints, &domain.ridges);
  if (domain.wall.n_triangles() == 0) base.body_length = body_length(domain.bodies.n_triangles() > 0 ? domain.bodies : domain.outer);
  base.let_grow_alike(domain.partners);
  base.sheet_borders = domain.sheets.borders;
  for (const DoubledSheets::BaseVertex& base_vertex : domain.sheets.base_vertices)
    if (!base_vertex.is_on_base) base.level.push_back(base_vertex.sides);
  base.demand = demand_of(base, options.envelope, options.patches, options.first_heights.get(), context);
  base.truncation = truncation_by_patches(domain.wall, options.prisms, options.patches);
  grow_sheet_heights(domain.sheets, options.envelope, base);
  return base;
}

LayerDomain::LayerDomain(const TriMesh& surface, const MeshCase& user_options, const RunContext& context, std::span<const VertexId> closed)
    : options(validated(surface, user_options, context)),
      given_envelope(options.envelope),
      domain(make_domain(surface, {options, closed, &user_options.ends, context})),
      base([&] {
        const StageTimer timer(context, "topology");
        LayerBase of_domain = base_of(domain, options, context);
        if (closed.empty()) warn_of_unused_blends(of_domain, options.envelope, options.patches, options.first_heights.get(), context);
        return of_domain;
      }()),
      collider([&] {
        options.envelope.feature_angle = decide_feature_angle(base, options.envelope, options.smooth_angle, context);
        const StageTimer timer(context, "preflight");
        Collider of_wall(base, &domain.outer, context, &domain.links);
        require_clear_input(of_wall, context);
        return of_wall;
      }()) {}

}  // namespace sterna::volmesh
