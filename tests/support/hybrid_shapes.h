// Small valid hybrid meshes, made by hand: layers as columns on a wall, with tetrahedra above the layers.
#pragma once

#include <cstdint>
#include <string>
#include <utility>
#include <vector>

#include "geom/mesh/hybrid_mesh.h"
#include "geom/mesh/tri_mesh.h"

namespace sterna::test {

struct ShellOptions {
  int n_layers = 3;
  double layer_height = 0.4;               ///< height of the whole layer, in units of the rays
  double ratio = 1.5;                      ///< growth ratio of the layers
  int n_shells = 2;                        ///< shells of prisms, each split into three tets, between the layer and the outer boundary
  double outer_height = 2.0;               ///< height of the outer boundary, in units of the rays; > layer_height
  std::vector<std::uint32_t> collapsed;    ///< wall vertices with collapsed growth lines
  std::vector<std::uint16_t> line_layers;  ///< per wall vertex, at most n_layers; empty: n_layers everywhere
};

/// Returns columns along straight rays from the wall, then split shells up to an outer surface with the wall's connectivity. Patches: the wall's own,
/// "farfield" (outer), and "side" (slip) if the wall has a boundary. Growth lines are in the order of the wall's vertices; column t stands on wall triangle t.
/// \pre wall edge-manifold and oriented; one ray per vertex; cells between neighbouring rays positive (true for rays from a common point or parallel rays).
HybridMesh extrude(const TriMesh& wall, const std::vector<Vec3>& rays, const ShellOptions& options);

/// Returns the rays from `center` to each vertex, so that heights are multiples of the distance from `center`.
std::vector<Vec3> rays_from(const TriMesh& wall, const Point& center);

/// Returns layers and tets about an icosahedral unit sphere of 20 f^2 triangles: f = 1 gives 20 columns.
HybridMesh sphere_shell(int f, const ShellOptions& options = {});
/// Returns two separate such shells with n_first and n_second layers; growth lines of the first shell come first. `options` apply to both shells.
HybridMesh two_shells(int f, int n_first, int n_second, ShellOptions options = {});
/// Returns layer numbers n and n - 1 in irregular order, so that columns end below all kinds of cells.
std::vector<std::uint16_t> stepped_layers(std::size_t n_lines, int n);
/// Returns the shell about the sphere, or the block on the plate (below), with stepped_layers() for the growth lines.
HybridMesh stepped_sphere_shell(int f, ShellOptions options = {});
HybridMesh stepped_plate_block(int n, ShellOptions options = {});
/// Returns a shell about the cube [0, 1]^3 of cube(n); its rays come from the centre, side faces are flat.
HybridMesh cube_shell(int n, const ShellOptions& options = {});
/// Returns a block on the plate [0, 1]^2 of n x n squares with vertical rays: an open wall, so that columns end on quads of the patch "side".
HybridMesh plate_block(int n, const ShellOptions& options = {});
/// Returns n^3 hexahedra in [0, 1]^3, patch "box".
HybridMesh hexahedra_block(int n);
/// Returns one hexahedron [0, 1]^3 with a pyramid on its top, apex (0.5, 0.5, 1.5); patches "box" and "roof".
HybridMesh hexahedron_with_roof();
/// Returns only the boundary of [0, 1]^3, for tests of patches. Sides x-, x+, y-, y+, z-, z+ get these patches in order; the last patch gets all remaining
/// sides.
HybridMesh box_of_patches(const std::vector<std::pair<std::string, PatchKind>>& kinds);

}  // namespace sterna::test
