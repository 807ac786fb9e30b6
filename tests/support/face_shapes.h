// Parametric faces for tests and benchmarks of the surface mesher: surfaces with poles, seams, bumps and badly scaled parameters, and borders split into edges
// of a given length.
#pragma once

#include <string>
#include <vector>

#include "geom/model/surface.h"
#include "surfmesh/face/sized_face_mesh.h"

namespace sterna::test {

struct FaceShape {
  std::string name;
  SurfacePtr surface;
  ParameterBox box;   ///< the face covers the whole box
  double size = 0.1;  ///< a suitable edge length, metres
  double area = 0.0;  ///< exact, m^2; 0: unknown
  int n_narrow = 0;   ///< largest number of triangles with an angle outside [20, 130] degrees that are forced by the face's own corners or apex
};

/// Returns these faces: plane, sphere (two poles and a seam), sphere patch with one pole, cylinder with its seam, torus, bump (bicubic), wing (bicubic spline
/// of aerofoil sections), badly scaled bump (u a million times v), stretched plane (u speeds up along the face), nose of a body, sheared parameters with two
/// corners of 6 degrees, cone with its apex, spheres with the parameter slow and fast at a pole.
std::vector<FaceShape> face_shapes();

/// Returns the border of the box, split into edges of about `size`, shorter where an edge would span more than `curvature_angle` (rad). Seams have equal points
/// on both sides, poles two points at one location.
surfmesh::FaceBorder box_border(const Surface& surface, const ParameterBox& box, double size, double curvature_angle = 0.6);

/// Returns the surface with other parameters: (u, v) -> surface(from_u(u), from_v(v)), each linear over `box` or a power.
SurfacePtr reparametrised(SurfacePtr surface, const ParameterBox& box, double power_u, double power_v);

}  // namespace sterna::test
