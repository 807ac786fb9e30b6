#include "io/surface/surface_tau.h"

#include "io/mesh/surface_boundary.h"
#include "io/volume/volume_tau.h"

namespace sterna::io {

SurfaceSoup read_tau(const std::filesystem::path& path, const RunContext& context) {
  return boundary_soup(read_boundary_tau(path, context), path.string(), context);
}

void write_tau(const TriMesh& mesh, const std::filesystem::path& path, const RunContext& context) {
  write_volume_tau(as_boundary(mesh, Winding::kept), path, context);
}

}  // namespace sterna::io
