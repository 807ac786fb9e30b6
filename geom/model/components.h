// Models of single components: closed solids with named faces, each edge shared by its two faces. The meaning of bodies, wings and caps follows sumo; the
// surfaces are our own.
#pragma once

#include <string>

#include "geom/base/run_context.h"
#include "geom/model/aircraft.h"
#include "geom/model/model.h"

namespace sterna {

/// Names of the patches at a body's ends where engines begin or end. An empty name stands for the name of the body.
struct BodyEnds {
  std::string nose;
  std::string tail;
};

/// Builds a smooth surface through the frames, split into right and left half, with flat or domed ends, or an inlet lip down to a flat fan face. `map` places
/// it in the aircraft (after the body's own placement) and may mirror it. Strip caps are half ellipses from the right to the left half.
/// \throws Error(bad_argument) naming the frame that makes the surface impossible
Model make_body(const Body& body, ComponentKind kind, const BodyEnds& ends = {}, const Transform& map = {});

/// Builds an upper and a lower side between every pair of sections (cubic wings: between breaks), a trailing edge face if the edge is blunt, and flat or round
/// tips. Patches are cut out of these faces, on the same surfaces. If some trailing edges are sharp and others blunt, all are made sharp. Includes winglets
/// with their blend (winglet_blend.h).
Model make_wing(const Wing& wing, const Transform& map = {});

/// Builds rings of cowls and the center body, each as a closed solid. Sections are splined around the axis through points every k_cowl_angles-th of a turn (a
/// circle is approximated to 3e-6 of its radius). The center body is closed at both ends: an end whose radius is not zero is closed by a flat face.
Model make_nacelle(const CowlNacelle& nacelle, const Transform& map = {});

/// Builds all components of an aircraft in parallel, each as a separate solid; they are not united. Mirror images are included ("RightPod" -> "LeftPod", "pod"
/// -> "podLeft"). Wings include their deflections (deflection.h). Control surfaces that are not deflected give their name and the role control to their part of
/// the skin. Fan faces and nozzles of engines are named <engine>Intake and <engine>Exhaust (numbered if there are several).
Model make_components(const Aircraft& aircraft, const RunContext& context);

}  // namespace sterna
