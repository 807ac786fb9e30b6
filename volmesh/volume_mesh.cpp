#include "volmesh/volume_mesh.h"

#include <numbers>
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
#include "volmesh/visibility_report.h"

namespace sterna::volmesh {
namespace {

constexpr int k_max_clear_rounds = 10;
constexpr std::size_t k_max_places = 10;
constexpr int k_max_boundary_repairs = 3;

void require_sane(const TriMesh& wall, VolumeMeshOptions& options) {
  require_options(options_of(options), "volume_mesh");
  if (wall.n_triangles() == 0)
    throw Error({.code = ErrorCode::empty_surface, .attempted = "volume_mesh", .problem = "the wall has no triangles"});
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
void adopt(SplitLayer split, const VolumeMeshOptions& options, FillBoundary& boundary, VolumeMeshResult& result, const RunContext& context) {
  result.n_split_triangles = static_cast<std::int64_t>(split.boundary.triangles.size() - boundary.triangles.size());
  context.info("boundary splits: " + std::to_string(split.boundary.points.size() - boundary.points.size()) + " new points, " +
               std::to_string(result.n_split_triangles) + " more triangles");
  result.certificate = split.certificate;
  result.layer = report(*split.base, options.envelope, split.envelope, split.extrusion, context);
  result.mesh = assemble_layers(*split.base, std::move(split.extrusion), *split.outer);
  result.mesh.request = layer_request(options.envelope, split.envelope);
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

}  // namespace

VolumeMeshResult volume_mesh(const TriMesh& wall, const VolumeMeshOptions& user_options, const RunContext& context) {
  VolumeMeshOptions options = user_options;
  require_sane(wall, options);
  VolumeMeshResult result;

  const TriMesh outer = farfield_sphere(wall, options.farfield, context);
  Envelope envelope;
  Extrusion extrusion;
  const LayerBase base = [&] {
    const StageTimer timer(context, "topology");
    LayerBase layer_base(wall, context);
    require_closed(layer_base);
    return layer_base;
  }();
  options.envelope.feature_angle = feature_angle_of(base, options.envelope, context);
  context.info("feature angle " + std::to_string(options.envelope.feature_angle * 180.0 / std::numbers::pi) + " deg");
  Collider collider = [&] {
    const StageTimer timer(context, "preflight");
    Collider of_wall(base, &outer, context);
    require_clear_input(of_wall, context);
    return of_wall;
  }();
  {
    const StageTimer timer(context, "envelope");
    envelope = build_envelope(base, options.envelope, collider, context.part("envelope", 0.0, 0.15));
  }
  FillBoundary boundary;
  const auto lay_out = [&](const RunContext& part) {
    {
      const StageTimer timer(context, "prisms");
      extrusion = extrude_clear_of_collisions(base, options, collider, envelope, part);
    }
    {
      const StageTimer timer(context, "certificate");
      result.certificate = certify_envelope(base, collider, envelope, context);
      require_proved(result.certificate);
    }
    result.layer = report(base, options.envelope, envelope, extrusion, context);
    boundary = fill_boundary(base, extrusion, outer);
    result.mesh = assemble_layers(base, std::move(extrusion), outer);
    result.mesh.request = layer_request(options.envelope, envelope);
  };
  lay_out(context.part("prisms", 0.15, 0.25));
  for (const std::string& warning : result.layer.warnings) context.warn(warning);

  TetraResult tets;
  std::optional<LayerCheck> layer_check;
  for (int n_repairs = 0; !layer_check; ++n_repairs) {
    const StageTimer timer(context, "tetrahedra");
    std::optional<SplitLayer> split;
    const SplitTaker taker = [&](TetraResult& of_engine) { split = take_splits(base, envelope, outer, options, of_engine, context); };
    const std::vector<Point> holes = find_cavity_points(wall, context);
    const TetraBoundary domain = domain_of(boundary, holes, taker);
    SizeSupply sizes(domain, options.sources, options.size, context);
    Alongside<LayerProof> proof(context, [&sizes, &mesh = std::as_const(result.mesh)](const RunContext& side) {
      sizes.wait();  // the engine needs them sooner
      return prove_layer(mesh, side);
    });
    try {
      tets = fill(domain, sizes, options.tetrahedra, context.part("tetrahedra", 0.25, 0.9));
    } catch (const FillError& error) {
      proof.take();  // nothing reads the boundary any more
      result.tetra_failures.insert(result.tetra_failures.end(), error.failures().begin(), error.failures().end());
      if (!options.tetrahedra.repair_boundary || !error.is_repeatable() || n_repairs == k_max_boundary_repairs) throw;
      const std::size_t n_changed = repair_envelope(base, boundary, error.info().places, collider, envelope, context).size();
      if (n_changed == 0) throw;
      context.warn("trying again with a layer that is lower and smoother at " + std::to_string(n_changed) + " vertices around slivers, folds and gaps of its top");
      lay_out(context);
      continue;
    }
    std::optional<LayerProof> of_layer(proof.take());
    if (split) {
      adopt(std::move(*split), options, boundary, result, context);
      of_layer.emplace(prove_layer(result.mesh, context));
    }
    add_cells(of_layer->cells, result.certificate);
    require_proved(result.certificate);
    layer_check.emplace(std::move(of_layer->check));
  }
  result.tetra_engine = tets.engine + (tets.is_two_pass ? " in two passes" : "");
  result.tetra_failures.insert(result.tetra_failures.end(), tets.failures.begin(), tets.failures.end());
  result.is_reproducible = tets.is_reproducible;
  result.tetra_engine_seconds = tets.engine_seconds;
  result.tetra_engine_peak_bytes = tets.engine_peak_bytes;
  {
    const StageTimer timer(context, "improve");
    result.improvement = improve_tetrahedra({boundary.points, boundary.triangles, {}}, tets, options.improve, context);
  }
  {
    const StageTimer timer(context, "assemble");
    add_tetrahedra(boundary, tets, result.mesh, context);
  }
  {
    const StageTimer timer(context, "check");
    result.check = check(result.mesh, {}, context.part("check", 0.9, 1.0), &*layer_check);
  }
  require_valid(result.check);
  return result;
}

}  // namespace sterna::volmesh
