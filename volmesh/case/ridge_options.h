// Options for sharp convex edges of walls with layers (domain/open_ridges.h).
#pragma once

#include <numbers>
#include <string>

#include "geom/base/schema.h"
#include "volmesh/case/mesh_step.h"

namespace sterna::volmesh {

struct RidgeOptions {
  std::string open_ridges = "never";
  double open_angle = 100.0 * std::numbers::pi / 180.0;
  double fan_angle = 30.0 * std::numbers::pi / 180.0;
  bool is_on() const { return open_ridges == "always"; }
};

}  // namespace sterna::volmesh

namespace sterna {

template <>
struct Schema<volmesh::RidgeOptions> {
  using O = volmesh::RidgeOptions;
  static constexpr std::string_view stage = "ridges";
  static constexpr volmesh::MeshSteps steps = volmesh::k_envelope_step;
  static constexpr std::array fields = {
      Field<O>{.name = "open_ridges",
               .member = &O::open_ridges,
               .help = "whether layers get several normals along sharp convex edges (trailing edges, tips); never: one normal everywhere",
               .choices = "never always"},
      Field<O>{.name = "open_angle",
               .member = &O::open_angle,
               .unit = Unit::radian,
               .min = 0.7,
               .max = 3.1,
               .help = "convex edges at which the wall turns by more than this angle get several normals; a larger value opens fewer edges"},
      Field<O>{.name = "fan_angle",
               .member = &O::fan_angle,
               .unit = Unit::radian,
               .min = 0.15,
               .max = 1.1,
               .help = "largest angle between two normals of one edge; a smaller value makes more cells around the edge"},
  };
};

}  // namespace sterna
