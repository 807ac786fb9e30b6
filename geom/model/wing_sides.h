// Upper and lower side of a wing between two breaks, and locations on them. Internal to the wing's builders.
#pragma once

#include <vector>

#include "geom/model/aircraft.h"
#include "geom/model/section_rows.h"
#include "geom/model/surface.h"

namespace sterna {

/// Upper and lower side. u on both sides runs from 0 at the trailing edge to 1 at the leading edge, v along the span.
struct WingSides : WingPanel {
  NurbsSurfaceForm upper, lower;
  SurfacePtr upper_surface, lower_surface;
};
WingSides wing_sides(WingPanel panel);
/// Returns the panel that contains a location; at the border between two panels: the one before it if `is_before`.
const WingSides& panel_at(const std::vector<WingSides>& panels, double location, bool is_before);

/// Returns the ruled surface between both sides at the trailing edge: u from the upper to the lower side.
SurfacePtr trailing_edge_surface(const WingSides& sides);

double first_location(const WingPatch& patch);
double last_location(const WingPatch& patch);
/// Returns the point at a location on a polyline, which is straight between its points.
/// \pre `location` within them
WingPatch::Location crossing_at(const std::vector<WingPatch::Location>& line, double location);
/// A patch's hinge in a section: the points where it crosses the sides, their midpoint, and the unit direction from there into the fixed part of the wing.
struct HingeSection {
  Point upper, lower, middle;
  Vec3 ahead;
};
HingeSection hinge_section(const WingSides& sides, const WingPatch& patch, double location);
void add_sorted(std::vector<double>& values, double value);

}  // namespace sterna
