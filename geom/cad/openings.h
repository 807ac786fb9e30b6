// Inside geom/cad only: boundaries of open shells that healing may close.
#pragma once

#include "geom/cad/occt_shape.h"
#include "geom/cad/read_cad.h"

namespace sterna::cad {

/// Returns the largest gap, metres, between free edges of different faces that appear to be the same edge: same ends, and distance nowhere greater than
/// k_pair_gap of their length. Returns 0 if there is no such pair, or if that gap is close to the length of the shortest free edge above `small`.
double gap_of_pairs(const std::vector<TopoDS_Shape>& shapes, double small);
inline constexpr double k_pair_gap = 0.01;

/// Closes flat openings (closed loops of free edges in a plane) of open shells and loose faces with one plane face each, reported in `report.repaired`. The
/// component of the face is that of the shell, its name "<component> cap".
void cap_openings(LabelledShape& labelled, CadReport& report);

}  // namespace sterna::cad
