// Actuator discs: flat sheets without thickness inside the fluid, two patches back to back, where a solver puts the thrust of a propeller.
#pragma once

#include <string>

#include "geom/base/schema.h"
#include "geom/base/vec3.h"

namespace sterna::volmesh {

/// A disc, or a ring around a hub. Where walls with layers go through it within its radii, it ends on them (domain/cut_discs.h).
struct ActuatorDisc {
  std::string name = "disc";  ///< patch on the upstream side; the downstream side is <name>.back
  Point center;               ///< m
  Vec3 axis{1.0, 0.0, 0.0};   ///< the way the flow goes through; any length
  double radius = 0.0;        ///< m
  double inner_radius = 0.0;  ///< m; 0: a full disc
  double edge = k_automatic;  ///< m, longest edge
};

inline constexpr double k_disc_edge = 1.0 / 12.0;  ///< of the radius: longest edge, where none is given

}  // namespace sterna::volmesh
