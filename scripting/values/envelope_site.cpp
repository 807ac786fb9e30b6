#include "scripting/values/envelope_site.h"

#include <string>
#include <utility>
#include <vector>

#include "geom/base/error.h"
#include "volmesh/envelope/certificate.h"

namespace sterna::scripting {

using volmesh::EnvelopeStep;
using volmesh::MeshCase;
using volmesh::MeshingSite;

std::unique_ptr<MeshingSite> envelope_site(const EnvelopeValue& value, const RunContext& context) {
  MeshCase options = volmesh::with_closed_fans(with_wall_facts(*value.wall, value.options), value.stage.closed);
  // Classes depend on the wall alone. The layer domain nevertheless requires a first height, for which any value is valid.
  if (value.step == EnvelopeStep::classified && is_automatic(options.envelope.first_height)) options.envelope.first_height = 1.0;
  options.envelope.feature_angle = value.stage.feature_angle;
  return std::make_unique<MeshingSite>(value.wall->mesh, options, context, value.stage.closed.feet);
}

void require_ready(const EnvelopeValue& envelope, const MeshCase& options, const RunContext& context) {
  if (envelope.step == EnvelopeStep::finished) return;
  const auto refuse = [&](std::string problem, std::vector<ErrorPlace> places) {
    throw Error({.code = ErrorCode::bad_argument,
                 .attempted = "tetrahedra around an envelope that is only " + std::string(to_string(envelope.step)),
                 .problem = std::move(problem),
                 .places = std::move(places),
                 .hint = "envelope.unwarp{ env } makes the elements valid, envelope.retract{ env } separates layers that intersect"});
  };
  if (envelope.step == EnvelopeStep::classified) refuse("the envelope has no heights yet", {});
  EnvelopeValue value = envelope;
  value.options = options;
  const auto site = envelope_site(value, context);
  const volmesh::EnvelopeCertificate proof = volmesh::certify_envelope(site->base, site->collider, envelope.stage.envelope, context);
  if (proof.is_proved()) return;
  refuse(std::to_string(proof.n_invalid_macro_elements) + " of its elements are invalid, " + std::to_string(proof.n_crossings) +
             " pairs of triangles around it cross, " + std::to_string(proof.n_swallowings) + " surfaces are within a layer",
         proof.n_invalid_macro_elements > 0 ? std::vector<ErrorPlace>{{proof.worst_macro_element.place, "worst element: " + proof.worst_macro_element.what}}
                                            : std::vector<ErrorPlace>{});
}

}  // namespace sterna::scripting
