// Winglets that join their wing round instead of with kinks. sumo's own rule ("detectwinglet") is not documented; this one is ours.
#pragma once

#include "geom/model/section_rows.h"

namespace sterna {

/// From a tip inwards, seen along x: the first panel that leads from a winglet (the panel outside it) to the wing (the panel inside it), where those two
/// enclose at least k_min_winglet_turn and it stands between them, within the outer k_max_winglet_part of the half span. It is replaced by k_winglet_rows rows
/// along elliptic arcs: each point of a section goes from the inner to the outer one along the conic that is tangent to the wing there and to the winglet here.
/// `at_both_ends`: the last row is a tip too. Rows that are there stay. Where no panel fits, nothing changes.
void blend_winglets(WingRows& rows, bool at_both_ends);

inline constexpr double k_min_winglet_turn = 0.5235987755982988;  ///< radians: 30 degrees
inline constexpr double k_max_winglet_part = 0.35;
inline constexpr std::size_t k_winglet_rows = 11;

}  // namespace sterna
