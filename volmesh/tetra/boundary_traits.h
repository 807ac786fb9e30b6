// Properties of a boundary that engines and checks cannot derive from its triangles.
#pragma once

namespace sterna::volmesh {

/// Traits of the boundary of the tetrahedra.
struct BoundaryTraits {
  /// Some triangles lie back to back, as the two sides of sheets without thickness inside the domain (actuator discs). The points of sheets are doubled at each
  /// location, except on boundary edges of the sheet that end free in the domain. There both sides share one point, and every triangle has a corner that is not
  /// shared. Boundary edges of a sheet may also lie on edges of the rest of the boundary, which also has two points at each location there. All triangles
  /// together are closed and manifold by their indices.
  bool has_baffles = false;
  /// Parts of the boundary are tops of layers on wake sheets. They are wide, flat and fine, and refinement by sterna's own engine may get stuck there. The flag
  /// affects only the choice of the engine.
  bool has_wakes = false;
};

}  // namespace sterna::volmesh
