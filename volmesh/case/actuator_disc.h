// Actuator discs: baffles (zero-thickness surfaces) inside the fluid, with two patches back to back. A solver applies the thrust of a propeller there.
#pragma once

#include <string>

#include "geom/base/schema.h"
#include "geom/base/vec3.h"

namespace sterna::volmesh {

/// A disc, or a ring around a hub. If walls with layers cross the disc between its radii, the disc ends on these walls (domain/cut_discs.h).
struct ActuatorDisc {
  std::string name = "disc";  ///< patch on the upstream side; the downstream side is <name>.back
  Point center;               ///< m
  Vec3 axis{1.0, 0.0, 0.0};   ///< flow direction through the disc, of any length
  double radius = 0.0;        ///< m
  double inner_radius = 0.0;  ///< m; 0: a full disc
  double edge = k_automatic;  ///< m, longest edge of the disc's triangles
};

inline constexpr double k_disc_edge = 1.0 / 12.0;  ///< default longest edge, as a fraction of the radius

}  // namespace sterna::volmesh
