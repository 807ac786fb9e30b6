#include "volmesh/stages.h"

#include <optional>
#include <utility>

#include "geom/base/alongside.h"
#include "geom/base/error.h"
#include "volmesh/assemble.h"
#include "volmesh/envelope/build_envelope.h"
#include "volmesh/envelope/feature_angle.h"
#include "volmesh/envelope/retract.h"
#include "volmesh/envelope/untangle.h"
#include "volmesh/layer_report.h"
#include "volmesh/prisms/extrude.h"
#include "volmesh/prisms/layer_cells.h"
#include "volmesh/repair_envelope.h"
#include "volmesh/split_layer.h"
#include "volmesh/tetra/size_supply.h"
#include "volmesh/tetra/verify.h"
#include "volmesh/visibility_report.h"

namespace sterna::volmesh {
namespace {

constexpr int k_max_clear_rounds = 10;
constexpr std::size_t k_max_places = 10;
constexpr int k_max_boundary_repairs = 3;

VolumeMeshOptions sane(const TriMesh& wall, VolumeMeshOptions options) {
  require_options(options_of(options), "volume_mesh");
  if (wall.n_triangles() == 0)
    throw Error({.code = ErrorCode::empty_surface, .attempted = "volume_mesh", .problem = "the wall has no triangles"});
  return options;
}

void require_closed(const LayerBase& base) {
  if (base.topology.n_boundary_halfedges() == 0) return;
  ErrorInfo info{.code = ErrorCode::open_surface,
                 .attempted = "volume_mesh",
                 .problem = "the wall is open: " + std::to_string(base.topology.n_boundary_halfedges()) + " edges have one triangle",
                 .n_places = static_cast<std::int64_t>(base.topology.n_boundary_halfedges()),
                 .hint = "half models are not filled yet: mirror the wall and mesh the whole body, or close its holes"};
  for (std::size_t i = 0; i < base.topology.n_halfedges() && info.places.size() < k_max_places; ++i)
    if (base.topology.is_boundary(HalfedgeId(i))) info.places.push_back({base.wall.points[base.topology.from(HalfedgeId(i))], "an open edge starts here"});
  throw Error(std::move(info));
}

/// Extrusion may lower heights, and lowering may bring surfaces together that were clear before: alternate until neither changes anything. What still
/// changes after some rounds collapses, so it ends. \pre, \post envelope valid and clear.
Extrusion extrude_clear_of_collisions(const LayerBase& base, const VolumeMeshOptions& options, Collider& collider, Envelope& envelope,
                                      const RunContext& context) {
  const EnvelopeScale scale = scale_of(options.envelope);
  Extruder extruder(base, options.envelope, options.prisms, context);
  for (int round = 0;; ++round) {
    const EnvelopeShape before = envelope;
    extruder.extrude(envelope);
    const std::vector<VertexId> repaired = difference(before, envelope, context).vertices;
    if (repaired.empty() || !retract_collisions(base, options.envelope, collider, envelope, context, &repaired)) return extruder.take();
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

TetraBoundary domain_of(const FillBoundary& boundary, std::span<const Point> holes, SplitTaker take_splits) {
  return {boundary.points, boundary.triangles, holes, true, boundary.patch_names, boundary.triangle_patch, std::move(take_splits)};
}

/// Carries the splits of a result to the layer; where the layer must be lower with them, the volume inside the split boundary, kept now, is filled once more.
SplitLayer take_splits(const LayerBase& base, const Envelope& envelope, const TriMesh& outer, const VolumeMeshOptions& options, TetraResult& tets,
                       const RunContext& context) {
  SplitLayer layer = split_layer(base, envelope, outer, options, tets, context);
  if (layer.is_filled) return layer;
  VolumeMeshOptions keeping = options;
  keeping.tetrahedra.boundary_splits = "never";
  const std::vector<Point> holes = find_cavity_points(*layer.wall, context);
  const TetraBoundary domain = domain_of(layer.boundary, holes, {});
  SizeSupply sizes(domain, options.sources, options.size, context);
  tets = fill(domain, sizes, keeping.tetrahedra, context);
  return layer;
}

/// The split layer instead of the one that it came from.
void adopt(SplitLayer split, const VolumeMeshOptions& options, FillBoundary& boundary, FilledStage& filled, LayerKnowledge& knowledge, const RunContext& context) {
  filled.n_split_triangles = static_cast<std::int64_t>(split.boundary.triangles.size() - boundary.triangles.size());
  context.info("boundary splits: " + std::to_string(split.boundary.points.size() - boundary.points.size()) + " new points, " +
               std::to_string(filled.n_split_triangles) + " more triangles");
  knowledge.certificate = split.certificate;
  knowledge.report = report(*split.base, options.envelope, split.envelope, split.extrusion, context);
  filled.curving_shares = split.extrusion.curving_shares;
  filled.layers = assemble_layers(*split.base, std::move(split.extrusion), *split.outer);
  filled.layers.request = layer_request(options.envelope, split.envelope);
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
  FillBoundary boundary = fill_boundary(site.base, extrusion, site.outer);
  filled.layers = assemble_layers(site.base, std::move(extrusion), site.outer);
  filled.layers.request = layer_request(site.options.envelope, envelope);
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
void require_layers_on(const TriMesh& wall, const HybridMesh& layers) {
  require_same(layers.layers.n_lines(), wall.n_vertices(), "lines of the layer");
  require_same(layers.layers.n_columns(), wall.n_triangles(), "columns of the layer");
  std::size_t n_wrong = 0, n_layer_nodes = 0;
  for (const TriangleId t : wall.triangles.ids())
    for (std::size_t k = 0; k < 3; ++k) n_wrong += layers.layers.base[t.index()][k] != wall.triangles[t][k].value() ? 1 : 0;
  for (std::uint32_t line = 0; line < layers.layers.n_lines(); ++line) {
    n_wrong += layers.layers.first_node[line] != n_layer_nodes || layers.points[NodeId(n_layer_nodes)] != wall.points[VertexId(line)] ? 1 : 0;
    n_layer_nodes = layers.layers.node(line, layers.layers.n_layers).index() + 1;
  }
  for (std::size_t t = wall.n_triangles(); t < layers.boundary_triangles.size(); ++t)
    for (const NodeId node : layers.boundary_triangles[t].nodes) n_wrong += node.index() < n_layer_nodes ? 1 : 0;
  require_same(n_wrong, 0, "lines, columns and outer triangles of the layer that are not where wall and outer boundary are");
  require_same(layers.prisms.size() + layers.pyramids.size() + layers.hexahedra.size() + layers.tetrahedra.size() + layers.boundary_quads.size(), 0, "cells and quadrilaterals beside columns");
}

/// What make_tetrahedra() knew of the layer when it ended.
LayerKnowledge know_again(const TriMesh& wall, FilledStage& filled, const VolumeMeshOptions& options, const RunContext& context) {
  const TriMesh outer = outer_of(filled.layers);
  const LayerBase base(wall, context);
  require_closed(base);
  Collider collider(base, &outer, context);
  require_clear_input(collider, context);
  LayerKnowledge knowledge;
  knowledge.certificate = certify_envelope(base, collider, filled.envelope.envelope, context);
  EnvelopeOptions envelope_options = options.envelope;
  envelope_options.feature_angle = filled.envelope.feature_angle;
  Extrusion extrusion{.layers = std::move(filled.layers.layers), .points = std::move(filled.layers.points.raw()), .curving_shares = filled.curving_shares};  // lent: no copy of a large mesh
  knowledge.report = report(base, envelope_options, filled.envelope.envelope, extrusion, context);
  filled.layers.layers = std::move(extrusion.layers);
  filled.layers.points.raw() = std::move(extrusion.points);
  filled.layers.request = layer_request(envelope_options, filled.envelope.envelope);
  LayerProof proof = prove_layer(filled.layers, context);
  add_cells(proof.cells, knowledge.certificate);
  require_proved(knowledge.certificate);
  knowledge.check.emplace(std::move(proof.check));
  return knowledge;
}

}  // namespace

MeshingSite::MeshingSite(const TriMesh& wall, const VolumeMeshOptions& user_options, const RunContext& context)
    : options(sane(wall, user_options)),
      outer(farfield_sphere(wall, options.farfield, context)),
      base([&] {
        const StageTimer timer(context, "topology");
        LayerBase layer_base(wall, context);
        require_closed(layer_base);
        return layer_base;
      }()),
      collider([&] {
        options.envelope.feature_angle = decide_feature_angle(base, options.envelope, options.smooth_angle, context);
        const StageTimer timer(context, "preflight");
        Collider of_wall(base, &outer, context);
        require_clear_input(of_wall, context);
        return of_wall;
      }()) {}

EnvelopeStage make_envelope(MeshingSite& site, const RunContext& context) {
  const StageTimer timer(context, "envelope");
  return {build_envelope(site.base, site.options.envelope, site.collider, context.part("envelope", 0.0, 0.15)), site.options.envelope.feature_angle};
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
    const SplitTaker taker = [&](TetraResult& of_engine) { split = take_splits(site.base, envelope, site.outer, options, of_engine, context); };
    const std::vector<Point> holes = find_cavity_points(site.base.wall, context);
    const TetraBoundary domain = domain_of(boundary, holes, taker);
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
      const std::size_t n_changed = repair_envelope(site.base, boundary, error.info().places, site.collider, envelope, context).size();
      if (n_changed == 0) throw;
      context.warn("trying again with a layer that is lower and smoother at " + std::to_string(n_changed) + " vertices around slivers, folds and gaps of its top");
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
  return result;
}

EnvelopeStage make_envelope(const TriMesh& wall, const VolumeMeshOptions& options, const RunContext& context) {
  MeshingSite site(wall, options, context);
  return make_envelope(site, context);
}

FilledStage make_tetrahedra(const TriMesh& wall, const EnvelopeStage& envelope, const VolumeMeshOptions& user_options, const RunContext& context) {
  require_same(envelope.envelope.height.size(), wall.n_vertices(), "vertices of the envelope");
  VolumeMeshOptions options = user_options;
  options.envelope.feature_angle = envelope.feature_angle;
  MeshingSite site(wall, options, context);
  LayerKnowledge knowledge;
  return make_tetrahedra(site, envelope, knowledge, context);
}

VolumeMeshResult finish_mesh(const TriMesh& given_wall, FilledStage filled, const VolumeMeshOptions& user_options, const RunContext& context) {
  const TriMesh& wall = filled.split_wall ? *filled.split_wall : given_wall;
  const VolumeMeshOptions options = sane(wall, user_options);
  require_same(filled.envelope.envelope.height.size(), wall.n_vertices(), "vertices of the envelope");
  require_layers_on(wall, filled.layers);
  LayerKnowledge knowledge = know_again(wall, filled, options, context);
  const FillBoundary boundary = boundary_of(filled.layers);
  verify_tetrahedra({.points = boundary.points, .triangles = boundary.triangles, .hole_points = {}}, filled.tets, context);
  return finish_mesh(std::move(filled), std::move(knowledge), options.improve, context);
}

}  // namespace sterna::volmesh
