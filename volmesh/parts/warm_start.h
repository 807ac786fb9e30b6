// The envelope of a wall that is another one deformed: started from that one's envelope, not made from scratch.
#pragma once

#include <functional>
#include <optional>
#include <string>

#include "volmesh/envelope/collide.h"
#include "volmesh/envelope/envelope.h"

namespace sterna::volmesh {

/// An envelope and the points of the wall that it is of, both in any one frame.
struct StartingEnvelope {
  Column<VertexId, Point> points;
  Envelope envelope;
};

/// Of the wall's area: so much less of it may have its full height (0.9 of the target) than where the start had it. More is a layer that the user would see to
/// be worse.
inline constexpr double k_lost_coverage = 0.02;

struct WarmStart {
  std::optional<Envelope> envelope;  ///< nothing: it has to be made from scratch
  std::string objection;             ///< then why
  Point place{};                     ///< and where
};

/// Starts from an envelope of a wall with the same triangles. Directions turn with the wall: by the rotation that takes normal and an edge of a vertex from
/// there to here, into the cone that sees the vertex' faces. Targets are asked anew (initial_envelope); of its target a vertex keeps the share of height that
/// it had, and not more metres than it had where something but its target limited it. Then only what makes an envelope valid: keep_inside, unwarp, share_gaps,
/// retract_collisions, regrowth of what these lowered, seat_on_surfaces, the certificate. No classification, smoothing, or optimisation: what these found is in
/// the start.
/// \pre `collider` is of `base`
/// \post a returned envelope is valid and clear as build_envelope()'s, and certified. It depends on the arguments alone. Objections: other numbers of vertices;
/// vertices that must grow alike (periodic sides); coverage lost beyond k_lost_coverage; not proved.
WarmStart warm_start(const LayerBase& base, const EnvelopeOptions& options, const StartingEnvelope& start, Collider& collider, const RunContext& context);

/// Who makes the envelope of a wall: build_envelope(), or one who knows another to start from.
using WallEnvelopeMaker = std::function<Envelope(const LayerBase&, const EnvelopeOptions&, Collider&, const RunContext&)>;

}  // namespace sterna::volmesh
