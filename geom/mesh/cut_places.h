// Planes through a mesh that are worth a look: found on the walls by their shape alone.
#pragma once

#include <string>
#include <vector>

#include "geom/mesh/cut.h"

namespace sterna {

/// A plane and where in it to look.
struct CutPlace {
  std::string name;     ///< "leading edge"
  CutPlane plane;       ///< without limits
  Point focus;          ///< in the plane
  double radius = 0.0;  ///< m, of what is to be seen around the focus
};

/// In this order, as far as the walls have them:
///   "symmetry plane"  the plane of the symmetry patch, a hair inside; without such a patch "middle plane", across the span in the middle
///   "leading edge", "trailing edge"  of the flattest section of the walls at 55 % of the half span, when its thickness is 0.1 to 40 % of its length;
///                     across the edge there
///   "tip"             along x through the point furthest out, when there is a wing
///   "junction"        across the longest chain of concave edges (more than 30 degrees), between two patches if there are such
///   "sharp edge"      across the longest chain of convex edges (more than 30 degrees), when there is no wing
///   "nose"            through the foremost point
///   "section 25%", "section 50%", "section 75%"  across x; where a plane meets no wall, through the nearest wall
/// x is the direction of the flow, the span is y, or z where walls are wider in z. Walls are the boundary of kind wall that carries layers, without the
/// outer walls of a tunnel; without layers all of kind wall; without walls all but farfield, inflow and outflow; else the whole boundary.
/// \pre indices in range, finite points
/// \post every plane crosses walls; at least three places, if the mesh has a boundary of some extent
std::vector<CutPlace> automatic_cuts(const HybridMesh& mesh, const RunContext& context);

/// Mean normal of the patches of kind symmetry, out of the fluid: half models are looked at from the other side, so that the body is before its symmetry plane.
/// Zero without such patches.
Vec3 symmetry_normal(const HybridMesh& mesh);

}  // namespace sterna
