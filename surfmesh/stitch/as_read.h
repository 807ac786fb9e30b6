// Soups as one mesh without any repair: the reference for later comparisons.
#pragma once

#include <vector>

#include "geom/mesh/surface_soup.h"
#include "geom/mesh/tri_mesh.h"
#include "surfmesh/stitch/stitch_surface.h"

namespace sterna::surfmesh {

/// Returns all facets in metres, equal coordinates merged to one vertex, patches named as in stitch_surface. Facets may have any sense and a repeated vertex;
/// edges may have any number of facets.
/// \throws Error(file_malformed) for an index out of range or a coordinate that is not finite; Error(empty_surface) when there is no facet
TriMesh mesh_as_read(const std::vector<SurfaceSoup>& soups, const StitchOptions& options);

}  // namespace sterna::surfmesh
