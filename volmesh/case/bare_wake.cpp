#include "volmesh/case/bare_wake.h"

#include <algorithm>

namespace sterna::volmesh {

bool has_bare_wake(const TriMesh& surface, const MeshCase& options) {
  const std::string& shape = options.farfield.farfield_shape;
  if (!options.sources.empty() || !options.wakes.empty() || shape == "none" || shape == "surface") return false;
  return std::none_of(surface.patches.begin(), surface.patches.end(),
                      [](const Patch& patch) { return patch.kind == PatchKind::inflow || patch.kind == PatchKind::outflow; });
}

}  // namespace sterna::volmesh
