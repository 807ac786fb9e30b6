// Bodies that each show one class of vertices (docs/method/envelope.md, "Vertex classes").
#pragma once

#include "geom/mesh/tri_mesh.h"

namespace sterna::test {

/// Straight wing of unit chord and span: x chordwise, y spanwise, flat ends; the trailing edge has the given thickness and is sharp at 0.
TriMesh straight_wing(double thickness);
/// A box fuselage with a box wing at right angles to its side: concave edges meet convex edges.
TriMesh wing_body();
/// A round block whose top is creased along its middle: convex where x < 0, concave where x > 0; the vertex between, at the origin, is a saddle.
TriMesh creased_disk();
/// Upright cone of unit height with its tip at (0, 0, 1) and half angle `half_angle`; n sides.
TriMesh cone(double half_angle, int n);

}  // namespace sterna::test
