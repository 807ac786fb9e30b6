// Converts the layer on a wall with wake sheets to the layer on the given wall. Growth lines of both sides of a sheet meet on the sheet.
#pragma once

#include "volmesh/envelope/doubled_sheets.h"
#include "volmesh/layer/assemble.h"

namespace sterna::volmesh {

/// The base vertices of each sheet become the first nodes on both of its sides. Cells on one side then share their base triangles with the cells on the other
/// side, and the sheet's wall triangles are no longer part of the boundary. Cells on sheets, and cells of the wall beside added growth lines, are explicit; all
/// other cells stay in columns. Nodes: growth lines of the given vertices, growth lines of the sheets, outer boundary.
/// \pre mesh and boundary were made by assemble_layers() and fill_boundary() on the wall with at least one sheet, without disc cuts and multi-normal fans
/// \post wall faces equal those of the given wall; every explicit cell is valid by the exact test of its kind, with positive dual sub-volumes. Points of the
/// boundary keep their numbers. Its triangles are reordered, with triangles on columns first
/// \throws Error(envelope_failed) with locations if a cell is invalid
void close_wakes(const DoubledSheets& sheets, HybridMesh& mesh, FillBoundary& boundary);

}  // namespace sterna::volmesh
