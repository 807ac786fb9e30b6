// Inside geom/cad only: borders of open shells that healing may close.
#pragma once

#include "geom/cad/occt_shape.h"
#include "geom/cad/read_cad.h"

namespace sterna::cad {

/// Largest gap, metres, between free edges of different faces that are one edge as far as anyone can tell: same ends, and nowhere farther apart than
/// k_pair_gap of their length. 0 where there is no such pair, or where that gap comes near to the length of the shortest free edge above `small`.
double gap_of_pairs(const std::vector<TopoDS_Shape>& shapes, double small);
inline constexpr double k_pair_gap = 0.01;

/// Closes flat openings (closed loops of free edges in a plane) of open shells and loose faces with a plane face each, told in `report.mended`. Its component
/// is that of the shell, its name "<component> cap".
void cap_openings(LabelledShape& labelled, CadReport& report);

}  // namespace sterna::cad
