#include "io/surface/surface_cgns.h"

#include "io/mesh/surface_boundary.h"
#include "io/volume/volume_cgns.h"

namespace sterna::io {

SurfaceSoup read_cgns(const std::filesystem::path& path, const RunContext& context) {
  return boundary_soup(read_boundary_cgns(path, context), path.string(), context);
}

void write_cgns(const TriMesh& mesh, const std::filesystem::path& path, const RunContext& context) {
  write_volume_cgns(as_boundary(mesh, Winding::kept), path, context);
}

}  // namespace sterna::io
