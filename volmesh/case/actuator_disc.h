// Actuator discs: baffles (zero-thickness surfaces) inside the fluid, with two patches back to back. A solver applies the thrust of a propeller there.
#pragma once

#include <string>

#include "geom/base/schema.h"
#include "geom/base/vec3.h"

namespace sterna::volmesh {

/// A disc, or a ring around a hub. If walls with layers cross the disc between its radii, the disc ends on these walls (domain/cut_discs.h).
struct ActuatorDisc {
  std::string name = "disc";   ///< patch on the upstream side; the downstream side is <name>.back
  Point center = k_no_vector;  ///< m; required
  Vec3 axis{1.0, 0.0, 0.0};    ///< flow direction through the disc, of any length
  double radius = 0.0;         ///< m; required
  double inner_radius = 0.0;   ///< m; 0: a full disc
  double edge = k_automatic;   ///< m, longest edge of the disc's triangles
};

inline constexpr double k_disc_edge = 1.0 / 12.0;  ///< default longest edge, as a fraction of the radius

}  // namespace sterna::volmesh

namespace sterna {

template <>
struct Schema<volmesh::ActuatorDisc> {
  using O = volmesh::ActuatorDisc;
  static constexpr std::string_view stage = "actuator_disc";
  static constexpr std::array fields = {
      Field<O>{.name = "name", .member = &O::name, .help = "name of the patch on the upstream side; the downstream patch is NAME.back"},
      Field<O>{.name = "center", .member = &O::center, .unit = Unit::metre, .help = "centre of the disc", .required = true},
      Field<O>{.name = "axis", .member = &O::axis, .help = "direction of the flow through the disc, of any length"},
      Field<O>{.name = "radius",
               .member = &O::radius,
               .unit = Unit::metre,
               .min = 1e-12,
               .help = "outer radius: in the fluid, or inside the body around the disc (a duct that the disc fills)",
               .required = true},
      Field<O>{.name = "inner_radius",
               .member = &O::inner_radius,
               .unit = Unit::metre,
               .min = 0.0,
               .help = "inner radius of a ring; 0: a full disc, or a disc that ends on walls with layers that pass through it (a spinner, a hub)"},
      Field<O>{.name = "edge",
               .member = &O::edge,
               .unit = Unit::metre,
               .min = 1e-12,
               .help = "longest edge of the disc's triangles",
               .automatic = "a twelfth of the radius"},
  };
};

}  // namespace sterna
