// Soups as one mesh without any repair: what later surfaces are compared with.
#pragma once

#include <vector>

#include "geom/mesh/surface_soup.h"
#include "geom/mesh/tri_mesh.h"
#include "surfmesh/stitch/stitch_surface.h"

namespace sterna::surfmesh {

/// All facets in metres, equal coordinates one vertex, patches named as stitch_surface names them. Facets may have any sense and a repeated vertex; edges may
/// have any number of facets.
/// \throws Error(file_malformed) for an index out of range or a coordinate that is not finite; Error(empty_surface) when there is no facet
TriMesh mesh_as_read(const std::vector<SurfaceSoup>& soups, const StitchOptions& options);

}  // namespace sterna::surfmesh
