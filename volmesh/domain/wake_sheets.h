// Wake sheets: behind sharp trailing edges the wall continues as a body without thickness, so that the layers on both sides of the wing continue as well.
#pragma once

#include <span>
#include <vector>

#include "geom/base/run_context.h"
#include "geom/mesh/tri_mesh.h"
#include "volmesh/case/wake_sheet.h"
#include "volmesh/envelope/doubled_sheets.h"

namespace sterna::volmesh {

/// Returns the free-stream direction for a domain's boundary as a unit vector. In a tunnel (a boundary with inflow patches and without farfield patches) it is
/// the mean of the inflow's normals into the fluid, weighted by area. Otherwise, and if these normals cancel out, it is x. \pre normals point into the fluid
Vec3 stream_of(const TriMesh& boundary);

struct SheetsOnWall {
  DoubledSheets sheets;             ///< sheets in vertex and triangle numbers of the wall
  std::vector<TriangleId> sources;  ///< for each added triangle the wall triangle at the trailing edge from which it comes
};

/// Adds a sheet behind each trailing edge (find_trailing_edges) of the requested patches. One pattern may match several trailing edges.
///
/// Lines of the sheet start at the vertices of the edge. They start halfway between both sides of the wing (at a blunt edge along its upper side), and turn
/// into the free stream over k_blend chords. Edges along the stream are as long at the start as the wing's edges there, and then grow. All lines have the same
/// number of edges. Where a line comes near another wall or sheet, the sheet ends. Where it would have less than two cells across, it gets narrower instead.
/// Behind edges at the free ends of a trailing edge (round tips) there is no sheet if they are shorter than a quarter of the edges upstream and of the median
/// edge.
///
/// At the border of an open wall (a half model) the sheet has a border in the same plane x, y or z = constant. The sheet of a trailing edge between two
/// periodic sides has the same line at both sides. Vertices on an opened trailing edge are doubled; the vertex of the left side keeps its number. Triangles
/// have the patch of the wall at the edge.
/// \pre the wall is manifold and its borders are exactly in planes; first_height is the smallest first height in m
/// \param stream unit, for sheets without a custom direction
/// \param partner for each vertex of the wall its image on another periodic side, bit-identical except for the translation; invalid if it has none; empty if no
/// vertex has an image
/// \throws Error(bad_argument) if a pattern matches no patch, or no trailing edge, or only trailing edges without a sheet; if the stream has no direction; if a
/// sheet has no space for two rows of cells; if a trailing edge ends at only one of two periodic sides; if a first height is too small for the coordinates
SheetsOnWall add_wake_sheets(std::span<const WakeSheet> wakes, const Vec3& stream, double first_height, const Column<VertexId, VertexId>& partner,
                             TriMesh& wall, const RunContext& context);

}  // namespace sterna::volmesh
