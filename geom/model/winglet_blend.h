// Winglets joined to their wing by a round blend without kinks. sumo's own rule ("detectwinglet") is not documented; this rule is our own.
#pragma once

#include "geom/model/section_rows.h"

namespace sterna {

/// Searches from a tip inwards, seen along x, for the first panel that leads from a winglet (the panel outboard of it) to the wing (the panel inboard of it).
/// Winglet and wing must enclose an angle of at least k_min_winglet_turn, the panel must be at an angle between them, and it must lie within the outer
/// k_max_winglet_part of the half span. It is replaced by k_winglet_rows rows along elliptic arcs: each point of a section moves from the inner to the outer
/// section along the conic that is tangent to the wing at one end and to the winglet at the other. `at_both_ends`: the last row is also a tip. Existing rows
/// are kept. If no panel qualifies, nothing is changed.
void blend_winglets(WingRows& rows, bool at_both_ends);

inline constexpr double k_min_winglet_turn = 0.5235987755982988;  ///< radians: 30 degrees
inline constexpr double k_max_winglet_part = 0.35;
inline constexpr std::size_t k_winglet_rows = 11;

}  // namespace sterna
