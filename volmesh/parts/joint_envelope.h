// The envelope of a wall with placed parts: the envelopes of these parts are made in the parts' own frames and moved with them; then all envelopes are made
// clear of each other.
#pragma once

#include <cstddef>
#include <span>
#include <vector>

#include "volmesh/case/placed_part.h"
#include "volmesh/parts/part_envelope.h"
#include "volmesh/site/site.h"

namespace sterna::volmesh {

/// A closed part whose triangles are all walls with layers, at the location given by its placement.
struct WholePart {
  std::size_t part = 0;            ///< index in the options' parts
  std::size_t first_triangle = 0;  ///< first triangle in the wall
  std::size_t first_vertex = 0;
};
/// Returns the parts of a domain's wall whose envelopes can be made separately. The log states why other parts cannot.
std::vector<WholePart> whole_parts(const Domain& domain, std::span<const PlacedPart> parts, const RunContext& context);

/// Makes the joint envelope. Steps: envelopes of the parts by `make` (empty: part_envelope()), moved; the envelope of the rest of the wall with the outer
/// boundary around it. Then, for all together, heights are lowered where the envelope leaves the constraint surfaces (keep_inside), where gaps between
/// different parts, or to the outer boundary, are too narrow (share_gaps), and where anything still collides (retract_collisions); lowered heights grow back
/// where that is clear. A part with nothing near it keeps its separate envelope.
/// \pre `parts` from whole_parts(), not empty
/// \post as build_envelope()
Envelope joint_envelope(MeshingSite& site, std::span<const WholePart> parts, const PartEnvelopeMaker& make, const RunContext& context);

}  // namespace sterna::volmesh
