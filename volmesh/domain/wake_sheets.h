// Wake sheets: the wall continues behind sharp trailing edges as a body without thickness, so that the layers of both sides of a wing continue as well.
#pragma once

#include <span>
#include <vector>

#include "geom/base/run_context.h"
#include "geom/mesh/tri_mesh.h"
#include "volmesh/case/wake_sheet.h"
#include "volmesh/envelope/doubled_sheets.h"

namespace sterna::volmesh {

/// Returns the free-stream direction of a domain's boundary. In a tunnel (a boundary with inflow and without farfield patches): the mean of the inflow's
/// normals into the fluid, weighted by area. Otherwise, and if these cancel out: along x. Unit. \pre normals into the fluid
Vec3 stream_of(const TriMesh& boundary);

struct SheetsOnWall {
  DoubledSheets sheets;             ///< in numbers of the wall
  std::vector<TriangleId> sources;  ///< for each added triangle: a triangle of the wall at the trailing edge
};

/// Adds a sheet behind each trailing edge (find_trailing_edges) of the requested patches; several may match one pattern.
///
/// Lines of the sheet start at the edge's vertices, halfway between both sides of the wing (of a blunt edge: along its upper side), and turn into the free
/// stream over k_blend chords. Edges along the stream start as long as the wing's edges there and grow; all lines have the same number of edges. Where a line
/// comes near another wall or sheet, the sheet ends; it becomes narrower rather than thinner than two cells. Edges at the free ends of a trailing edge (round
/// tips) that are shorter than a quarter of the edges upstream, and of the median edge, have no sheet behind them.
///
/// At the border of an open wall (a half model) the sheet has a border in the same plane x, y or z = constant. A trailing edge between two periodic sides has
/// the same line at both. Vertices on an opened trailing edge are doubled; the vertex of the left side keeps its number. Triangles have the patch of the wall
/// at the edge.
/// \pre wall manifold; borders exactly in planes; first_height in m, the smallest of all
/// \param stream: unit, for sheets without a custom direction
/// \param partner: for each vertex of the wall: its image on another periodic side, bit-identical except for the translation, or none; empty: no vertex has one
/// \throws Error(bad_argument) if a pattern matches no patch, or no trailing edge, or only trailing edges without a sheet, if the stream has no direction, if a
/// sheet has no space for two rows of cells, if a trailing edge ends at only one of two periodic sides, and for first heights that are too small for the
/// coordinates
SheetsOnWall add_wake_sheets(std::span<const WakeSheet> wakes, const Vec3& stream, double first_height, const Column<VertexId, VertexId>& partner,
                             TriMesh& wall, const RunContext& context);

}  // namespace sterna::volmesh
