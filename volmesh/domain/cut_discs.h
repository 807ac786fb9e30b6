// Cuts walls with layers along the outlines of actuator discs. Where the plane of a disc crosses the wall, triangles are split, so that the outline consists of
// boundary edges.
#pragma once

#include <array>
#include <cstdint>
#include <vector>

#include "geom/base/run_context.h"
#include "geom/mesh/tri_mesh.h"
#include "volmesh/case/actuator_disc.h"

namespace sterna::volmesh {

/// A disc that walls with layers cross.
struct CutDisc {
  std::size_t disc = 0;  ///< number of the disc
  /// Edges of the boundary, oriented as in their upstream triangles; they form closed polygons in the plane of the disc.
  std::vector<std::array<VertexId, 2>> outline;
  bool has_outer_border = false;  ///< boundary circles of the disc that lie in the fluid (outer, inner)
  bool has_inner_border = false;
};

struct DiscCuts {
  std::vector<CutDisc> discs;
  Column<TriangleId, TriangleId> sources;  ///< source triangle of each triangle of the new boundary; empty if nothing was cut
};

/// Splits triangles of walls with layers along the planes of discs, between their radii. To avoid slivers, vertices within k_snap_share of an edge from the
/// plane are moved into it along that edge, where triangles and edges between patches and facets allow the move. All vertices stay on the input triangles,
/// because a run that is continued from a file, without the CAD model of the wall, has to find the same wall. Coordinates are exact for a plane along a
/// coordinate axis. Vertices keep their numbers, and new vertices follow. Triangles stay in the order of their source triangles. Discs that meet no wall with
/// layers, or that also meet another patch, are skipped here; they are checked when they are inserted into the fluid. \p has_layer flag of each patch
/// \pre the boundary is closed, with normals into the fluid
/// \throws Error(self_intersection) with locations where a wall with layers crosses a boundary circle of a disc, touches its plane without crossing it, lies in
/// it, or where two outlines meet
DiscCuts cut_discs(TriMesh& boundary, const Column<PatchId, std::uint8_t>& has_layer, const std::vector<ActuatorDisc>& discs, const RunContext& context);

}  // namespace sterna::volmesh
