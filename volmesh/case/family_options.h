// Members of a mesh family: finer and coarser versions of the same mesh.
#pragma once

#include <string>

#include "geom/base/schema.h"
#include "volmesh/case/mesh_step.h"

namespace sterna::volmesh {

/// Names of the family members and their refinement factors. The edge lengths of consecutive members differ by a factor of 1.5 in each direction and their
/// nodes by 3.4, as in the workshops since DPW-4.
inline constexpr std::string_view k_family_names = "extra_coarse=0.4444444444444444 coarse=0.6666666666666666 medium=1 fine=1.5 extra_fine=2.25";

struct FamilyOptions {
  double refinement = 1.0;
  std::string family_wake = "automatic";
};

}  // namespace sterna::volmesh

namespace sterna {

template <>
struct Schema<volmesh::FamilyOptions> {
  using O = volmesh::FamilyOptions;
  static constexpr std::string_view stage = "family";
  static constexpr volmesh::MeshSteps steps = volmesh::k_envelope_step;
  static constexpr std::array fields = {
      Field<O>{.name = "refinement",
               .member = &O::refinement,
               .min = 0.01,
               .max = 100.0,
               .help = "refinement factor f of a mesh family member: divides first heights and the sizes of tetrahedra, sources and farfield by f, multiplies "
                       "the number of layers by f, and takes growth to the power 1/f; give the surface mesh the same refinement",
               .choices = volmesh::k_family_names},
      Field<O>{.name = "family_wake",
               .member = &O::family_wake,
               .help = "adds the source wake{ wall } if no source is given; the edge lengths of that source are divided by the refinement factor f, so that "
                       "the wakes of the members differ by the same factor; automatic: added if refinement is given",
               .choices = "automatic on off"},
  };
};

}  // namespace sterna
