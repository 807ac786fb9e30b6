// Upper and lower side of a wing between two breaks, and places on them. Internal to the wing's builders.
#pragma once

#include <vector>

#include "geom/model/aircraft.h"
#include "geom/model/section_rows.h"
#include "geom/model/surface.h"

namespace sterna {

/// u: 0 trailing edge .. 1 leading edge on both; v along the span.
struct WingSides : WingPanel {
  NurbsSurfaceForm upper, lower;
  SurfacePtr upper_surface, lower_surface;
};
WingSides wing_sides(WingPanel panel);
/// The panel that a place is in; at a border between two: the one before it where `is_before`.
const WingSides& panel_at(const std::vector<WingSides>& panels, double place, bool is_before);

/// Ruled between both sides at the trailing edge: u from the upper to the lower one.
SurfacePtr trailing_edge_surface(const WingSides& sides);

double first_place(const WingPatch& patch);
double last_place(const WingPatch& patch);
/// On a line through places; between them straight.
/// \pre `place` within them
WingPatch::Place crossing_at(const std::vector<WingPatch::Place>& line, double place);
/// A patch's hinge in a section: where it crosses the sides, the middle between, and the unit direction from there into the wing that stays.
struct HingeSection {
  Point upper, lower, middle;
  Vec3 ahead;
};
HingeSection hinge_section(const WingSides& sides, const WingPatch& patch, double place);
void add_sorted(std::vector<double>& values, double value);

}  // namespace sterna
