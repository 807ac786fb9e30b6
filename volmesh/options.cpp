#include "volmesh/volume_mesh.h"

namespace sterna::volmesh {

OptionTable options_of(VolumeMeshOptions& options) {
  OptionTable table;
  const auto add = [&](OptionTable stage) {
    for (Option& option : stage) table.push_back(std::move(option));
  };
  add(sterna::options_of(options.envelope));
  add(sterna::options_of(options.prisms));
  add(sterna::options_of(options.farfield));
  add(sterna::options_of(options.size));
  add(sterna::options_of(options.tetrahedra));
  add(sterna::options_of(options.improve));
  return table;
}

}  // namespace sterna::volmesh
