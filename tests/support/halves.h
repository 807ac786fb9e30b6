// Halves of surfaces, and the bodies that they are halves of.
#pragma once

#include "geom/mesh/tri_mesh.h"

namespace sterna::test {

/// The part of a closed surface with coordinate `axis` >= `value`; new vertices lie exactly on the plane, and vertices near it (a third of their shortest edge)
/// are moved onto it, so that no slivers arise. The rim stays open.
TriMesh cut_off(const TriMesh& mesh, std::size_t axis, double value);

/// The surface and its mirror image at the plane coordinate `axis` = `value`, joined at the vertices that lie exactly on it. The surface's vertices and
/// triangles come first.
TriMesh with_mirror_image(const TriMesh& half, std::size_t axis, double value);

}  // namespace sterna::test
