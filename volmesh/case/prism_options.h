// Options of the extrusion of prisms between wall and envelope.
#pragma once

#include <string>

#include "geom/base/schema.h"
#include "volmesh/case/mesh_step.h"

namespace sterna::volmesh {

struct PrismOptions {
  double wall_perpendicularity = 1.0;
  std::string truncate = "never";
};

}  // namespace sterna::volmesh

namespace sterna {

template <>
struct Schema<volmesh::PrismOptions> {
  using O = volmesh::PrismOptions;
  static constexpr std::string_view stage = "prisms";
  static constexpr volmesh::MeshSteps steps = volmesh::k_tetrahedra_step;
  static constexpr std::array fields = {
      Field<O>{.name = "wall_perpendicularity",
               .member = &O::wall_perpendicularity,
               .min = 0.0,
               .max = 1.0,
               .help = "c_t of the layer curves: how far from the wall they stay normal to it; less where cells would suffer; 0 = straight"},
      Field<O>{.name = "truncate",
               .member = &O::truncate,
               .help = "whether lines of less than their full height end with fewer layers; auto: where the last cell would be thinner than half a regular "
                       "tetrahedron on it; always: wherever they are lower, so that heights grow as on full lines; never: compressed only",
               .choices = "never auto always"},
  };
};

}  // namespace sterna
