// Models and what the meshes of any model have to be, for the tests of surfmesh/model.
#pragma once

#include "geom/model/model.h"
#include "surfmesh/model/surface_mesh.h"

namespace sterna::test {

/// A whole sphere about the origin: one face "ball", a seam and two poles.
Model make_ball(double radius);

/// No edge with more than two triangles or two of the same sense; edges with one only where the model is open.
void expect_joined(const Model& model, const surfmesh::SurfaceMesh& surface);

/// What every mesh has to be that was accepted: joined, no crossings, vertices on the faces and edges that they are said to be on, patches by face.
void expect_sound(const Model& model, const surfmesh::SurfaceMesh& surface);

}  // namespace sterna::test
