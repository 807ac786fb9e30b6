// Splits the boundary of the fluid into walls that carry layers and the other patches. Where a wall ends on a patch without layers, that patch constrains the
// boundary of the layer.
#pragma once

#include <array>
#include <cstdint>
#include <memory>
#include <span>
#include <string>
#include <vector>

#include "geom/base/run_context.h"
#include "geom/base/schema.h"
#include "geom/mesh/tri_mesh.h"
#include "volmesh/domain/periodic_sides.h"
#include "volmesh/domain/split_slivers.h"
#include "volmesh/envelope/collide.h"
#include "volmesh/envelope/constraint.h"
#include "volmesh/envelope/doubled_sheets.h"
#include "volmesh/envelope/opened_ridges.h"
#include "volmesh/tetra/boundary_traits.h"

namespace sterna::volmesh {

/// An adjacent patch: a patch without layers on which layers end. It is re-meshed around the layer's footprint (adjacent/close_boundary.h).
struct AdjacentPatch {
  PatchId patch;                  ///< patch of Domain::outer
  std::int32_t surface = -1;      ///< number of its surface in Domain::constraints.surfaces
  double max_edge = k_automatic;  ///< m, longest edge of its triangles
};

/// An edge of the wall's border, and the patch beyond the edge.
struct LayerBorderEdge {
  HalfedgeId halfedge;  ///< half-edge of Domain::wall
  PatchId patch;        ///< patch of Domain::outer
};

/// The polygon in which two adjacent patches meet. It starts at a wall vertex whose growth line runs along it.
struct EndChain {
  std::vector<VertexId> outer;  ///< vertices of Domain::outer, at least two; the first is on the wall
  bool ends_on_wall = false;    ///< true if the last vertex also has a growth line along this chain
  PatchId left, right;          ///< patches of Domain::outer to the left and right of the chain, as seen from the fluid
};

/// Two patches of Domain::outer; the second is a translated copy of the first.
struct PeriodicPair {
  PatchId first, second;
  Vec3 translation;                               ///< m
  std::vector<std::array<VertexId, 2>> vertices;  ///< pairs of partner vertices of Domain::outer
};

/// An actuator disc that ends on walls with layers (disc cut). The wall itself is not cut there; its columns are separated once the layer exists
/// (adjacent/wall_discs.h).
struct WallDisc {
  std::size_t disc = 0;                            ///< number of the disc in MeshCase::discs
  PatchId patch, back;                             ///< patches of Domain::outer: the upstream side and the downstream side
  std::vector<std::array<HalfedgeId, 2>> outline;  ///< edges of Domain::wall in the plane of the disc: the upstream half-edge, and its downstream twin
  bool has_outer_border = false;                   ///< boundary circles of the disc that lie in the fluid
  bool has_inner_border = false;
  std::vector<TriangleId> behind;  ///< triangles of the wall that contain outline vertices and lie downstream of the disc, ascending
  std::int32_t surface = -1;       ///< number of the surface of the upstream side in Domain::constraints.surfaces; the downstream side follows
};

/// What features require of the steps that follow.
struct DomainNeeds {
  bool keeps_boundary = false;  ///< engines must not split triangles of the boundary
  bool remeshes_outer = false;  ///< the outer boundary is re-meshed around the layer, so the certificate of the envelope does not apply to it
  bool has_own_wall = false;    ///< the wall is cut or opened, and its parts are no longer placed parts
  bool converts_cells = false;  ///< wall vertices have several growth lines, and DomainFeature::finish() converts the layer to the given wall
  BoundaryTraits traits;        ///< traits of the boundary of the tetrahedra
  /// Adds what another feature requires.
  void add(const DomainNeeds& more) {
    keeps_boundary |= more.keeps_boundary;
    remeshes_outer |= more.remeshes_outer;
    has_own_wall |= more.has_own_wall;
    converts_cells |= more.converts_cells;
    traits.has_baffles |= more.traits.has_baffles;
    traits.has_wakes |= more.traits.has_wakes;
  }
};

class DomainFeature;

struct Domain {
  TriMesh wall;             ///< triangles of patches with layers, in the order of the surface; the mesh is open where the wall ends on other patches
  Constraints constraints;  ///< constraints of the wall's boundary
  TriMesh outer;  ///< all other triangles, in the order of the surface, then one side of each actuator disc; its vertices are separate from those of the wall,
                  ///< also on the layer boundary
  OuterLinks links;                     ///< empty if there are no layer boundaries
  std::vector<AdjacentPatch> adjacent;  ///< sorted by ascending patch
  std::vector<LayerBorderEdge> border;  ///< sorted by ascending half-edge
  std::vector<EndChain> chains;
  std::vector<PeriodicPair> periodic;
  std::vector<std::array<VertexId, 2>> partners;  ///< pairs of wall vertices where the wall ends on periodic sides; partners get the same growth
  Column<TriangleId, TriangleId> wall2surface;
  /// Weights in wall2surface; empty if sliver splitting has not changed the wall, and also if discs have cut it.
  Column<TriangleId, CornerWeights> wall_weights;
  SliverReport slivers;
  OpenedRidges ridges;   ///< opened ridges of the wall
  DoubledSheets sheets;  ///< doubled sheets of the wall; a wall never has both these and opened ridges
  std::vector<WallDisc> wall_discs;
  std::vector<VertexId>
      wall_disc_vertices;  ///< vertices of all outlines on the wall, ascending; vertex i also has growth line n_vertices() + i, downstream of its disc
  std::vector<std::size_t> vertex2wall_disc;  ///< number of the disc cut of each of these vertices
  /// Fluid that is not connected to the main fluid. It is the inside of a closed part whose normals point inwards (except the part that encloses the main
  /// fluid).
  struct Cavity {
    double volume = 0.0;               ///< m^3, including the volume of parts inside it
    Box box;                           ///< bounding box of the cavity
    std::vector<std::string> patches;  ///< names of the patches around it
  };
  std::vector<Cavity> cavities;
  TriMesh bodies;  ///< closed parts of the surface except the one that encloses the fluid; cavities are searched in these parts
  std::vector<std::shared_ptr<const DomainFeature>> features;  ///< features in their order; split_domain() adds none
  DomainNeeds needs;                                           ///< what the features require
};

/// Splits a closed surface. Vertices of flat adjacent patches are moved into their plane, by at most 1e-6 of the sum of body length and distance to the wall's
/// middle. Symmetry patches on which layers end must be flat. \p has_layer flag of each patch. \p periodic matching sides of the surface; partner vertices on
/// the layer boundary get the same freedom
/// \pre normals point into the fluid. \post without layer boundaries, wall and outer consist of the surface's triangles, unchanged
/// \throws Error(open_surface) with locations for open edges; Error(non_manifold_surface) if walls with layers touch in single points; Error(bad_argument) for
/// a symmetry patch that is not plane (with its farthest vertex), and if walls end on only one of two periodic sides
Domain split_domain(const TriMesh& surface, const Column<PatchId, std::uint8_t>& has_layer, const RunContext& context,
                    std::span<const PeriodicPatches> periodic = {});

}  // namespace sterna::volmesh
