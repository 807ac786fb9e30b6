// Control surfaces behind open slots as solids of their own. Internal to the wing's builders.
#pragma once

#include <vector>

#include "geom/model/model.h"
#include "geom/model/wing_sides.h"

namespace sterna {

/// The flap (leading edge flap) of a patch with a slot: its part of the wing's own skin, a nose, walls at both ends; not moved yet.
Model make_moving_part(const Wing& wing, const WingPatch& patch, const std::vector<WingSides>& panels, bool is_blunt);

}  // namespace sterna
