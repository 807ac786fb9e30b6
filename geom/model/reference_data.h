// Reference data of aircraft: what coefficients are made with. From the geometry itself, for comparison with published values.
#pragma once

#include <string>

#include "geom/model/aircraft.h"

namespace sterna {

/// From the sections, both halves of a symmetric wing; leading and trailing edges straight between sections. Areas and chords in the projection on
/// x and the span direction of each panel (dihedral is unrolled), span along y and z.
struct WingReference {
  std::string name;
  double span = 0.0;                    ///< largest extent at right angles to x, of the section chords, m
  double area = 0.0;                    ///< planform, m2
  double projected_area = 0.0;          ///< planform seen from above, m2
  double mean_geometric_chord = 0.0;    ///< area / span, m
  double mean_aerodynamic_chord = 0.0;  ///< integral of c2 / area, m
  Point aerodynamic_chord_start;        ///< leading edge of the mean aerodynamic chord, in the plane of symmetry for symmetric wings
  double aspect_ratio = 0.0;
};
WingReference wing_reference(const Wing& wing);

}  // namespace sterna
