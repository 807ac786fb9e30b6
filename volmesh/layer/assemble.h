// Joins layer, tetrahedra and outer boundary to one HybridMesh. Prepares the boundary of the volume for the tetrahedra.
#pragma once

#include <span>

#include "geom/base/borrowed.h"
#include "geom/mesh/hybrid_mesh.h"
#include "volmesh/adjacent/close_boundary.h"
#include "volmesh/adjacent/wall_discs.h"
#include "volmesh/layer/extrude.h"
#include "volmesh/tetra/tetra.h"

namespace sterna::volmesh {

/// Closed surface around the tetrahedra, with the HybridMesh node of every point. It consists of the top of the layer (normals away from the wall) and the
/// outer boundary (normals into the fluid).
struct FillBoundary {
  std::vector<Vec3> points;
  std::vector<std::array<std::uint32_t, 3>> triangles;
  std::vector<std::string> patch_names;       ///< patches of the wall first, then those of the outer boundary
  std::vector<std::uint32_t> triangle_patch;  ///< index into patch_names; a triangle on top of the layer has the patch of its wall triangle
  std::vector<double> layer_volumes;          ///< m^3, volume of the last prism below each triangle; 0 where there is no prism
  std::vector<NodeId> point2node;             ///< nodes of the layer first, then nodes of the outer boundary
};
/// Returns the boundary for engines. \p holes points in cavities. \p clear proof for the boundary, if there is one
TetraBoundary engine_boundary(Borrowed<const FillBoundary> boundary, std::span<const Vec3> holes, ClearProof clear, BoundaryTraits traits);
/// Returns the boundary within which tetrahedra are improved.
TetraBoundary improvement_boundary(Borrowed<const FillBoundary> boundary);

/// Returns the volume in m^3 of the prism between the last two nodes of each growth line of a column; 0 if a growth line is collapsed.
double last_prism_volume(const LayerBlock& layers, std::span<const Point> points, std::size_t column);
FillBoundary fill_boundary(const LayerBase& base, const Extrusion& extrusion, const ClosedOuter& outer);
/// Returns the fill boundary of a mesh that assemble_layers() made. It uses the columns, the boundary triangles, and the nodes up to the last node of the outer
/// boundary.
/// \pre all cells of the mesh belong to columns: close_multi_normals() and close_wakes() have not been called
FillBoundary boundary_of(const HybridMesh& layers);
/// Returns the outer boundary that was passed to assemble_layers(), except that its vertices may have other numbers. \p n_wall_patches number of patches with
/// layers
ClosedOuter outer_of(const HybridMesh& layers, std::size_t n_wall_patches);

/// Assembles the mesh without tetrahedra. Nodes: growth lines of the layer, then outer boundary. Patches: those of the wall, then those of the outer boundary.
/// Boundary triangles: wall, outer boundary, and sides of cells beside a growth line that has ended. Boundary quadrilaterals: the other sides of cells.
HybridMesh assemble_layers(const LayerBase& base, Extrusion extrusion, const ClosedOuter& outer, std::span<const LayerSide> sides);
/// Adds the tetrahedra to the mesh.
/// \pre the mesh was made by assemble_layers(), and `boundary` belongs to this mesh
/// \post Steiner points follow the nodes of the mesh, and new tetrahedra follow the existing ones (close_multi_normals.h)
void add_tetrahedra(const FillBoundary& boundary, const TetraResult& tets, HybridMesh& mesh, const RunContext& context);

}  // namespace sterna::volmesh
