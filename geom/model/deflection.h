// Deflected control surfaces as geometry.
#pragma once

#include <string>
#include <vector>

#include "geom/model/aircraft.h"

namespace sterna {

/// Converts a control surface whose hinge is given from the root: span 0 at the root, 1 at the tip, relative to the length seen along the flow; chord as usual.
/// The root of a symmetric wing is its centre (the result lies on the right half). For other wings it is the end nearer to y = 0 if they have a mirror image,
/// else the end with the longer chord. Points may be in any order.
/// \throws Error(bad_argument) for fewer than 2 points
ControlSurface from_root(const Wing& wing, ControlSurface surface);

/// Returns the wing with sealed, blended control surfaces and their patches.
/// Between the hinge points every section is rotated about the hinge line: behind the hinge, for leading edge surfaces ahead of it, for all-moving surfaces
/// completely. The bend extends over the thickness of the section there, so that upper and lower side stay smooth. Beyond the ends of the hinge the deflection
/// fades to zero over the length `fairing`; this part belongs to the patch of the wing. Points that are not rotated stay unchanged: to the bit in sections of
/// the wing, to rounding in added sections, and in wings that are cubic along the span to the accuracy of k_cubic_rows rows between two sections. Hinge points
/// within 1e-4 of the span of a section or of another surface's end are moved there. In symmetric wings `other_side` adds the image on the other half.
/// Surfaces with an open gap are separate solids, rotated about the straight line between the ends of their hinge (points between are ignored). The wing's skin
/// has a cut-out whose cove is an arc about the hinge, `slot` wider than the round (or flat) nose of the moving part. Walls close both ends, `end_gap` apart;
/// the skin of the part is that of the wing. All-moving surfaces are cut off by walls; a surface that reaches a tip includes the tip. After large rotations
/// about swept hinges a part may touch the wing: the union reports that.
/// Deflections of zero angle only add patches; the result then equals `wing` apart from the patches. Otherwise the result has a section at every location where
/// the shape changes, from tip to tip, and is no longer symmetric.
/// \throws Error(bad_argument) for surfaces of other wings, hinge points out of order, angles beyond 60 degrees, surfaces that overlap on the same edge (with
/// their fairings, if they are deflected), open surfaces that reach a tip, have no room for the slot, or whose straight hinge is farther from the middle of a
/// section than half of it
Wing deflected(const Wing& wing, const std::vector<Deflection>& deflections);

/// Returns the deflections with ends moved inwards where fairings and end gaps of neighbours (or of a surface and a patch) would overlap. Each surface is moved
/// by half of the overlap; patches are not moved. Hinges stay on their lines. `deflected` rejects any remaining overlap.
std::vector<Deflection> with_room_between(const Wing& wing, std::vector<Deflection> deflections);

/// Returns the deflection's image. It has the name given by image_name, the angle given by `other_side` (none: zero angle), and an unchanged hinge.
Deflection image_of(const Deflection& deflection);

/// Number of rows between two sections of a bent cubic wing.
inline constexpr int k_cubic_rows = 8;

}  // namespace sterna
