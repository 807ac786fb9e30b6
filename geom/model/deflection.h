// Deflected control surfaces as geometry: the wing itself is bent behind (or before) its hinge line, without gaps.
#pragma once

#include <vector>

#include "geom/model/aircraft.h"

namespace sterna {

struct Deflection {
  ControlSurface surface;
  double angle = 0.0;   ///< radians; positive: trailing edge down (leading edge flaps: leading edge down; all-moving: nose up)
  double fairing = k_automatic_fairing;  ///< metres along the span over which it returns to the wing beside its ends; must be positive
  static constexpr double k_automatic_fairing = -1.0;  ///< a tenth of the mean chord at its ends
};

/// The wing with sealed, blended control surfaces: between the hinge points every section is turned about the hinge line behind the hinge (before it; all of
/// it), over a knee as wide as the section is thick there, so upper and lower side stay smooth; beside its ends the deflection fades over `fairing`.
/// All other points stay (to the bit in sections of the wing, to rounding in those that are added). Deflections of no angle change nothing: then the result equals `wing`.
/// The result has a section for every place where the shape changes, from tip to tip, and is not symmetric any more.
/// \throws Error(bad_argument) for surfaces of other wings, hinge points out of order, angles beyond 60 degrees, deflections that overlap along the span on the
/// same edge; Error(unsupported_format) for wings that are cubic along the span
Wing deflected(const Wing& wing, const std::vector<Deflection>& deflections);

}  // namespace sterna
