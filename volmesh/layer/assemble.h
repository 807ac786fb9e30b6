// Joins layer, tetrahedra and outer boundary to one HybridMesh, and prepares the boundary of the volume for the tetrahedra.
#pragma once

#include <span>

#include "geom/mesh/hybrid_mesh.h"
#include "volmesh/layer/extrude.h"
#include "volmesh/rims/close_ends.h"
#include "volmesh/rims/slits.h"
#include "volmesh/tetra/tetra.h"

namespace sterna::volmesh {

/// Closed surface around the tetrahedra: top of the layer (normals away from the wall) and outer boundary (normals into the fluid), with the HybridMesh node
/// of every point.
struct FillBoundary {
  std::vector<Vec3> points;
  std::vector<std::array<std::uint32_t, 3>> triangles;
  std::vector<std::string> patch_names;       ///< patches of the wall, then of the outer boundary
  std::vector<std::uint32_t> triangle_patch;  ///< index into patch_names; a triangle on top of the layer has the patch of its wall triangle
  std::vector<double> layer_volumes;          ///< volume of the last prism under each triangle, m^3; 0 where there is no prism
  std::vector<NodeId> point2node;             ///< layer nodes first; outer nodes follow the layer's
};
/// Returns the volume of the prism between the last two nodes of each growth line of a column, m^3; 0 if a growth line is collapsed.
double last_prism_volume(const LayerBlock& layers, std::span<const Point> points, std::size_t column);
FillBoundary fill_boundary(const LayerBase& base, const Extrusion& extrusion, const ClosedOuter& outer);
/// Returns the fill boundary of a mesh from assemble_layers(). Uses columns and boundary triangles, nodes up to the last of the outer boundary.
/// \pre all cells of the mesh are columns: close_fans() and close_wakes() have not been called
FillBoundary boundary_of(const HybridMesh& layers);
/// Returns the outer boundary that was passed to assemble_layers(), up to the numbering of its vertices. \p n_wall_patches: number of patches with layers
ClosedOuter outer_of(const HybridMesh& layers, std::size_t n_wall_patches);

/// Assembles the mesh without tetrahedra. Nodes: growth lines of the layer, outer boundary. Patches: those of the wall, then those of the outer boundary.
/// Boundary triangles: wall, outer boundary, sides of cells beside a growth line that has ended; boundary quadrilaterals: sides of cells.
HybridMesh assemble_layers(const LayerBase& base, Extrusion extrusion, const ClosedOuter& outer, std::span<const LayerSide> sides);
/// Adds the tetrahedra to the mesh.
/// \pre mesh from assemble_layers(), `boundary` of the same mesh.
/// \post Steiner points follow the mesh's nodes, new tetrahedra follow the existing ones (close_fans.h).
void add_tetrahedra(const FillBoundary& boundary, const TetraResult& tets, HybridMesh& mesh, const RunContext& context);

}  // namespace sterna::volmesh
