// Restores the state of a run before the improvement from a stage that was stored. All data is verified again.
#include <cstdint>
#include <string>
#include <utility>

#include "geom/base/error.h"
#include "volmesh/adjacent/wall_discs.h"
#include "volmesh/domain/disc_baffles.h"
#include "volmesh/features/domain_feature.h"
#include "volmesh/run_steps.h"
#include "volmesh/tetra/preflight.h"
#include "volmesh/tetra/verify.h"

namespace sterna::volmesh {
namespace {

/// Checks that the layer stands on the wall, and that the mesh contains nothing else except the outer boundary.
void require_layers_on(const Domain& domain, const HybridMesh& layers) {
  const TriMesh& wall = domain.wall;
  require_same(layers.layers.n_lines(), wall.n_vertices() + domain.wall_disc_vertices.size(), "growth lines of the layer");
  require_same(layers.layers.n_columns(), wall.n_triangles(), "prism columns of the layer");
  const bool may_share = domain.needs.remeshes_outer;  // layers end on other patches, whose faces have nodes of the layer
  std::size_t n_wrong = 0, n_layer_nodes = 0;
  for (const TriangleId t : wall.triangles.ids())
    for (std::size_t k = 0; k < 3; ++k) n_wrong += layers.layers.base[t.index()][k] != line_under(domain, t, k) ? 1 : 0;
  for (std::uint32_t line = 0; line < layers.layers.n_lines(); ++line) {
    const VertexId under = line < wall.n_vertices() ? VertexId(line) : domain.wall_disc_vertices[line - wall.n_vertices()];
    n_wrong += layers.layers.first_node[line] != n_layer_nodes || layers.points[NodeId(n_layer_nodes)] != wall.points[under] ? 1 : 0;
    n_layer_nodes = layers.layers.top(line).index() + 1;
  }
  for (std::size_t t = wall.n_triangles(); t < layers.boundary_triangles.size(); ++t)
    for (const NodeId node : layers.boundary_triangles[t].nodes) n_wrong += !may_share && node.index() < n_layer_nodes ? 1 : 0;
  require_same(n_wrong, 0, "growth lines, columns and outer triangles of the layer that are not on the wall and the outer boundary");
  require_same(
      layers.prisms.size() + layers.pyramids.size() + layers.hexahedra.size() + layers.tetrahedra.size() + (may_share ? 0 : layers.boundary_quads.size()), 0,
      "cells and quadrilaterals outside the prism columns");
}

/// Restores the layer data that the step of the tetrahedra had at its end.
LayerKnowledge reprove(const LayerBase& base, Collider& collider, const Domain& domain, FilledStage& filled, const MeshCase& options,
                       const RunContext& context) {
  require_clear_input(collider, context);
  LayerKnowledge knowledge;
  const TestedEnvelope tested = certify_envelope(base, collider, filled.envelope.envelope, context);
  knowledge.certificate = tested;
  EnvelopeOptions envelope_options = options.envelope;
  envelope_options.feature_angle = filled.envelope.feature_angle;
  Extrusion extrusion{.layers = std::move(filled.layers.layers),
                      .points = std::move(filled.layers.points.raw()),
                      .curving_shares = filled.curving_shares};  // moved temporarily, which avoids a copy of a large mesh
  knowledge.report = report_layer(base, envelope_options, filled.envelope.envelope, extrusion, &domain.outer, context);
  filled.layers.layers = std::move(extrusion.layers);
  filled.layers.points.raw() = std::move(extrusion.points);
  filled.layers.request = layer_request(base, envelope_options, filled.envelope.envelope, filled.layers.layers);
  for (const auto& feature : domain.features) feature->label(domain, filled.layers);
  ClearProof clear = tested.clear;
  if (domain.needs.remeshes_outer) {
    const FillBoundary boundary = boundary_of(filled.layers);
    const TetraBoundary for_engines = engine_boundary(boundary, {}, {}, domain.needs.traits);
    const PreflightReport report = preflight(for_engines, {}, context);
    judge(report, for_engines, context);
    clear = report.clear;
  }
  if (domain.needs.converts_cells) {
    knowledge.boundary = boundary_of(filled.layers);
    knowledge.closed = filled.layers;
    for (const auto& feature : domain.features) feature->finish(domain, *knowledge.closed, knowledge.boundary);
  }
  LayerProof proof = prove_layer(knowledge.closed ? *knowledge.closed : filled.layers, context);
  require_proved_cells(proof.cells, knowledge.certificate);
  knowledge.check.emplace(std::move(proof.check));
  if (!filled.split_wall) knowledge.second = second_engine(options, find_cavity_points(domain.bodies, context), clear, domain.needs.traits);
  return knowledge;
}

}  // namespace

void require_same(std::size_t found, std::size_t expected, const std::string& what) {
  if (found != expected)
    throw Error({.code = ErrorCode::bad_argument,
                 .attempted = "continuing a volume mesh",
                 .problem = "found " + std::to_string(found) + " " + what + ", expected " + std::to_string(expected),
                 .hint = "surface, envelope, layers and tetrahedra must come from one run"});
}

void restore(MeshRun& run, const RunContext& context) {
  FilledStage& filled = run.filled;
  const ClosedMultiNormals& closed = filled.envelope.closed;
  const MeshCase options = validated(run.surface, with_closed_multi_normals(run.options, closed), context);
  Domain domain;
  if (filled.split_wall) domain.wall = *filled.split_wall;
  else domain = domain_around(run.surface, options, context, closed.base_vertices);
  require_same(filled.envelope.envelope.height.size(), domain.wall.n_vertices(), "vertices of the envelope");
  require_layers_on(domain, filled.layers);
  if (!domain.needs.remeshes_outer) domain.outer = one_sided(outer_of(filled.layers, domain.wall.patches.size()).mesh);
  const LayerBase base = base_of(domain, options, context);
  Collider collider(base, &domain.outer, context, &domain.links);
  run.knowledge = reprove(base, collider, domain, filled, options, context);
  const FillBoundary boundary = boundary_of(filled.layers);
  verify_tetrahedra({.points = boundary.points, .triangles = boundary.triangles, .hole_points = {}}, filled.tets, context);
}

}  // namespace sterna::volmesh
