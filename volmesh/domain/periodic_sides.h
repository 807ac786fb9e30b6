// Periodic sides of the fluid's boundary are two opposite flat patches, of which the second is a translated copy of the first.
#pragma once

#include <array>
#include <span>
#include <vector>

#include "geom/base/run_context.h"
#include "geom/mesh/periodic_names.h"
#include "geom/mesh/tri_mesh.h"

namespace sterna::volmesh {

/// Two periodic patches and their vertices.
struct PeriodicPatches {
  PatchId first, second;
  Vec3 translation;                               ///< m, from the first patch to the second
  std::vector<std::array<VertexId, 2>> vertices;  ///< pairs of partners, sorted by the vertex of the first patch; they contain all vertices of both patches
};

/// All pairs of a boundary.
struct JoinedSides {
  std::vector<PeriodicPatches> pairs;
  Column<TriangleId, TriangleId> sources;  ///< previous number of each triangle; for a triangle that was copied to a second side, the number of its original.
                                           ///< Empty if all triangles stayed
};

/// Fraction of the boundary's box by which vertices may deviate from their plane and from their image, because files keep 6 to 7 digits.
inline constexpr double k_side_tolerance = 1e-6;

/// Makes these patches of a closed boundary periodic. They get kind interface. The first patch is moved into its plane. The second is moved bit-exactly onto
/// the image of the first, by at most k_side_tolerance of the boundary's box. Borders that follow the same lines with equally many edges but different vertex
/// locations also match (they come from meshers whose sizes differ slightly); vertices of the second side then move by up to 0.35 edges along its border. If
/// borders match but the triangles between them do not, the second side gets the triangles of the first. Its own triangles and their interior vertices are
/// removed: unused vertices stay in the mesh; triangles keep their order, and those of the second side go to the end. Several pairs may share edges.
/// \throws Error(bad_argument) for a name that is no patch (with the existing names), for a patch in several pairs, and for sides that are not flat, not
/// opposite or do not match (with locations and distances)
JoinedSides join_periodic_sides(TriMesh& boundary, std::span<const PeriodicNames> names, const RunContext& context);

/// Moves vertices of periodic sides onto their images like join_periodic_sides(), but changes no triangles.
/// \return the pairs, without the interior vertices of a second side that joining would add
std::vector<PeriodicPatches> move_onto_images(TriMesh& boundary, std::span<const PeriodicNames> names, const RunContext& context);

}  // namespace sterna::volmesh
