#include "io/surface/surface_vtkhdf.h"

#include "io/mesh/surface_boundary.h"
#include "io/volume/volume_vtkhdf.h"

namespace sterna::io {

SurfaceSoup read_surface_vtkhdf(const std::filesystem::path& path, const RunContext& context) {
  return boundary_soup(read_boundary_vtkhdf(path, context), path.string(), context);
}

void write_surface_vtkhdf(const TriMesh& mesh, const std::filesystem::path& path, const RunContext& context) {
  write_volume_vtkhdf(as_boundary(mesh, Winding::kept), path, context);
}

}  // namespace sterna::io
