// Limits on the machine resources of a mesh (volmesh/forecast.h).
#pragma once

#include "geom/base/schema.h"
#include "volmesh/case/mesh_step.h"

namespace sterna::volmesh {

struct LimitOptions {
  double max_memory = k_automatic;
  bool force = false;
};

}  // namespace sterna::volmesh

namespace sterna {

template <>
struct Schema<volmesh::LimitOptions> {
  using O = volmesh::LimitOptions;
  static constexpr std::string_view stage = "limits";
  static constexpr volmesh::MeshSteps steps = volmesh::k_envelope_step | volmesh::k_tetrahedra_step;
  static constexpr std::array fields = {
      Field<O>{.name = "max_memory",
               .member = &O::max_memory,
               .unit = Unit::byte,
               .min = 1e6,
               .help = "largest memory; if the mesh is expected to need more, the run ends with an error before meshing",
               .automatic = "free memory of the machine"},
      Field<O>{.name = "force", .member = &O::force, .help = "continue with a warning if the mesh is expected to need more memory"},
  };
};

}  // namespace sterna
