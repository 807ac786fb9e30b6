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
               .help = "parameter c_t of the curved growth lines: distance from the wall up to which they stay wall-normal; reduced where cell quality would "
                       "suffer; 0: straight lines"},
      Field<O>{.name = "truncate",
               .member = &O::truncate,
               .help = "whether growth lines below full height get fewer layers; auto: if the last cell would be thinner than half of a regular tetrahedron on "
                       "it; always: on all lower lines, so that cells grow as on full lines; never: the layers are only compressed",
               .choices = "never auto always"},
  };
};

}  // namespace sterna
