#include "volmesh/stages.h"

#include <algorithm>
#include <functional>
#include <iterator>
#include <optional>
#include <utility>

#include "geom/base/alongside.h"
#include "geom/base/error.h"
#include "geom/base/glob.h"
#include "geom/base/number_text.h"
#include "geom/math/measures.h"
#include "volmesh/case/layer_choice.h"
#include "volmesh/domain/complete_boundary.h"
#include "volmesh/domain/cut_discs.h"
#include "volmesh/envelope/build_envelope.h"
#include "volmesh/envelope/feature_angle.h"
#include "volmesh/envelope/patch_layers.h"
#include "volmesh/envelope/periodic.h"
#include "volmesh/envelope/retract.h"
#include "volmesh/envelope/untangle.h"
#include "volmesh/layer/assemble.h"
#include "volmesh/layer/extrude.h"
#include "volmesh/layer/layer_cells.h"
#include "volmesh/layer/layer_report.h"
#include "volmesh/layer/repair_envelope.h"
#include "volmesh/layer/split_layer.h"
#include "volmesh/layer/visibility_report.h"
#include "volmesh/parts/joint_envelope.h"
#include "volmesh/rims/close_ends.h"
#include "volmesh/rims/slits.h"
#include "volmesh/tetra/preflight.h"
#include "volmesh/tetra/size_supply.h"
#include "volmesh/tetra/verify.h"

namespace sterna::volmesh {
namespace {

constexpr int k_max_clear_rounds = 10;
constexpr std::size_t k_max_places = 10;
constexpr int k_max_boundary_repairs = 3;

VolumeMeshOptions sane(const TriMesh& wall, VolumeMeshOptions options, const RunContext& context) {
  require_options(required_options_of(options), "volume_mesh");
  if (wall.n_triangles() == 0) throw Error({.code = ErrorCode::empty_surface, .attempted = "volume_mesh", .problem = "the wall has no triangles"});
  return effective_options(options, context);
}

/// Edge lengths that the user's sources ask for on patches that are triangulated anew.
std::function<double(const Point&)> end_sizes(const VolumeMeshOptions& options) {
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

SlitOptions slit_options(const VolumeMeshOptions& options) { return {options.size.size_growth, options.ends, end_sizes(options)}; }

/// The discs that end on no wall.
std::vector<ActuatorDisc> free_discs(const std::vector<ActuatorDisc>& discs, const std::vector<std::size_t>& on_walls) {
  std::vector<ActuatorDisc> free;
  for (std::size_t i = 0; i < discs.size(); ++i)
    if (std::ranges::find(on_walls, i) == on_walls.end()) free.push_back(discs[i]);
  return free;
}

Domain domain_around(const TriMesh& surface, const VolumeMeshOptions& options, const RunContext& context) {
  const StageTimer timer(context, "domain");
  TriMesh given = surface;
  std::vector<PatchRule> of_given;  // the others are meant for what is added
  std::ranges::copy_if(options.patches, std::back_inserter(of_given), [&](const PatchRule& rule) {
    return std::ranges::any_of(given.patches, [&](const Patch& patch) { return matches_glob(patch.name, rule.names); });
  });
  apply_patch_kinds(given, of_given);
  TriMesh boundary = complete_boundary(given, {options.farfield, options.farfield_surface}, context);
  apply_patch_kinds(boundary, options.patches);
  const Column<PatchId, PatchLayers> layers = layers_of_patches(boundary.patches, options.envelope, options.patches);
  Column<PatchId, std::uint8_t> has_layer(boundary.patches.size(), 0);
  for (const PatchId p : layers.ids()) has_layer[p] = layers[p].carries_layers() ? 1 : 0;
  require_own_names(options.discs, boundary.patches, {});
  const DiscCuts cuts = cut_discs(boundary, has_layer, options.discs, context);
  const std::vector<PeriodicPatches> periodic = join_periodic_sides(boundary, options.periodic, context);
  Domain domain = split_domain(boundary, has_layer, context, periodic);
  if (domain.wall.n_triangles() == 0)
    throw Error({.code = ErrorCode::empty_surface,
                 .attempted = "volume_mesh",
                 .problem = "no patch carries a layer",
                 .hint = "at least one patch must be a wall with layers"});
  std::vector<std::size_t> on_walls;
  for (const CutDisc& cut : cuts.discs) on_walls.push_back(cut.disc);
  domain.outer = with_discs(std::move(domain.outer), domain.wall, free_discs(options.discs, on_walls), options.size.size_growth, context);
  if (!domain.links.empty()) {  // these discs share nothing with the wall
    domain.links.line.resize(domain.outer.n_vertices());
    domain.links.surface.resize(domain.outer.n_triangles(), -1);
  }
  add_slits(boundary, cuts, options.discs, options.size.size_growth, context, domain);
  if (!cuts.sources.empty())
    for (TriangleId& t : domain.wall2surface) t = cuts.sources[t];
  return domain;
}

/// The walls with layers, and what is asked of the layer on them.
LayerBase base_of(const Domain& domain, const VolumeMeshOptions& options, const RunContext& context) {
  LayerBase base(domain.wall, context, domain.constraints);
  base.let_grow_alike(domain.partners);
  base.demand = demand_of(base, options.envelope, options.patches, options.first_heights.get(), context);
  return base;
}

/// The user's own true surface, asked with triangles of the wall.
TrueSurface true_surface_of(const TrueSurface& of_surface, const Domain& domain) {
  if (!of_surface) return {};
  return [of_surface, &wall2surface = domain.wall2surface](const Point& p, TriangleId t, const std::array<double, 3>& weights) {
    return of_surface(p, wall2surface[t], weights);
  };
}

/// Extrusion may lower heights, and lowering may bring surfaces together that were clear before: alternate until neither changes anything. What still
/// changes after some rounds collapses, so it ends. \pre, \post envelope valid and clear.
Extrusion extrude_clear_of_collisions(const LayerBase& base, const VolumeMeshOptions& options, Collider& collider, Envelope& envelope,
                                      const RunContext& context) {
  const EnvelopeScale scale = scale_of(base, options.envelope);
  Extruder extruder(base, options.envelope, options.prisms, context);
  for (int round = 0;; ++round) {
    const EnvelopeShape before = envelope;
    extruder.extrude(envelope);
    const std::vector<VertexId> repaired = difference(before, envelope, context).vertices;
    const bool is_equal = equalise_partners(base, options.envelope, &collider, envelope, context).empty();
    if ((repaired.empty() || !retract_collisions(base, options.envelope, collider, envelope, context, &repaired)) && is_equal) return extruder.take();
    if (round < k_max_clear_rounds) continue;
    std::vector<VertexId> disturbed = difference(before, envelope, context).vertices;
    for (const VertexId v : disturbed) lower(envelope, v, 0.0, HeightLimit::prism, scale);
    unwarp(base, options.envelope, HeightLimit::prism, envelope, context, &disturbed);
    disturbed = difference(before, envelope, context).vertices;
    retract_collisions(base, options.envelope, collider, envelope, context, &disturbed);
  }
}

LayerReport report(const LayerBase& base, const EnvelopeOptions& options, const Envelope& envelope, const Extrusion& extrusion, const RunContext& context) {
  LayerReport report = report_layer(base, options, envelope, extrusion, context);
  report.feature_angle = options.feature_angle;
  report.visibility = report_visibility(base);
  return report;
}

/// What can be found out about the layer while an engine makes the tetrahedra.
struct LayerProof {
  LayerCertificate cells;
  LayerCheck check;
};

LayerProof prove_layer(const HybridMesh& mesh, const RunContext& context) {
  return {certify_layer(mesh.layers, mesh.points.raw(), context), check_ahead(mesh, {}, context)};
}

void add_cells(const LayerCertificate& cells, EnvelopeCertificate& certificate) {
  certificate.n_layer_cells = cells.n_cells;
  certificate.n_invalid_layer_cells = cells.n_cells - cells.n_proved;
  if (cells.worst_column < 0) return;
  certificate.worst_layer_cell = {cells.min_quality, cells.worst_place,
                                  "layer " + std::to_string(cells.worst_layer) + " on wall triangle " + std::to_string(cells.worst_column)};
}

/// \p is_clear: proved already; not where patches were triangulated anew.
TetraBoundary boundary_for_engines(const FillBoundary& boundary, std::span<const Point> holes, bool is_clear, SplitTaker take_splits) {
  return {boundary.points, boundary.triangles, holes, is_clear, boundary.patch_names, boundary.triangle_patch, std::move(take_splits)};
}

ClosedOuter closed_around(const MeshingSite& site, const Envelope& envelope, const RunContext& context) {
  ClosedOuter outer = close_ends(site.domain, site.base, envelope, {site.options.ends, end_sizes(site.options)}, context);
  std::vector<std::size_t> on_walls;
  for (const DiscSlit& slit : site.domain.slits) on_walls.push_back(slit.disc);
  outer.mesh = with_second_sides(std::move(outer.mesh), free_discs(site.options.discs, on_walls));
  outer.line.resize(outer.mesh.n_vertices());
  close_slits(site.domain, site.base, envelope, site.options.discs, slit_options(site.options), context, outer);
  return outer;
}

/// Carries the splits of a result to the layer; where the layer must be lower with them, the volume inside the split boundary, kept now, is filled once more.
SplitLayer take_splits(const LayerBase& base, const Envelope& envelope, const TriMesh& outer, const VolumeMeshOptions& options, TetraResult& tets,
                       const RunContext& context) {
  SplitLayer layer = split_layer(base, envelope, outer, options, tets, context);
  if (layer.is_filled) return layer;
  VolumeMeshOptions keeping = options;
  keeping.tetrahedra.boundary_splits = "never";
  const std::vector<Point> holes = find_cavity_points(*layer.wall, context);
  const TetraBoundary domain = boundary_for_engines(layer.boundary, holes, true, {});
  SizeSupply sizes(domain, options.sources, options.size, context);
  tets = fill(domain, sizes, keeping.tetrahedra, context);
  return layer;
}

/// The split layer instead of the one that it came from.
void adopt(SplitLayer split, const VolumeMeshOptions& options, FillBoundary& boundary, FilledStage& filled, LayerKnowledge& knowledge,
           const RunContext& context) {
  filled.n_split_triangles = static_cast<std::int64_t>(split.boundary.triangles.size() - boundary.triangles.size());
  context.info("boundary splits: " + std::to_string(split.boundary.points.size() - boundary.points.size()) + " new points, " +
               std::to_string(filled.n_split_triangles) + " more triangles");
  knowledge.certificate = split.certificate;
  knowledge.report = report(*split.base, options.envelope, split.envelope, split.extrusion, context);
  filled.curving_shares = split.extrusion.curving_shares;
  filled.layers = assemble_layers(*split.base, std::move(split.extrusion), unlinked(*split.outer), {});
  filled.layers.request = layer_request(*split.base, options.envelope, split.envelope);
  filled.split_wall = *split.wall;
  filled.envelope.envelope = std::move(split.envelope);
  boundary = std::move(split.boundary);
}

void require_valid(const CheckReport& report) {
  if (report.is_valid()) return;
  ErrorInfo info{.code = ErrorCode::mesh_invalid, .attempted = "checking the finished mesh", .hint = "report this surface"};
  for (const auto& [violation, count] : report.counts) {
    info.problem += (info.problem.empty() ? "" : ", ") + std::to_string(count) + " x " + std::string(to_string(violation));
    info.n_places += count;
  }
  for (const Finding& finding : report.findings) info.places.push_back({finding.position, finding.what});
  throw Error(std::move(info));
}

/// The layer under the envelope as it is now, proved and assembled. \post envelope valid and clear
FillBoundary lay_out(MeshingSite& site, Envelope& envelope, FilledStage& filled, LayerKnowledge& knowledge, const RunContext& context) {
  Extrusion extrusion;
  {
    const StageTimer timer(context, "prisms");
    extrusion = extrude_clear_of_collisions(site.base, site.options, site.collider, envelope, context);
  }
  {
    const StageTimer timer(context, "certificate");
    knowledge.certificate = certify_envelope(site.base, site.collider, envelope, context);
    require_proved(knowledge.certificate);
  }
  knowledge.report = report(site.base, site.options.envelope, envelope, extrusion, context);
  filled.curving_shares = extrusion.curving_shares;
  const ClosedOuter outer = closed_around(site, envelope, context);
  open_slits(site.domain, extrusion.layers, extrusion.points);
  FillBoundary boundary = fill_boundary(site.base, extrusion, outer);
  filled.layers = assemble_layers(site.base, std::move(extrusion), outer, layer_sides(site.domain));
  filled.layers.request = layer_request(site.base, site.options.envelope, envelope);
  open_slits(site.domain, filled.layers.request);
  const std::size_t n_wall_patches = site.base.wall.patches.size();
  for (const PeriodicEnds& sides : site.domain.periodic)
    filled.layers.periodic.push_back({PatchId(n_wall_patches + sides.first.index()), PatchId(n_wall_patches + sides.second.index()), sides.translation});
  return boundary;
}

void require_same(std::size_t found, std::size_t expected, const std::string& what) {
  if (found != expected)
    throw Error({.code = ErrorCode::bad_argument,
                 .attempted = "continuing a volume mesh",
                 .problem = "found " + std::to_string(found) + " " + what + ", expected " + std::to_string(expected),
                 .hint = "surface, envelope, layers and tetrahedra must come from one run"});
}

/// That the layer stands on the wall, and that nothing but the outer boundary is beside it.
void require_layers_on(const Domain& domain, const HybridMesh& layers) {
  const TriMesh& wall = domain.wall;
  const bool has_rims = domain.has_rims();
  require_same(layers.layers.n_lines(), wall.n_vertices() + domain.slit_vertices.size(), "lines of the layer");
  require_same(layers.layers.n_columns(), wall.n_triangles(), "columns of the layer");
  std::size_t n_wrong = 0, n_layer_nodes = 0;
  for (const TriangleId t : wall.triangles.ids())
    for (std::size_t k = 0; k < 3; ++k) n_wrong += layers.layers.base[t.index()][k] != line_under(domain, t, k) ? 1 : 0;
  for (std::uint32_t line = 0; line < layers.layers.n_lines(); ++line) {
    const VertexId under = line < wall.n_vertices() ? VertexId(line) : domain.slit_vertices[line - wall.n_vertices()];
    n_wrong += layers.layers.first_node[line] != n_layer_nodes || layers.points[NodeId(n_layer_nodes)] != wall.points[under] ? 1 : 0;
    n_layer_nodes = layers.layers.top(line).index() + 1;
  }
  for (std::size_t t = wall.n_triangles(); t < layers.boundary_triangles.size(); ++t)
    for (const NodeId node : layers.boundary_triangles[t].nodes) n_wrong += !has_rims && node.index() < n_layer_nodes ? 1 : 0;
  require_same(n_wrong, 0, "lines, columns and outer triangles of the layer that are not where wall and outer boundary are");
  require_same(
      layers.prisms.size() + layers.pyramids.size() + layers.hexahedra.size() + layers.tetrahedra.size() + (has_rims ? 0 : layers.boundary_quads.size()), 0,
      "cells and quadrilaterals beside columns");
}

/// What make_tetrahedra() knew of the layer when it ended.
LayerKnowledge know_again(const LayerBase& base, Collider& collider, const Domain& domain, FilledStage& filled, const VolumeMeshOptions& options,
                          const RunContext& context) {
  require_clear_input(collider, context);
  LayerKnowledge knowledge;
  knowledge.certificate = certify_envelope(base, collider, filled.envelope.envelope, context);
  EnvelopeOptions envelope_options = options.envelope;
  envelope_options.feature_angle = filled.envelope.feature_angle;
  Extrusion extrusion{.layers = std::move(filled.layers.layers),
                      .points = std::move(filled.layers.points.raw()),
                      .curving_shares = filled.curving_shares};  // lent: no copy of a large mesh
  knowledge.report = report(base, envelope_options, filled.envelope.envelope, extrusion, context);
  filled.layers.layers = std::move(extrusion.layers);
  filled.layers.points.raw() = std::move(extrusion.points);
  filled.layers.request = layer_request(base, envelope_options, filled.envelope.envelope);
  open_slits(domain, filled.layers.request);
  if (domain.has_rims()) {
    const FillBoundary boundary = boundary_of(filled.layers);
    TetraBoundary for_engines = boundary_for_engines(boundary, {}, false, {});
    for_engines.has_sheets = !options.discs.empty();
    judge(preflight(for_engines, {}, context), for_engines, context);
  }
  LayerProof proof = prove_layer(filled.layers, context);
  add_cells(proof.cells, knowledge.certificate);
  require_proved(knowledge.certificate);
  knowledge.check.emplace(std::move(proof.check));
  return knowledge;
}

}  // namespace

MeshingSite::MeshingSite(const TriMesh& surface, const VolumeMeshOptions& user_options, const RunContext& context)
    : options(sane(surface, user_options, context)),
      given_envelope(options.envelope),
      domain(domain_around(surface, options, context)),
      base([&] {
        const StageTimer timer(context, "topology");
        return base_of(domain, options, context);
      }()),
      collider([&] {
        options.envelope.feature_angle = decide_feature_angle(base, options.envelope, options.smooth_angle, context);
        options.true_surface = true_surface_of(options.true_surface, domain);
        const StageTimer timer(context, "preflight");
        Collider of_wall(base, &domain.outer, context, &domain.links);
        require_clear_input(of_wall, context);
        return of_wall;
      }()) {}

EnvelopeStage make_envelope(MeshingSite& site, const RunContext& context) {
  const StageTimer timer(context, "envelope");
  const RunContext part = context.part("envelope", 0.0, 0.15);
  const std::vector<WholePart> parts =
      site.domain.slits.empty() ? whole_parts(site.domain, site.options.parts, context) : std::vector<WholePart>{};  // cut walls are no parts' any more
  const auto of_wall = [&] {
    const WallEnvelopeMaker& make = site.options.wall_envelope;
    return make ? make(site.base, site.options.envelope, site.collider, part) : build_envelope(site.base, site.options.envelope, site.collider, part);
  };
  EnvelopeStage stage{parts.empty() ? of_wall() : joint_envelope(site, parts, part), site.options.envelope.feature_angle};
  equalise_partners(site.base, site.options.envelope, &site.collider, stage.envelope, context);
  return stage;
}

FilledStage make_tetrahedra(MeshingSite& site, EnvelopeStage stage, LayerKnowledge& knowledge, const RunContext& context) {
  const VolumeMeshOptions& options = site.options;
  Envelope& envelope = stage.envelope;
  FilledStage filled;
  FillBoundary boundary = lay_out(site, envelope, filled, knowledge, context.part("prisms", 0.15, 0.25));
  for (const std::string& warning : knowledge.report.warnings) context.warn(warning);

  TetraResult& tets = filled.tets;
  for (int n_repairs = 0; !knowledge.check; ++n_repairs) {
    const StageTimer timer(context, "tetrahedra");
    std::optional<SplitLayer> split;
    SplitTaker taker;  // where layers end on other patches, and where sides are periodic, the boundary stays as it is
    if (!site.domain.has_rims() && site.domain.periodic.empty())
      taker = [&](TetraResult& of_engine) { split = take_splits(site.base, envelope, site.domain.outer, options, of_engine, context); };
    const std::vector<Point> holes = find_cavity_points(site.domain.bodies, context);
    TetraBoundary domain = boundary_for_engines(boundary, holes, !site.domain.has_rims(), taker);
    domain.has_sheets = !options.discs.empty();
    SizeSupply sizes(domain, options.sources, options.size, context);
    Alongside<LayerProof> proof(context, [&sizes, &mesh = std::as_const(filled.layers)](const RunContext& side) {
      sizes.wait();  // the engine needs them sooner
      return prove_layer(mesh, side);
    });
    try {
      tets = fill(domain, sizes, options.tetrahedra, context.part("tetrahedra", 0.25, 0.9));
    } catch (const FillError& error) {
      proof.take();  // nothing reads the boundary any more
      filled.tetra_failures.insert(filled.tetra_failures.end(), error.failures().begin(), error.failures().end());
      if (!options.tetrahedra.repair_boundary || !error.is_repeatable() || n_repairs == k_max_boundary_repairs) throw;
      const std::size_t n_changed = repair_envelope(site.base, boundary, domain.has_sheets, error.info().places, site.collider, envelope, context).size();
      if (n_changed == 0) throw;
      context.warn("trying again with a layer that is lower and smoother at " + std::to_string(n_changed) +
                   " vertices around slivers, folds and gaps of its top");
      boundary = lay_out(site, envelope, filled, knowledge, context);
      continue;
    }
    std::optional<LayerProof> of_layer(proof.take());
    if (split) {
      adopt(std::move(*split), options, boundary, filled, knowledge, context);
      of_layer.emplace(prove_layer(filled.layers, context));
    }
    add_cells(of_layer->cells, knowledge.certificate);
    require_proved(knowledge.certificate);
    knowledge.check.emplace(std::move(of_layer->check));
  }
  if (!filled.split_wall) filled.envelope.envelope = std::move(envelope);
  filled.envelope.feature_angle = stage.feature_angle;
  filled.tetra_failures.insert(filled.tetra_failures.end(), tets.failures.begin(), tets.failures.end());
  return filled;
}

VolumeMeshResult finish_mesh(FilledStage filled, LayerKnowledge knowledge, const ImproveOptions& options, const RunContext& context) {
  VolumeMeshResult result;
  TetraResult& tets = filled.tets;
  result.mesh = std::move(filled.layers);
  result.layer = std::move(knowledge.report);
  result.certificate = knowledge.certificate;
  result.tetra_engine = tets.engine + (tets.is_two_pass ? " in two passes" : "");
  result.tetra_failures = std::move(filled.tetra_failures);
  result.n_split_triangles = filled.n_split_triangles;
  result.is_reproducible = tets.is_reproducible;
  result.tetra_engine_seconds = tets.engine_seconds;
  result.tetra_engine_peak_bytes = tets.engine_peak_bytes;
  const FillBoundary boundary = boundary_of(result.mesh);
  {
    const StageTimer timer(context, "improve");
    result.improvement = improve_tetrahedra({boundary.points, boundary.triangles, {}}, tets, options, context);
  }
  {
    const StageTimer timer(context, "assemble");
    add_tetrahedra(boundary, tets, result.mesh, context);
  }
  {
    const StageTimer timer(context, "check");
    result.check = check(result.mesh, {}, context.part("check", 0.9, 1.0), &*knowledge.check);
  }
  require_valid(result.check);
  for (const PeriodicMatchReport& sides : result.check.periodic)
    context.info("periodic sides " + sides.first + " and " + sides.second + ": " + std::to_string(sides.n_nodes) + " nodes and " +
                 std::to_string(sides.n_faces) + " faces match within " + number_text(sides.worst, 3) + " m");
  return result;
}

EnvelopeStage make_envelope(const TriMesh& wall, const VolumeMeshOptions& options, const RunContext& context) {
  MeshingSite site(wall, options, context);
  return make_envelope(site, context);
}

FilledStage make_tetrahedra(const TriMesh& surface, const EnvelopeStage& envelope, const VolumeMeshOptions& user_options, const RunContext& context) {
  VolumeMeshOptions options = user_options;
  options.envelope.feature_angle = envelope.feature_angle;
  MeshingSite site(surface, options, context);
  require_same(envelope.envelope.height.size(), site.base.wall.n_vertices(), "vertices of the envelope");
  LayerKnowledge knowledge;
  return make_tetrahedra(site, envelope, knowledge, context);
}

VolumeMeshResult finish_mesh(const TriMesh& surface, FilledStage filled, const VolumeMeshOptions& user_options, const RunContext& context) {
  const VolumeMeshOptions options = sane(surface, user_options, context);
  Domain domain;
  if (filled.split_wall) domain.wall = *filled.split_wall;
  else domain = domain_around(surface, options, context);
  require_same(filled.envelope.envelope.height.size(), domain.wall.n_vertices(), "vertices of the envelope");
  require_layers_on(domain, filled.layers);
  if (!domain.has_rims()) domain.outer = one_sided(outer_of(filled.layers, domain.wall.patches.size()).mesh);
  const LayerBase base = base_of(domain, options, context);
  Collider collider(base, &domain.outer, context, &domain.links);
  LayerKnowledge knowledge = know_again(base, collider, domain, filled, options, context);
  const FillBoundary boundary = boundary_of(filled.layers);
  verify_tetrahedra({.points = boundary.points, .triangles = boundary.triangles, .hole_points = {}}, filled.tets, context);
  return finish_mesh(std::move(filled), std::move(knowledge), options.improve, context);
}

}  // namespace sterna::volmesh
