// The outlines of actuator discs on walls with layers become edges of the boundary: where the disc's plane goes through the wall, triangles are split along it.
#pragma once

#include <array>
#include <cstdint>
#include <vector>

#include "geom/base/run_context.h"
#include "geom/mesh/tri_mesh.h"
#include "volmesh/case/actuator_disc.h"

namespace sterna::volmesh {

/// A disc that walls with layers reach through.
struct CutDisc {
  std::size_t disc = 0;                          ///< index of the discs
  std::vector<std::array<VertexId, 2>> outline;  ///< edges of the boundary, as their triangles upstream have them; closed polygons in the disc's plane
  bool has_outer_rim = false;                    ///< the disc's own rims that lie in the fluid
  bool has_inner_rim = false;
};

struct DiscCuts {
  std::vector<CutDisc> discs;
  Column<TriangleId, TriangleId> sources;  ///< of each triangle of the boundary now: the one that it is part of; empty where nothing was cut
};

/// Splits triangles of walls with layers along the planes of discs, between their radii. Vertices within k_snap_share of an edge from the plane are moved into
/// it along that edge where triangles and edges between patches and facets allow it, so that no slivers come. All stay on the given triangles: a run that is
/// continued from a file, without the model behind the wall, has to find the same wall. Coordinates are exact for a plane along a coordinate axis. Vertices
/// keep their numbers, new ones follow; triangles stay in the order of those that they come from. Discs that meet no wall with layers, or another patch beside,
/// are left out: they are judged where they are put into the fluid. \p has_layer: of each patch.
/// \pre boundary closed, normals into the fluid
/// \throws Error(self_intersection) with places where a wall with layers goes through a disc's rim, touches its plane without going through, lies in it, or
/// where two outlines meet
DiscCuts cut_discs(TriMesh& boundary, const Column<PatchId, std::uint8_t>& has_layer, const std::vector<ActuatorDisc>& discs, const RunContext& context);

}  // namespace sterna::volmesh
