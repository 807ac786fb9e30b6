#include "io/surface_vtu.h"

#include "io/surface_boundary.h"
#include "io/volume_vtu.h"

namespace sterna::io {

SurfaceSoup read_surface_vtu(const std::filesystem::path& path, const RunContext& context) { return boundary_soup(read_volume_vtu(path, context), path.string()); }

void write_surface_vtu(const TriMesh& mesh, const std::filesystem::path& path, const RunContext& context) { write_volume_vtu(as_boundary(mesh, Winding::kept), path, context); }

}  // namespace sterna::io
