// Control surfaces behind open slots as separate solids. Internal to the wing's builders.
#pragma once

#include <vector>

#include "geom/model/model.h"
#include "geom/model/wing_sides.h"

namespace sterna {

/// Builds the trailing or leading edge flap of a patch with a slot: its part of the wing's skin, a nose, and walls at both ends. The part is not yet moved.
Model make_moving_part(const Wing& wing, const WingPatch& patch, const std::vector<WingSides>& panels, bool is_blunt);

}  // namespace sterna
