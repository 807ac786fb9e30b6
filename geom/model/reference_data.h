// Reference data of aircraft for force coefficients, computed from the geometry for comparison with published values.
#pragma once

#include <string>

#include "geom/model/aircraft.h"

namespace sterna {

/// Reference data of a wing, computed from its sections. They include both halves of a symmetric wing. Leading and trailing edges are straight between
/// sections. The span is along y for wings and V tails, along z for wings that are higher than wide, such as fins. Area, chords and aspect ratio are those of
/// the planform projected onto the plane of x and the span direction, as in published wing areas: dihedral shortens span and area by the same factor, and a
/// vertical winglet adds nothing to either.
struct WingReference {
  std::string name;
  double span = 0.0;                    ///< extent of the section chords along the span direction, m
  double area = 0.0;                    ///< planform area in the plane of x and the span direction, m2; the reference area of coefficients
  double projected_area = 0.0;          ///< planform seen from above, m2
  double unrolled_area = 0.0;           ///< planform of the panels laid flat, m2: larger than `area` because of dihedral and winglets
  double mean_geometric_chord = 0.0;    ///< area / span, m
  double mean_aerodynamic_chord = 0.0;  ///< integral of c^2 over the span, divided by area, m
  Point aerodynamic_chord_start;        ///< leading edge of the mean aerodynamic chord, in the plane of symmetry for symmetric wings
  double aspect_ratio = 0.0;            ///< span^2 / area
};
WingReference wing_reference(const Wing& wing);

}  // namespace sterna
