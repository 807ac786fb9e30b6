#include "volmesh/layer_domain/layer_domain.h"

#include <algorithm>
#include <cstdint>
#include <iterator>
#include <utility>

#include "geom/base/error.h"
#include "geom/base/glob.h"
#include "geom/base/number_text.h"
#include "geom/math/measures.h"
#include "volmesh/adjacent/bare_planes.h"
#include "volmesh/adjacent/wall_discs.h"
#include "volmesh/case/body_wake.h"
#include "volmesh/case/ignored_requests.h"
#include "volmesh/case/layer_choice.h"
#include "volmesh/domain/complete_boundary.h"
#include "volmesh/domain/cut_discs.h"
#include "volmesh/domain/disc_baffles.h"
#include "volmesh/domain/open_borders.h"
#include "volmesh/domain/open_ridges.h"
#include "volmesh/domain/periodic_sides.h"
#include "volmesh/domain/sheeted_boundary.h"
#include "volmesh/domain/split_corners.h"
#include "volmesh/domain/split_slivers.h"
#include "volmesh/envelope/automatic_layers.h"
#include "volmesh/envelope/certificate.h"
#include "volmesh/envelope/feature_angle.h"
#include "volmesh/envelope/patch_layers.h"
#include "volmesh/envelope/periodic_growth.h"
#include "volmesh/envelope/sheet_heights.h"
#include "volmesh/envelope/unused_blends.h"

namespace sterna::volmesh {
namespace {

constexpr std::size_t k_named_patches = 3;  ///< largest number of patches of a cavity that a message names

bool opens_ridges(const MeshCase& options) {
  return options.ridges.is_on() ||
         std::ranges::any_of(options.patches, [](const Rule& rule) { return value_or(rule, "open_ridges", std::string()) == "always"; });
}

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

MeshCase validated(const TriMesh& wall, MeshCase options, const RunContext& context) {
  require_options(required_options_of(options), "volume_mesh");
  if (wall.n_triangles() == 0) throw Error({.code = ErrorCode::empty_surface, .attempted = "volume_mesh", .problem = "the wall has no triangles"});
  require_no_others(options);
  require_no_layers_on_periodic_sides(options);
  return with_automatic_layers(wall, effective_options(with_family_wake(wall, std::move(options), context), context), context);
}

std::function<double(const Point&)> end_sizes(Borrowed<const MeshCase> borrowed) {
  const MeshCase& options = borrowed;
  const bool has_max = !is_automatic(options.size.size_max);
  if (options.sources.empty() && !has_max) return {};
  return [&options, has_max](const Point& p) {
    const double slope = options.size.size_growth - 1.0;
    double h = has_max ? options.size.size_max : 1e300;
    for (const SizeSource& source : options.sources) {
      h = std::min(h, size_of(source, p, slope));
      for (std::size_t i = 0; i < source.points.size(); ++i) h = std::min(h, source.sizes[i] + slope * distance(source.points[i], p));
    }
    return h;
  };
}

std::vector<ActuatorDisc> free_discs(const std::vector<ActuatorDisc>& discs, const std::vector<std::size_t>& on_walls) {
  std::vector<ActuatorDisc> free;
  for (std::size_t i = 0; i < discs.size(); ++i)
    if (std::ranges::find(on_walls, i) == on_walls.end()) free.push_back(discs[i]);
  return free;
}

namespace {

/// Returns the smallest first height of all walls in metres.
double least_first_height(const MeshCase& options) {
  double least = options.envelope.first_height;
  for (const Rule& rule : options.patches)
    if (const double own = value_or(rule, "first_height", k_automatic); !is_automatic(own)) least = is_automatic(least) ? own : std::min(least, own);
  return least;
}

/// Gives the layer of the walls to inflow and outflow patches beyond outer edges of walls (such as a nozzle at the end of its nacelle), unless a rule sets
/// layers = 0 for them. No layer can end at such edges. Cells around layer boundary vertices without a layer made the flow of an airliner diverge
/// (docs/measurements/solvers.md).
void continue_beyond_open_borders(const TriMesh& boundary, const MeshCase& options, const RunContext& context, Column<PatchId, std::uint8_t>& has_layer) {
  for (const PatchId p : flow_patches_beyond_open_borders(boundary, has_layer, context)) {
    const Patch& patch = boundary.patches[p];
    const EnvelopeOptions requested = request_of({patch.name, PatchKind::wall}, options.envelope, options.patches);
    if (!carries_layers(requested) || (is_automatic(requested.first_height) && !options.first_heights)) continue;
    has_layer[p] = 1;
    context.info("the layer of the walls continues over the " + std::string(to_string(patch.kind)) + " patch \"" + patch.name +
                 "\", which begins at an outer edge of a wall, where no layer can end; patches = { [\"" + patch.name +
                 "\"] = { layers = 0 } } ends the layer with zero height at that edge");
  }
}

Column<PatchId, std::uint8_t> patches_with_layers(const TriMesh& boundary, const MeshCase& options, const RunContext& context) {
  const Column<PatchId, EnvelopeOptions> layers = layers_of_patches(boundary.patches, options.envelope, options.patches);
  Column<PatchId, std::uint8_t> has_layer(boundary.patches.size(), 0);
  // Files of triangles contain no patch kinds, so all their patches are walls, except periodic sides.
  const auto is_periodic = [&](const std::string& name) {
    return std::ranges::any_of(options.periodic, [&](const PeriodicNames& pair) { return pair.first == name || pair.second == name; });
  };
  for (const PatchId p : layers.ids()) has_layer[p] = carries_layers(layers[p]) && !is_periodic(boundary.patches[p].name) ? 1 : 0;
  continue_beyond_open_borders(boundary, options, context, has_layer);
  return has_layer;
}

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

/// The closed boundary of the fluid with the kinds of its patches. Added planes on which no layers end have separate vertices.
struct WholeBoundary {
  TriMesh mesh;
  Column<PatchId, std::uint8_t> has_layer;
  std::vector<AddedPlane> planes;
};

WholeBoundary completed(const TriMesh& given, const MeshCase& options, const RunContext& context) {
  WholeBoundary whole;
  whole.mesh = complete_boundary(given, {options.farfield, options.farfield_surface, options.periodic}, context, &whole.planes);
  apply_patch_kinds(whole.mesh, options.patches);
  whole.has_layer = patches_with_layers(whole.mesh, options, context);
  mesh_bare_planes(whole.planes, given.n_triangles(), whole.has_layer, {options.ends, end_sizes(options)}, whole.mesh, context);
  return whole;
}

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

/// \param given_options options as the user gave them, for a warning if no patch is triangulated with them; null: no warning
Domain make_domain(const TriMesh& surface, const MeshCase& options, const RunContext& context, std::span<const VertexId> closed,
                   const EndOptions* given_options) {
  const StageTimer timer(context, "domain");
  TriMesh given = surface;
  std::vector<Rule> of_given;  // rules for patches of the user; the other rules are for added patches
  std::ranges::copy_if(options.patches, std::back_inserter(of_given), [&](const Rule& rule) {
    return std::ranges::any_of(given.patches, [&](const Patch& patch) { return matches_glob(patch.name, rule.names); });
  });
  apply_patch_kinds(given, of_given);
  WholeBoundary whole = completed(given, options, context);
  TriMesh& boundary = whole.mesh;
  Column<PatchId, std::uint8_t>& has_layer = whole.has_layer;
  require_used_requests(boundary.patches, has_layer, options, context);
  if (closed.empty()) warn_of_sources_outside(boundary, options, context);  // in repeated rounds the warning was already given
  SliverSplits slivers = split_slivers(boundary, has_layer, options.needles, context);
  SheetedBoundary sheeted;
  if (!options.wakes.empty()) {
    context.warn(
        "wake sheets are experimental: at their sides, beside wing tips, cells fail gates that pass without sheets; compare the gate results with those of a "
        "mesh without wakes");
    const std::vector<PeriodicPatches> sides = move_onto_images(boundary, options.periodic, context);
    const auto complete_again = [&](const TriMesh& with_sheets) {
      WholeBoundary again = completed(with_sheets, options, context);
      whole.planes = std::move(again.planes);
      return std::move(again.mesh);
    };
    sheeted = with_wake_sheets(boundary, given.n_triangles(), slivers, sides, options.wakes, least_first_height(options), complete_again, context);
    apply_patch_kinds(sheeted.boundary, options.patches);
    boundary = sheeted.boundary;
    has_layer = patches_with_layers(boundary, options, context);
    slivers = sheeted.slivers;
  }
  require_own_names(options.discs, boundary.patches, {});
  const DiscCuts cuts = cut_discs(boundary, has_layer, options.discs, context);
  const JoinedSides periodic = join_periodic_sides(boundary, options.periodic, context);
  split_at_corners(boundary, has_layer, context);
  Domain domain = split_domain(boundary, has_layer, context, periodic.pairs);
  limit_edges(whole.planes, domain);
  warn_of_cavities(domain, context);
  if (domain.wall.n_triangles() == 0) require_no_layers(boundary, options, context);
  std::vector<std::size_t> on_walls;
  for (const CutDisc& cut : cuts.discs) on_walls.push_back(cut.disc);
  domain.outer = with_discs(std::move(domain.outer), domain.wall, free_discs(options.discs, on_walls), options.size.size_growth, context);
  if (!domain.links.empty()) {  // free discs share no vertices with the wall
    domain.links.line.resize(domain.outer.n_vertices());
    domain.links.surface.resize(domain.outer.n_triangles(), -1);
  }
  add_wall_discs(boundary, cuts, options.discs, options.size.size_growth, context, domain);
  if (given_options && closed.empty() && whole.planes.empty() && domain.adjacent.empty() && domain.wall_discs.empty())
    warn_of_unused_end_options(*given_options, context);
  if (!periodic.sources.empty())
    for (TriangleId& t : domain.wall2surface) t = periodic.sources[t];
  if (!cuts.sources.empty())
    for (TriangleId& t : domain.wall2surface) t = cuts.sources[t];
  if (!options.wakes.empty()) hold_sheets(sheeted, domain);
  domain.slivers = slivers.report;
  if (!slivers.sources.empty()) {
    if (cuts.sources.empty())
      for (const TriangleId t : domain.wall2surface) domain.wall_weights.push_back(slivers.weights[t]);
    for (TriangleId& t : domain.wall2surface) t = slivers.sources[t];
  }
  if (!domain.wall_discs.empty() && opens_ridges(options)) context.warn("ridges stay closed: an actuator disc ends on the wall");
  else
    open_ridges(options.ridges, patches_with_open_ridges(domain.wall.patches, options.ridges, options.patches), least_first_height(options), closed, domain,
                context);
  return domain;
}

}  // namespace

Domain domain_around(const TriMesh& surface, const MeshCase& options, const RunContext& context, std::span<const VertexId> closed) {
  return make_domain(surface, options, context, closed, nullptr);
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
      domain(make_domain(surface, options, context, closed, &user_options.ends)),
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
