// Periodic sides of the fluid's boundary: two flat patches that face each other, of which the second is the first, moved.
#pragma once

#include <array>
#include <span>
#include <vector>

#include "geom/base/run_context.h"
#include "geom/mesh/tri_mesh.h"
#include "volmesh/case/periodic_names.h"

namespace sterna::volmesh {

/// Two patches that are, and their vertices.
struct PeriodicPatches {
  PatchId first, second;
  Vec3 translation;                               ///< m, from the first to the second
  std::vector<std::array<VertexId, 2>> vertices;  ///< partners, ascending by the first; all vertices of both
};

/// All pairs of a boundary.
struct JoinedSides {
  std::vector<PeriodicPatches> pairs;
  Column<TriangleId, TriangleId> sources;  ///< of each triangle of the boundary: before; of those that a second side gets: of its image. Empty where all stayed
};

/// Files keep 6 to 7 digits: vertices may be off their plane and off their image by this share of the boundary's box.
inline constexpr double k_side_tolerance = 1e-6;

/// Makes these patches of a closed boundary periodic: they become of kind interface; the first is moved into its plane, the second onto the first's image, to
/// the bit, by k_side_tolerance of the boundary's box at most. Borders along the same lines that are cut into as many edges at other places (by a mesher whose
/// sizes differ a little) match, too: there the second side's vertices go up to 0.35 edges along its border. Where borders match and the triangles between them
/// do not, the second gets those of the first: its own and their vertices inside go (unused vertices stay in the mesh; triangles keep their order, those of the
/// second side go to the end). Several pairs may share edges.
/// \throws Error(bad_argument) for a name that is no patch (with those there are), a patch in several pairs, sides that are not flat, do not face each other or
/// do not match: with places and distances
JoinedSides join_periodic_sides(TriMesh& boundary, std::span<const PeriodicNames> names, const RunContext& context);

/// Moves vertices of periodic sides onto their images, as join_periodic_sides() does, without a change of triangles.
/// \return the pairs, without vertices inside a second side that joining would add
std::vector<PeriodicPatches> move_onto_images(TriMesh& boundary, std::span<const PeriodicNames> names, const RunContext& context);

}  // namespace sterna::volmesh
