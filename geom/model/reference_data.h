// Reference data of aircraft: what coefficients are made with. From the geometry itself, for comparison with published values.
#pragma once

#include <string>

#include "geom/model/aircraft.h"

namespace sterna {

/// From the sections, both halves of a symmetric wing; leading and trailing edges straight between sections. The span is along y for wings and V tails, along z
/// for those that are higher than wide, as fins. Area, chords and aspect ratio are those of the planform projected on the plane of x and the span direction,
/// as wing areas are published: dihedral shortens span and area alike, and a vertical winglet adds nothing to either.
struct WingReference {
  std::string name;
  double span = 0.0;                    ///< extent of the section chords along it, m
  double area = 0.0;                    ///< planform in the plane of x and the span direction, m2: the reference area of coefficients
  double projected_area = 0.0;          ///< planform seen from above, m2
  double unrolled_area = 0.0;           ///< planform of the panels laid flat, m2: larger than `area` by dihedral and winglets
  double mean_geometric_chord = 0.0;    ///< area / span, m
  double mean_aerodynamic_chord = 0.0;  ///< integral of c2 over the span / area, m
  Point aerodynamic_chord_start;        ///< leading edge of the mean aerodynamic chord, in the plane of symmetry for symmetric wings
  double aspect_ratio = 0.0;            ///< span^2 / area
};
WingReference wing_reference(const Wing& wing);

}  // namespace sterna
