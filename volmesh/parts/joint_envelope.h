// The envelope of a wall some of whose parts were placed: these have theirs made in their own frames and moved with them; then all are made clear of each
// other.
#pragma once

#include <cstddef>
#include <span>
#include <vector>

#include "volmesh/case/placed_part.h"
#include "volmesh/parts/part_envelope.h"
#include "volmesh/site/site.h"

namespace sterna::volmesh {

/// A part all of whose triangles are walls with layers, closed, and where its placement says.
struct WholePart {
  std::size_t part = 0;            ///< of the options' parts
  std::size_t first_triangle = 0;  ///< of the wall
  std::size_t first_vertex = 0;
};
/// The parts of a domain's wall that can have their envelopes made alone. Why others cannot is logged.
std::vector<WholePart> whole_parts(const Domain& domain, std::span<const PlacedPart> parts, const RunContext& context);

/// Steps: envelopes of the parts by `make` (empty: part_envelope()), moved; that of the rest of the wall with the outer boundary around it; then, of all
/// together, heights lowered where the envelope leaves the surfaces that hold it in (keep_inside), where gaps between different parts, or to the outer
/// boundary, are too narrow (share_gaps), and where anything still collides (retract_collisions); what was lowered grows back where that is clear. Where
/// nothing is near, a part keeps the envelope that it has alone.
/// \pre `parts` of whole_parts(), not empty
/// \post as of build_envelope()
Envelope joint_envelope(MeshingSite& site, std::span<const WholePart> parts, const PartEnvelopeMaker& make, const RunContext& context);

}  // namespace sterna::volmesh
