// Parametric faces for tests and benchmarks of the surface mesher: surfaces with poles, seams, bumps and badly scaled parameters, and borders cut at a given
// length.
#pragma once

#include <string>
#include <vector>

#include "geom/model/surface.h"
#include "surfmesh/face/face_mesh.h"

namespace sterna::test {

struct FaceShape {
  std::string name;
  SurfacePtr surface;
  ParameterBox box;   ///< the face is all of it
  double size = 0.1;  ///< a length that suits it, metres
  double area = 0.0;  ///< exact, m^2; 0: not known
  int n_narrow = 0;   ///< triangles with an angle outside [20, 130] degrees that its own corners or apex force, at most
};

/// plane, sphere (two poles and a seam), sphere patch with one pole, cylinder with its seam, torus, bump (bicubic), wing (bicubic spline of aerofoil sections),
/// badly scaled bump (u a million times v), stretched plane (u speeds up along the face), nose of a body, sheared parameters
/// with two corners of 6 degrees, cone with its apex, spheres with the parameter slow and fast at a pole.
std::vector<FaceShape> face_shapes();

/// The border of the box, cut into lengths of about `size`, less where an edge would span more than `curvature_angle` (rad); seams have equal points on both
/// sides, poles two points at one place.
surfmesh::FaceBorder box_border(const Surface& surface, const ParameterBox& box, double size, double curvature_angle = 0.6);

/// The surface with other parameters: (u, v) -> surface(from_u(u), from_v(v)), each linear over `box` or as a power.
SurfacePtr reparametrised(SurfacePtr surface, const ParameterBox& box, double power_u, double power_v);

}  // namespace sterna::test
