// From the layer on an opened wall to the layer on the given one: lines of one foot meet there, and explicit cells fill what was open.
#pragma once

#include <vector>

#include "geom/base/error.h"
#include "volmesh/envelope/opened_ridges.h"
#include "volmesh/layer/assemble.h"

namespace sterna::volmesh {

/// Fans that have no valid cells.
class FanError : public Error {
 public:
  FanError(ErrorInfo info, std::vector<VertexId> feet) : Error(std::move(info)), feet_(std::move(feet)) {}
  /// Of the given wall, ascending: what to leave closed.
  const std::vector<VertexId>& feet() const { return feet_; }

 private:
  std::vector<VertexId> feet_;
};

/// Gives the mesh its cells around opened ridges. On each edge of a ridge, between two lines of each foot: a prism along the edge on the wall, hexahedra above
/// it, and in the last layer pyramids and tetrahedra around its centre, so that the layer ends in triangles. At a corner, on each
/// triangle around its middle, and at a ridge's end: a tetrahedron, then prisms; the end's own line has one layer less, at the wall, where the cells around it
/// are pyramids. These cells, and the prisms of the wall triangles at lines that were added or have a layer less, are explicit; all others stay columns. In
/// planes on which the wall ends boundary faces close them. Nodes: lines of the given vertices, lines that were added, outer boundary, centres.
/// \pre mesh and boundary of assemble_layers() and fill_boundary() on the opened wall, without slits
/// \post wall faces are those of the given wall, to the bit; every explicit cell is valid by the exact test of its kind, with positive dual sub-volumes. Points
/// of the boundary keep their numbers, its triangles come in another order: those on columns first.
/// \throws FanError where a cell is not, and where a line of a fan is collapsed
void close_fans(const OpenedRidges& ridges, HybridMesh& mesh, FillBoundary& boundary);

}  // namespace sterna::volmesh
