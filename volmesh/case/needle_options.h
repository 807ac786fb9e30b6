// Options for sliver triangles of the input wall (domain/split_needles.h).
#pragma once

#include <numbers>

#include "geom/base/schema.h"
#include "volmesh/case/mesh_step.h"

namespace sterna::volmesh {

struct NeedleOptions {
  double split_needles = 5.0 * std::numbers::pi / 180.0;
  double needle_budget = 0.0;
  double flip_angle = 1.0 * std::numbers::pi / 180.0;
};

}  // namespace sterna::volmesh

namespace sterna {

template <>
struct Schema<volmesh::NeedleOptions> {
  using O = volmesh::NeedleOptions;
  static constexpr std::string_view stage = "needles";
  static constexpr volmesh::MeshSteps steps = volmesh::k_envelope_step;
  static constexpr std::array fields = {
      Field<O>{.name = "split_needles",
               .member = &O::split_needles,
               .unit = Unit::radian,
               .min = 0.0,
               .max = 0.35,
               .help = "triangles of walls with layers that have a smaller angle are flipped, and split where needle_budget says so, before the layer is made; "
                       "0: never"},
      Field<O>{.name = "needle_budget",
               .member = &O::needle_budget,
               .min = 0.0,
               .max = 100.0,
               .help = "largest number of triangles that splitting adds, over those of the walls with layers; 0: edges are flipped only"},
      Field<O>{.name = "flip_angle",
               .member = &O::flip_angle,
               .unit = Unit::radian,
               .min = 0.0,
               .max = 0.35,
               .help = "edges at which the wall turns by less may be flipped for that; 0: none, and needles stay as they are"},
  };
};

}  // namespace sterna
