#include "volmesh/lay_out.h"

#include <string>
#include <utility>
#include <vector>

#include "volmesh/adjacent/close_boundary.h"
#include "volmesh/adjacent/wall_discs.h"
#include "volmesh/envelope/periodic_growth.h"
#include "volmesh/envelope/retract.h"
#include "volmesh/envelope/untangle.h"
#include "volmesh/features/domain_feature.h"
#include "volmesh/layer/extrude.h"

namespace sterna::volmesh {
namespace {

constexpr int k_max_clear_rounds = 10;

/// Extrusion may lower heights, and lower heights may bring surfaces together that were clear before. Both steps alternate until neither changes anything.
/// Vertices that still change after some rounds collapse, so the loop terminates. \pre, \post the envelope is valid and clear
Extrusion extrude_clear_of_collisions(const LayerBase& base, const MeshCase& options, Collider& collider, Envelope& envelope, const RunContext& context) {
  const EnvelopeScale scale = scale_of(base, options.envelope);
  Extruder extruder(base, options.envelope, options.prisms, context);
  for (int round = 0;; ++round) {
    const EnvelopeShape before = envelope;
    extruder.extrude(envelope);
    const std::vector<VertexId> repaired = difference(before, envelope, context).vertices;
    const bool is_equal = equalise_partners(base, options.envelope, &collider, envelope, context).empty();
    if ((repaired.empty() || !retract_collisions(base, options.envelope, collider, envelope, context, &repaired)) && is_equal)
      return std::move(extruder).take();
    if (round < k_max_clear_rounds) continue;
    std::vector<VertexId> disturbed = difference(before, envelope, context).vertices;
    for (const VertexId v : disturbed) lower(envelope, v, 0.0, HeightLimit::prism, scale);
    unwarp(base, options.envelope, HeightLimit::prism, envelope, context, &disturbed);
    disturbed = difference(before, envelope, context).vertices;
    retract_collisions(base, options.envelope, collider, envelope, context, &disturbed);
  }
}

/// Closes the outer boundary around the layer, with the parts that features add.
ClosedOuter closed_around(const LayerDomain& layer_domain, const Envelope& envelope, const RunContext& context) {
  const auto& options = layer_domain.options;
  const Domain& domain = layer_domain.domain;
  ClosedOuter outer = close_boundary(domain, layer_domain.base, envelope, {options.ends, end_sizes(options)}, context);
  for (const auto& feature : domain.features) feature->add_boundary({options, domain, layer_domain.base, envelope, context}, outer);
  return outer;
}

}  // namespace

LaidLayer lay_out(LayerDomain& layer_domain, Envelope& envelope, const RunContext& context) {
  LaidLayer laid;
  Extrusion extrusion;
  {
    const StageTimer timer(context, "prisms");
    extrusion = extrude_clear_of_collisions(layer_domain.base, layer_domain.options, layer_domain.collider, envelope, context);
  }
  {
    const StageTimer timer(context, "certificate");
    const TestedEnvelope tested = certify_envelope(layer_domain.base, layer_domain.collider, envelope, context);
    require_proved(tested);
    laid.certificate = tested;
    if (!layer_domain.domain.needs.remeshes_outer) laid.clear = tested.clear;
  }
  laid.report = report_layer(layer_domain.base, layer_domain.options.envelope, envelope, extrusion, &layer_domain.domain.outer, context);
  laid.curving_shares = extrusion.curving_shares;
  const ClosedOuter outer = closed_around(layer_domain, envelope, context);
  const Domain& domain = layer_domain.domain;
  for (const auto& feature : domain.features) feature->cut_columns(domain, extrusion.layers, extrusion.points);
  laid.boundary = fill_boundary(layer_domain.base, extrusion, outer);
  laid.mesh = assemble_layers(layer_domain.base, std::move(extrusion), outer, layer_sides(domain));
  laid.mesh.request = layer_request(layer_domain.base, layer_domain.options.envelope, envelope, laid.mesh.layers);
  for (const auto& feature : domain.features) feature->label(domain, laid.mesh);
  if (!domain.needs.converts_cells) return laid;
  laid.opened = laid.mesh;
  for (const auto& feature : domain.features) feature->finish(domain, laid.mesh, laid.boundary);
  return laid;
}

LayerProof prove_layer(const HybridMesh& mesh, const RunContext& context) {
  return {certify_layer(mesh.layers, mesh.points.raw(), context), check_ahead(mesh, {}, context)};
}

void require_proved_cells(const LayerCertificate& cells, EnvelopeCertificate& certificate) {
  certificate.n_layer_cells = cells.n_cells;
  certificate.n_invalid_layer_cells = cells.n_cells - cells.n_proved;
  if (cells.worst_column >= 0)
    certificate.worst_layer_cell = {cells.min_quality, cells.worst_location,
                                    "layer " + std::to_string(cells.worst_layer) + " on wall triangle " + std::to_string(cells.worst_column)};
  require_proved(certificate);
}

}  // namespace sterna::volmesh
