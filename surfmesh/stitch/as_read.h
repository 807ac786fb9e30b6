// Joins soups to one mesh without any repair, as a reference for later comparisons.
#pragma once

#include <vector>

#include "geom/mesh/surface_soup.h"
#include "geom/mesh/tri_mesh.h"
#include "surfmesh/stitch/stitch_surface.h"

namespace sterna::surfmesh {

/// Returns all facets in metres. Equal coordinates become one vertex; patches are named as in stitch_surface. Facets may have any orientation and repeated
/// vertices; edges may have any number of facets.
/// \throws Error(file_malformed) for an index out of range or a coordinate that is not finite; Error(empty_surface) if there is no facet
TriMesh mesh_as_read(const std::vector<SurfaceSoup>& soups, const StitchOptions& options);

}  // namespace sterna::surfmesh
