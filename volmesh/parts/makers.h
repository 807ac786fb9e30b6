// Callbacks of a run. They make envelopes and return the true surface of walls.
#pragma once

#include "volmesh/layer/true_surface.h"
#include "volmesh/parts/part_envelope.h"
#include "volmesh/parts/warm_start.h"

namespace sterna::volmesh {

/// Callbacks; each may be empty.
struct Makers {
  PartEnvelopeMaker part_envelope;  ///< makes the envelopes of placed parts; empty: part_envelope()
  WallEnvelopeMaker wall_envelope;  ///< makes the envelope of a wall without such parts; empty: build_envelope()
  TrueSurface true_surface;  ///< returns the positions of new wall vertices when boundary triangles are split; empty: new vertices stay on their triangle
};

}  // namespace sterna::volmesh
