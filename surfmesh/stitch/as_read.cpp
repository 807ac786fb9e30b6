#include "surfmesh/stitch/as_read.h"

#include "surfmesh/stitch/patches.h"
#include "surfmesh/stitch/weld.h"

namespace sterna::surfmesh {

TriMesh mesh_as_read(const std::vector<SurfaceSoup>& soups, const StitchOptions& options) {
  StitchReport unused;
  WorkingSurface surface = weld_exact(soups, options, unused);
  for (Vec3& p : surface.points) p = surface.metres(p);
  surface.to_metres = 1.0;
  return make_mesh(surface, clean_patch_names(soups));
}

}  // namespace sterna::surfmesh
