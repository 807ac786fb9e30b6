#include "scripting/values/envelope_domain.h"

#include <string>
#include <utility>
#include <vector>

#include "geom/base/error.h"
#include "volmesh/envelope/certificate.h"

namespace sterna::scripting {

using volmesh::EnvelopeStep;
using volmesh::LayerDomain;
using volmesh::MeshCase;

std::unique_ptr<LayerDomain> envelope_domain(const EnvelopeValue& value, const RunContext& context) {
  MeshCase options = volmesh::with_closed_multi_normals(with_wall_facts(*value.wall, value.options), value.stage.closed);
  // Classes depend on the wall alone. The layer domain nevertheless requires a first height, for which any value is valid.
  if (value.step == EnvelopeStep::classified && is_automatic(options.envelope.first_height)) options.envelope.first_height = 1.0;
  options.envelope.feature_angle = value.stage.feature_angle;
  return std::make_unique<LayerDomain>(value.wall->mesh, options, context, value.stage.closed.base_vertices);
}

void require_ready(const EnvelopeValue& envelope, const MeshCase& options, const RunContext& context) {
  if (envelope.step == EnvelopeStep::finished) return;
  const auto refuse = [&](std::string problem, std::vector<ErrorLocation> locations) {
    throw Error({.code = ErrorCode::bad_argument,
                 .attempted = "tetrahedra around an envelope that is only " + std::string(to_string(envelope.step)),
                 .problem = std::move(problem),
                 .locations = std::move(locations),
                 .hint = "envelope.unwarp{ env } makes the elements valid, envelope.retract{ env } separates layers that intersect"});
  };
  if (envelope.step == EnvelopeStep::classified) refuse("the envelope has no heights yet", {});
  EnvelopeValue value = envelope;
  value.options = options;
  const auto layer_domain = envelope_domain(value, context);
  const volmesh::EnvelopeCertificate proof = volmesh::certify_envelope(layer_domain->base, layer_domain->collider, envelope.stage.envelope, context);
  if (proof.is_proved()) return;
  refuse(std::to_string(proof.n_invalid_macro_elements) + " of its elements are invalid, " + std::to_string(proof.n_crossings) +
             " pairs of triangles around it cross, " + std::to_string(proof.n_swallowings) + " surfaces are within a layer",
         proof.n_invalid_macro_elements > 0
             ? std::vector<ErrorLocation>{{proof.worst_macro_element.location, "worst element: " + proof.worst_macro_element.what}}
             : std::vector<ErrorLocation>{});
}

}  // namespace sterna::scripting
