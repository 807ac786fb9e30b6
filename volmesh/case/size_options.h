// Options of the size field (tetra/size_field.h).
#pragma once

#include "geom/base/schema.h"
#include "volmesh/case/mesh_step.h"

namespace sterna::volmesh {

struct SizeFieldOptions {
  double size_growth = 1.3;
  double size_max = k_automatic;
};

}  // namespace sterna::volmesh

namespace sterna {

template <>
struct Schema<volmesh::SizeFieldOptions> {
  using O = volmesh::SizeFieldOptions;
  static constexpr std::string_view stage = "size";
  static constexpr volmesh::MeshSteps steps = volmesh::k_tetrahedra_step;
  static constexpr std::array fields = {
      Field<O>{.name = "size_growth",
               .member = &O::size_growth,
               .min = 1.02,
               .max = 2.0,
               .help = "largest ratio of the sizes of neighbouring tetrahedra away from boundary and sources"},
      Field<O>{.name = "size_max",
               .member = &O::size_max,
               .unit = Unit::metre,
               .min = 1e-12,
               .help = "longest edge of tetrahedra in the volume",
               .automatic = "no limit"},
  };
};

}  // namespace sterna
