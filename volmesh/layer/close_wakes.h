// From the layer on a wall with wake sheets to the layer on the given wall: lines of both sides of a sheet meet on it.
#pragma once

#include "volmesh/envelope/doubled_sheets.h"
#include "volmesh/layer/assemble.h"

namespace sterna::volmesh {

/// Both sides of each sheet get its feet as their first nodes, so that the cells on one share their base triangles with those on the other; the sheet's wall
/// triangles are no boundary any more. Cells on sheets, and those of the wall beside lines that were added, are explicit; all others stay columns. Nodes: lines
/// of the given vertices, those of the sheets, outer boundary.
/// \pre mesh and boundary of assemble_layers() and fill_boundary() on the wall with sheets, without slits and fans
/// \post wall faces are those of the given wall; every explicit cell is valid by the exact test of its kind, with positive dual sub-volumes. Points of the
/// boundary keep their numbers, its triangles come in another order: those on columns first.
/// \throws Error(envelope_failed) with places where a cell is not
void close_wakes(const DoubledSheets& sheets, HybridMesh& mesh, FillBoundary& boundary);

}  // namespace sterna::volmesh
