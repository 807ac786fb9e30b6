// The envelope of a deformed wall. It starts from the envelope of the undeformed wall and is not made from scratch.
#pragma once

#include <functional>
#include <optional>
#include <string>

#include "volmesh/envelope/collide.h"
#include "volmesh/envelope/envelope.h"

namespace sterna::volmesh {

/// An envelope and the points of its wall, both in the same frame.
struct StartingEnvelope {
  Column<VertexId, Point> points;
  Envelope envelope;
};

/// Largest loss of area with full height (0.9 of the target) against the start, as a fraction of the wall's area. With a larger loss the layer would be
/// noticeably worse.
inline constexpr double k_lost_coverage = 0.02;

struct WarmStart {
  std::optional<Envelope> envelope;  ///< empty: the envelope has to be made from scratch
  std::string objection;             ///< reason why there is no envelope
  Point location{};                  ///< location to which the reason refers
};

/// Starts from an envelope of a wall with the same triangles. Directions turn with the wall: by the rotation that maps the normal and an edge of a vertex from
/// the start to this wall, and into the cone of directions from which the vertex's faces are visible. Targets are computed again (initial_envelope). A vertex
/// keeps its fraction of the target height. If something other than its target limited its height in the start, the height does not increase. Then only the
/// steps that make an envelope valid are run: keep_inside, unwarp, share_gaps, retract_collisions, regrowth of heights lowered by these steps,
/// seat_on_surfaces, and the certificate. There is no classification, smoothing or optimisation, because the start contains their results.
/// \pre `collider` belongs to `base`
/// \post a returned envelope is valid, clear and certified like that of build_envelope(). It depends on the arguments alone. Possible objections: different
/// numbers of vertices; vertices that must grow alike (periodic sides); a loss of coverage of more than k_lost_coverage; a failed certificate
WarmStart warm_start(const LayerBase& base, const EnvelopeOptions& options, const StartingEnvelope& start, Collider& collider, const RunContext& context);

/// Makes the envelope of a wall. It is build_envelope(), or a function that starts from a known envelope.
using WallEnvelopeMaker = std::function<Envelope(const LayerBase&, const EnvelopeOptions&, Collider&, const RunContext&)>;

}  // namespace sterna::volmesh
