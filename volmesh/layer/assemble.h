// Joins layer, tetrahedra and outer boundary to one HybridMesh, and prepares the boundary that the tetrahedra fill.
#pragma once

#include <span>

#include "geom/mesh/hybrid_mesh.h"
#include "volmesh/layer/extrude.h"
#include "volmesh/rims/close_ends.h"
#include "volmesh/rims/slits.h"
#include "volmesh/tetra/tetra.h"

namespace sterna::volmesh {

/// Closed surface around the tetrahedra: top of the layer (normals away from the wall) and outer boundary (normals into the fluid), with the
/// HybridMesh node of every point.
struct FillBoundary {
  std::vector<Vec3> points;
  std::vector<std::array<std::uint32_t, 3>> triangles;
  std::vector<std::string> patch_names;       ///< the wall's, then the outer ones
  std::vector<std::uint32_t> triangle_patch;  ///< index into patch_names; a triangle on top of the layer has that of its wall triangle
  std::vector<double> layer_volumes;          ///< of the last prism under each triangle, m^3; 0 where there is none
  std::vector<NodeId> point2node;             ///< layer nodes first; outer nodes follow the layer's
};
/// m^3, of the prism between the last two nodes of each of a column's lines; 0 where one is collapsed.
double last_prism_volume(const LayerBlock& layers, std::span<const Point> points, std::size_t column);
FillBoundary fill_boundary(const LayerBase& base, const Extrusion& extrusion, const ClosedOuter& outer);
/// The same of what assemble_layers() made of them. Uses columns and boundary triangles, nodes up to the last of the outer boundary.
/// \pre all its cells are columns: not behind close_fans() or close_wakes()
FillBoundary boundary_of(const HybridMesh& layers);
/// The outer boundary that assemble_layers() got, up to the numbering of its vertices. \p n_wall_patches: how many patches carry layers
ClosedOuter outer_of(const HybridMesh& layers, std::size_t n_wall_patches);

/// All of the mesh but its tetrahedra. Nodes: lines of the layer, outer boundary. Patches: the wall's, then the outer ones. Boundary triangles: the wall's, the
/// outer ones, sides of cells beside a line that has ended; quadrilaterals: sides of cells.
HybridMesh assemble_layers(const LayerBase& base, Extrusion extrusion, const ClosedOuter& outer, std::span<const LayerSide> sides);
/// \pre mesh of assemble_layers(), `boundary` of the same.
/// \post Steiner points follow its nodes, tetrahedra those that it has (close_fans.h).
void add_tetrahedra(const FillBoundary& boundary, const TetraResult& tets, HybridMesh& mesh, const RunContext& context);

}  // namespace sterna::volmesh
