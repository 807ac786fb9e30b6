// Halves of surfaces, and the bodies that they are halves of.
#pragma once

#include "geom/mesh/tri_mesh.h"

namespace sterna::test {

/// Returns the part of a closed surface with coordinate `axis` >= `value`. New vertices lie exactly on the plane. Vertices near the plane (a third of their
/// shortest edge) are moved onto it, so that no slivers arise. The boundary in the plane stays open.
TriMesh cut_off(const TriMesh& mesh, std::size_t axis, double value);

/// Returns the surface and its mirror image at the plane coordinate `axis` = `value`, joined at the vertices that lie exactly on the plane. The surface's
/// vertices and triangles come first.
TriMesh with_mirror_image(const TriMesh& half, std::size_t axis, double value);

}  // namespace sterna::test
