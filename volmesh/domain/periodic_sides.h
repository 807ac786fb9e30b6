// Periodic sides of the fluid's boundary: two opposite flat patches; the second is a translated copy of the first.
#pragma once

#include <array>
#include <span>
#include <vector>

#include "geom/base/run_context.h"
#include "geom/mesh/tri_mesh.h"
#include "volmesh/case/periodic_names.h"

namespace sterna::volmesh {

/// Two periodic patches and their vertices.
struct PeriodicPatches {
  PatchId first, second;
  Vec3 translation;                               ///< m, from the first to the second
  std::vector<std::array<VertexId, 2>> vertices;  ///< partners, ascending by the first; all vertices of both
};

/// All pairs of a boundary.
struct JoinedSides {
  std::vector<PeriodicPatches> pairs;
  Column<TriangleId, TriangleId> sources;  ///< previous number of each triangle; for copied ones on a second side, of the image. Empty if all stayed
};

/// Share of the boundary's box by which vertices may be off their plane and off their image: files keep 6 to 7 digits.
inline constexpr double k_side_tolerance = 1e-6;

/// Makes these patches of a closed boundary periodic. They become kind interface; the first is moved into its plane, the second onto the first's image,
/// bit-exactly, by at most k_side_tolerance of the boundary's box. Borders along the same lines with equally many edges but different vertex locations (from a
/// mesher whose sizes differ a little) also match: vertices of the second side then move up to 0.35 edges along its border. If borders match and the triangles
/// between them do not, the second side gets the triangles of the first; its own triangles and their interior vertices are removed (unused vertices stay in the
/// mesh; triangles keep their order, those of the second side go to the end). Several pairs may share edges.
/// \throws Error(bad_argument) for a name that is no patch (with the existing names), a patch in several pairs, sides that are not flat, are not opposite or do
/// not match: with locations and distances
JoinedSides join_periodic_sides(TriMesh& boundary, std::span<const PeriodicNames> names, const RunContext& context);

/// Moves vertices of periodic sides onto their images, as join_periodic_sides() does, without changing triangles.
/// \return the pairs, without interior vertices of a second side that joining would add
std::vector<PeriodicPatches> move_onto_images(TriMesh& boundary, std::span<const PeriodicNames> names, const RunContext& context);

}  // namespace sterna::volmesh
