// Models, and the requirements for meshes of any model, for the tests of surfmesh/model.
#pragma once

#include "geom/model/model.h"
#include "surfmesh/model/surface_mesh.h"

namespace sterna::test {

/// Returns a whole sphere about the origin: one face "ball", a seam and two poles.
Model make_ball(double radius);

/// Checks that no edge has more than two triangles or two of the same direction, and that edges have one triangle only where the model is open.
void expect_joined(const Model& model, const surfmesh::SurfaceMesh& surface);

/// Checks the requirements for every accepted mesh: joined, no crossings, vertices on their stored faces and edges, patches by face.
void expect_sound(const Model& model, const surfmesh::SurfaceMesh& surface);

}  // namespace sterna::test
