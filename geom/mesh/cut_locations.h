// Informative cut planes through a mesh, selected by the shape of the walls alone.
#pragma once

#include <string>
#include <vector>

#include "geom/mesh/cut.h"

namespace sterna {

/// A cut plane and the region of interest in it.
struct CutLocation {
  std::string name;     ///< "leading edge"
  CutPlane plane;       ///< without limits
  Point focus;          ///< in the plane
  double radius = 0.0;  ///< m, of the region of interest around the focus
};

/// Returns the cut planes in this order, as far as the walls provide them:
///   "symmetry plane"  the plane of the symmetry patch, shifted slightly inside; without such a patch "middle plane", across the span in the middle
///   "leading edge", "trailing edge"  of the flattest section of the walls at 55 % of the half span, if its thickness is 0.1 to 40 % of its length;
///                     across the edge there
///   "tip"             along x through the outermost point, if there is a wing
///   "junction"        across the longest chain of concave edges (more than 30 degrees), between two patches if such edges exist
///   "sharp edge"      across the longest chain of convex edges (more than 30 degrees), if there is no wing
///   "nose"            through the foremost point
///   "section 25%", "section 50%", "section 75%"  across x; if a plane meets no wall, through the nearest wall
/// x is the flow direction. The span is y, or z if the walls are wider in z. Walls are the wall patches that carry layers, without the outer walls of a
/// tunnel; without layers all wall patches; without walls all patches except farfield, inflow and outflow; else the whole boundary.
/// \pre indices in range, finite points
/// \post every plane crosses walls; at least three planes if the mesh has a boundary of non-zero extent
std::vector<CutLocation> automatic_cuts(const HybridMesh& mesh, const RunContext& context);

/// Returns the mean normal of the symmetry patches, out of the fluid. Half models are viewed from the other side, so that the body is in front of its
/// symmetry plane. Zero without such patches.
Vec3 symmetry_normal(const HybridMesh& mesh);

}  // namespace sterna
