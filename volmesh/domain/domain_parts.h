// The fluid's boundary taken apart: the walls that carry layers, and the rest; where a wall ends on a patch without layers, that patch holds the layer's rim.
#pragma once

#include <array>
#include <cstdint>
#include <span>
#include <string>
#include <vector>

#include "geom/base/run_context.h"
#include "geom/base/schema.h"
#include "geom/mesh/tri_mesh.h"
#include "volmesh/domain/periodic_sides.h"
#include "volmesh/domain/split_needles.h"
#include "volmesh/envelope/collide.h"
#include "volmesh/envelope/constraint.h"
#include "volmesh/envelope/doubled_sheets.h"
#include "volmesh/envelope/opened_ridges.h"

namespace sterna::volmesh {

/// A patch without layers on which layers end. It is triangulated anew around the layer's footprint (rims/close_ends.h).
struct EndPatch {
  PatchId patch;                  ///< of Domain::outer
  std::int32_t surface = -1;      ///< of Domain::constraints.surfaces
  double max_edge = k_automatic;  ///< m, of its triangles
};

/// An edge of the wall's border and the patch beyond it.
struct RimEdge {
  HalfedgeId halfedge;  ///< of Domain::wall
  PatchId patch;        ///< of Domain::outer
};

/// Where two end patches meet: the polygon that starts at a wall vertex whose line runs along it.
struct EndChain {
  std::vector<VertexId> outer;  ///< of Domain::outer, at least two; the first is on the wall
  bool ends_on_wall = false;    ///< the last one is a vertex with a line along this chain too
  PatchId left, right;          ///< of Domain::outer, seen along the chain from the fluid
};

/// Two patches of Domain::outer of which the second is the first, moved.
struct PeriodicEnds {
  PatchId first, second;
  Vec3 translation;                               ///< m
  std::vector<std::array<VertexId, 2>> vertices;  ///< partners, of Domain::outer
};

/// An actuator disc that ends on walls with layers. The wall stays closed there; its columns are parted when the layer is known (rims/slits.h).
struct DiscSlit {
  std::size_t disc = 0;                            ///< index of MeshCase::discs
  PatchId patch, back;                             ///< of Domain::outer: the upstream and the downstream side
  std::vector<std::array<HalfedgeId, 2>> outline;  ///< edges of Domain::wall in the disc's plane: the half-edge upstream, and its twin downstream
  bool has_outer_rim = false;                      ///< rims of the disc that lie free in the fluid
  bool has_inner_rim = false;
  std::vector<TriangleId> behind;  ///< of the wall: those with vertices of the outline that lie downstream of the disc, ascending
  std::int32_t surface = -1;       ///< of Domain::constraints.surfaces: its upstream side; the downstream one follows
};

struct Domain {
  TriMesh wall;                ///< triangles of patches with layers, in the order of the surface; open where it ends on other patches
  Constraints constraints;     ///< of its rim
  TriMesh outer;               ///< all other triangles, in the order of the surface, then one side of actuator discs; its own vertices, those of the rim too
  OuterLinks links;            ///< empty without rims
  std::vector<EndPatch> ends;  ///< ascending by patch
  std::vector<RimEdge> rim;    ///< ascending by half-edge
  std::vector<EndChain> chains;
  std::vector<PeriodicEnds> periodic;
  std::vector<std::array<VertexId, 2>> partners;  ///< of the wall, where it ends on periodic sides: they grow alike
  Column<TriangleId, TriangleId> wall2surface;
  Column<TriangleId, CornerWeights> wall_weights;  ///< in wall2surface; empty where needles have not changed the wall, and where discs have cut it
  NeedleReport needles;
  OpenedRidges ridges;   ///< of the wall
  DoubledSheets sheets;  ///< likewise; not both
  std::vector<DiscSlit> slits;
  std::vector<VertexId>
      slit_vertices;  ///< of the wall: those of all outlines, ascending; the i-th has line n_vertices() + i of the layer too, downstream of its disc
  std::vector<std::size_t> vertex2slit;  ///< of each of them: the slit
  /// Fluid that no other fluid reaches: the insides of closed parts with normals inwards, but that of the one that encloses the rest.
  struct Cavity {
    double volume = 0.0;               ///< m^3, with what is in it
    Box box;                           ///< of the part
    std::vector<std::string> patches;  ///< of the part
  };
  std::vector<Cavity> cavities;
  TriMesh bodies;  ///< closed parts of the surface but the one that encloses the fluid: what cavities are looked for in
  /// Whether vertices of the wall have several lines, so that its layer is not the given wall's yet.
  bool is_opened() const { return !ridges.is_empty() || !sheets.is_empty(); }
  /// Whether the outer boundary is made anew around the layer.
  bool has_rims() const { return !rim.empty() || !slits.empty(); }
};

/// Takes a closed surface apart. Vertices of flat end patches are moved into their plane, by 1e-6 of their distance to the wall's middle plus body length at
/// most; symmetry patches on which layers end must be flat. \p has_layer: of each patch. \p periodic: sides of the surface that match; rim vertices at partners
/// have the same freedom.
/// \pre normals into the fluid. Without rims wall and outer are the surface's triangles, unchanged.
/// \throws Error(open_surface) with places for open edges; Error(non_manifold_surface) where walls with layers touch in single points; Error(bad_argument) for
/// a symmetry patch that is not plane, with its vertex farthest off, and where walls end on one periodic side alone
Domain split_domain(const TriMesh& surface, const Column<PatchId, std::uint8_t>& has_layer, const RunContext& context,
                    std::span<const PeriodicPatches> periodic = {});

}  // namespace sterna::volmesh
