// Deflected control surfaces as geometry.
#pragma once

#include <string>
#include <vector>

#include "geom/model/aircraft.h"

namespace sterna {

/// Converts a control surface whose hinge is given from the root (span 0 at the root, 1 at the tip, relative to the length seen along the flow; chord as
/// usual). The root of a symmetric wing is its centre (the result lies on the right half). For other wings it is the end nearer to y = 0 if they have a mirror
/// image, else the end with the longer chord. Points may be in any order.
/// \throws Error(bad_argument) for fewer than 2 points
ControlSurface from_root(const Wing& wing, ControlSurface surface);

/// The wing with sealed, blended control surfaces and with their patches. Between the hinge points every section is turned about the hinge line behind the
/// hinge (before it; all of it), over a knee as wide as the section is thick there, so upper and lower side stay smooth; beside its ends the deflection fades
/// over `fairing`, within the wing's own patch. Points that do not turn stay (to the bit in sections of the wing, to rounding in those that are added; of wings
/// that are cubic along the span: as well as k_cubic_rows rows between two sections say). Hinge points within 1e-4 of the span of a section or of another
/// surface's end are moved there. Of symmetric wings `other_side` adds the image on the other half. Surfaces with an open gap are solids of their own, turned
/// about the straight line between their hinge's ends (points between do not count): a cut-out in the wing's skin, whose cove is an arc about the hinge, `slot`
/// wider than the moving part's round (or flat) nose; walls at both ends, `end_gap` apart; the part's skin is the wing's own. All-moving surfaces are cut off
/// by walls; at a tip they take it with them. Turned about swept hinges by large angles a part may touch the wing: a union tells. Deflections of no angle only
/// add patches: then the result equals `wing` apart from them; else it has a section for every place where the shape changes, from tip to tip, and is not
/// symmetric any more.
/// \throws Error(bad_argument) for surfaces of other wings, hinge points out of order, angles beyond 60 degrees, surfaces that overlap on the same edge (with
/// their fairings, where they are deflected), open ones that reach a tip, have no room for the slot, or whose straight hinge leaves the middle of a section by
/// more than half of it
Wing deflected(const Wing& wing, const std::vector<Deflection>& deflections);

/// As the argument, with ends moved inwards where fairings and end gaps of neighbours (or of a surface and a patch) would overlap: each surface by half of the
/// overlap, a patch not at all. Hinges stay on their lines. `deflected` rejects any remaining overlap.
std::vector<Deflection> with_room_between(const Wing& wing, std::vector<Deflection> deflections);

/// Returns the deflection's image: named by image_name, with the angle given by `other_side` (none: zero angle) and an unchanged hinge.
Deflection image_of(const Deflection& deflection);

/// Number of rows between two sections of a bent cubic wing.
inline constexpr int k_cubic_rows = 8;

}  // namespace sterna
