// Small valid hybrid meshes, made by hand: layers as columns on a wall, tetrahedra above them.
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
  double layer_height = 0.4;               ///< of the whole layer, in units of the rays
  double ratio = 1.5;                      ///< growth ratio of the layers
  int n_shells = 2;                        ///< shells of prisms, each split into three tets, between the layer and the outer boundary
  double outer_height = 2.0;               ///< of the outer boundary, in units of the rays; > layer_height
  std::vector<std::uint32_t> collapsed;    ///< wall vertices whose line has no height
  std::vector<std::uint16_t> line_layers;  ///< per wall vertex, at most n_layers; empty: n_layers everywhere
};

/// Columns along straight rays from the wall, then split shells up to an outer surface of the wall's connectivity. Patches: the wall's own, "farfield" (outer),
/// and "side" (slip) when the wall has a boundary. Lines stand on the wall's vertices in their order; column t stands on wall triangle t.
/// \pre wall edge-manifold and oriented; one ray per vertex; cells between neighbouring rays positive (true for rays from a common point or parallel ones).
HybridMesh extrude(const TriMesh& wall, const std::vector<Vec3>& rays, const ShellOptions& options);

/// Rays from `center` to each vertex, so that heights are multiples of the distance from it.
std::vector<Vec3> rays_from(const TriMesh& wall, const Point& center);

/// Layers and tets about an icosahedral unit sphere of 20 f^2 triangles: f = 1 gives 20 columns.
HybridMesh sphere_shell(int f, const ShellOptions& options = {});
/// Two such shells apart from each other, of n_first and n_second layers; lines of the first come first. `options` is about both.
HybridMesh two_shells(int f, int n_first, int n_second, ShellOptions options = {});
/// Numbers of layers n and n - 1 without any order, so that columns have cells of all kinds on top.
std::vector<std::uint16_t> stepped_layers(std::size_t n_lines, int n);
/// The shell about the sphere, and the block on the plate (below), of lines with stepped_layers().
HybridMesh stepped_sphere_shell(int f, ShellOptions options = {});
HybridMesh stepped_plate_block(int n, ShellOptions options = {});
/// The same about the cube [0, 1]^3 of cube(n); its rays come from the centre, side faces are flat.
HybridMesh cube_shell(int n, const ShellOptions& options = {});
/// Plate [0, 1]^2 of n x n squares with vertical rays: an open wall, so that columns end on quads of the patch "side".
HybridMesh plate_block(int n, const ShellOptions& options = {});
/// n^3 hexahedra in [0, 1]^3, patch "box".
HybridMesh hexahedra_block(int n);
/// One hexahedron [0, 1]^3 with a pyramid on its top, apex (0.5, 0.5, 1.5); patches "box" and "roof".
HybridMesh hexahedron_with_roof();
/// The boundary alone of [0, 1]^3, for what looks at patches only: its sides x-, x+, y-, y+, z-, z+ are these patches, the last one all that are left.
HybridMesh box_of_patches(const std::vector<std::pair<std::string, PatchKind>>& kinds);

}  // namespace sterna::test
