// What a run calls back for: who makes envelopes, and where walls really are.
#pragma once

#include "volmesh/layer/true_surface.h"
#include "volmesh/parts/part_envelope.h"
#include "volmesh/parts/warm_start.h"

namespace sterna::volmesh {

/// Each may be empty.
struct Makers {
  PartEnvelopeMaker part_envelope;  ///< makes the envelopes of placed parts; empty: part_envelope()
  WallEnvelopeMaker wall_envelope;  ///< makes the envelope of a wall without such parts; empty: build_envelope()
  TrueSurface true_surface;         ///< where new wall vertices go when boundary triangles are split; empty: they stay on their triangle
};

}  // namespace sterna::volmesh
