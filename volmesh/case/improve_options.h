// Options of the improvement of tetrahedra (improve/improve.h).
#pragma once

#include <numbers>

#include "geom/base/schema.h"
#include "volmesh/case/mesh_step.h"

namespace sterna::volmesh {

struct ImproveOptions {
  double improve_min_angle = 12.0 * std::numbers::pi / 180.0;
  double improve_max_angle = 160.0 * std::numbers::pi / 180.0;
  int improve_rounds = 30;
  double slide_share = 0.2;
};

}  // namespace sterna::volmesh

namespace sterna {

template <>
struct Schema<volmesh::ImproveOptions> {
  using O = volmesh::ImproveOptions;
  static constexpr std::string_view stage = "improve";
  static constexpr volmesh::MeshSteps steps = volmesh::k_finish_step;
  static constexpr std::array fields = {
      Field<O>{.name = "improve_min_angle",
               .member = &O::improve_min_angle,
               .unit = Unit::radian,
               .min = 0.0,
               .max = 0.6,
               .help = "tetrahedra with a smaller dihedral angle are improved"},
      Field<O>{.name = "improve_max_angle",
               .member = &O::improve_max_angle,
               .unit = Unit::radian,
               .min = 2.0,
               .max = 3.14,
               .help = "tetrahedra with a larger dihedral angle are improved"},
      Field<O>{.name = "improve_rounds",
               .member = &O::improve_rounds,
               .min = 0,
               .max = 1000,
               .help = "number of passes over the bad tetrahedra; 0: the mesh stays as the engine made it"},
      Field<O>{.name = "slide_share",
               .member = &O::slide_share,
               .min = 0.0,
               .max = 0.5,
               .help = "share of the layer height by which growth lines may become lower (or, by half of it, higher) after improvement where last prisms and "
                       "tetrahedra do not match; from the second round on 2.5 times this share where a hard limit is violated; 0: never"},
  };
};

}  // namespace sterna
