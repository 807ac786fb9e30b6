// Wake sheets: the wall goes on behind sharp trailing edges as a body without thickness, so that layers of both sides of a wing go on, too.
#pragma once

#include <span>
#include <vector>

#include "geom/base/run_context.h"
#include "geom/mesh/tri_mesh.h"
#include "volmesh/case/wake_sheet.h"
#include "volmesh/envelope/doubled_sheets.h"

namespace sterna::volmesh {

/// The free stream that a domain's boundary says: in a tunnel, which is a boundary with inflow and without farfield patches, the mean of the inflow's normals
/// into the fluid, by area; else, and where these are opposite to each other, along x. Unit. \pre normals into the fluid
Vec3 stream_of(const TriMesh& boundary);

struct SheetsOnWall {
  DoubledSheets sheets;             ///< in numbers of the wall
  std::vector<TriangleId> sources;  ///< of each triangle that was added: one of the wall at the trailing edge
};

/// Adds a sheet behind each trailing edge (find_trailing_edges) of the patches that are asked for; several may match one pattern. Its lines start at the
/// edge's vertices, halfway between both sides of the wing (of a blunt one: along its upper side), and turn into the free stream over k_blend chords; edges
/// along the stream start as long as the wing's there and grow, all lines have as many. Where a line comes near to another wall or sheet, the sheet ends, and
/// it gets narrower rather than thinner than two cells. Edges at the free ends of a trailing edge (round tips) that are shorter than a quarter of the edges
/// upstream of it, and of its median, have no sheet behind them. At the border of an open wall (a half model) the sheet has a border, too, in the same plane x,
/// y or z = constant. A trailing edge from periodic side to periodic side has the same line at both. Vertices on an opened trailing edge are doubled; the one
/// of the left side keeps its number. Triangles have the patch of the wall at the edge.
/// \pre wall manifold; borders exactly in planes; first_height in m, the smallest of all
/// \param stream: unit, for sheets that have no direction of their own
/// \param partner: of each vertex of the wall: its image on another periodic side, equal to the bit but for the translation, or none; empty: none has
/// \throws Error(bad_argument) where a pattern matches no patch, or no trailing edge, or only such as have no sheet, where the stream is none, where a sheet has no room for two rows of
/// cells, where a trailing edge ends at one periodic side alone, and for first heights that are too small for the coordinates
SheetsOnWall add_wake_sheets(std::span<const WakeSheet> wakes, const Vec3& stream, double first_height, const Column<VertexId, VertexId>& partner,
                             TriMesh& wall, const RunContext& context);

}  // namespace sterna::volmesh
