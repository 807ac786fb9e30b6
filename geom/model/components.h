// Models of single components: closed solids with named faces, each edge shared by its two faces. Sources: sumo's bodies, wings and caps
// (their meaning; our own surfaces).
#pragma once

#include <string>

#include "geom/base/run_context.h"
#include "geom/model/aircraft.h"
#include "geom/model/model.h"

namespace sterna {

/// Names of the patches at a body's ends where engines begin or end; empty: the body's own name.
struct BodyEnds {
  std::string nose;
  std::string tail;
};

/// Smooth surface through the frames, right and left half; flat or domed ends, or an inlet lip down to a flat fan face. `map` places it in the aircraft
/// (after the body's own placement) and may mirror it. Strip caps are half ellipses from the right to the left half.
/// \throws Error(bad_argument) naming the frame that makes it impossible
Model make_body(const Body& body, ComponentKind kind, const BodyEnds& ends = {}, const Transform& map = {});

/// Upper and lower side between every pair of sections (wings that are cubic: between breaks), a trailing edge face where that is blunt, flat or round
/// tips; patches cut out of these faces, on the same surfaces. Sections whose trailing edges are sharp and blunt in turn are all made sharp. Winglets with
/// their blend (winglet_blend.h).
Model make_wing(const Wing& wing, const Transform& map = {});

/// Rings of cowls and the center body, a closed solid each. Sections are splined around the axis through points every k_cowl_angles-th of a turn (a circle
/// is met to 3e-6 of its radius). The center body is open at no end: where its radius does not end at nothing it is flat.
Model make_nacelle(const CowlNacelle& nacelle, const Transform& map = {});

/// All components of an aircraft side by side, mirror images included ("RightPod" -> "LeftPod", "pod" -> "podLeft"), each a
/// solid of its own; not united. Wings with their deflections (deflection.h); control surfaces that are not deflected give their name and the role control
/// to the part of the skin where they are. Engines name their fan faces and nozzles
/// <engine>Intake and <engine>Exhaust (numbered where there are several).
Model make_components(const Aircraft& aircraft, const RunContext& context);

}  // namespace sterna
