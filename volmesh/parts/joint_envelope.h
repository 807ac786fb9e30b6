// The envelope of a wall with placed parts. The envelopes of these parts are made in the parts' own frames and moved with them. Then all envelopes are made
// clear of each other.
#pragma once

#include <cstddef>
#include <span>
#include <vector>

#include "volmesh/case/placed_part.h"
#include "volmesh/layer_domain/layer_domain.h"
#include "volmesh/parts/part_envelope.h"

namespace sterna::volmesh {

/// A closed part at the location given by its placement. All its triangles are walls with layers.
struct WholePart {
  std::size_t part = 0;            ///< number of the part in the options
  std::size_t first_triangle = 0;  ///< number of its first triangle in the wall
  std::size_t first_vertex = 0;
};
/// Returns the parts of a domain's wall whose envelopes can be made separately. The log states why other parts cannot.
std::vector<WholePart> whole_parts(const Domain& domain, std::span<const PlacedPart> parts, const RunContext& context);

/// Makes the joint envelope. First `make` (if empty: part_envelope()) makes the envelopes of the parts, and these are moved. Then the envelope of the rest of
/// the wall is made, with the outer boundary around it. Then heights of the whole envelope are lowered in three cases: where it leaves the constraint surfaces
/// (keep_inside), where gaps between different parts or to the outer boundary are too narrow (share_gaps), and where anything still collides
/// (retract_collisions). Lowered heights grow back where the envelope stays clear. A part with nothing near it keeps its separate envelope.
/// \pre `parts` were returned by whole_parts() and are not empty
/// \post the same as for build_envelope()
Envelope joint_envelope(LayerDomain& layer_domain, std::span<const WholePart> parts, const PartEnvelopeMaker& make, const RunContext& context);

}  // namespace sterna::volmesh
