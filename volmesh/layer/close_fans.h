// Converts the layer on an opened wall to the layer on the given wall: growth lines with a common ridge base vertex meet there, and explicit cells fill the
// open gaps.
#pragma once

#include <vector>

#include "geom/base/error.h"
#include "volmesh/envelope/opened_ridges.h"
#include "volmesh/layer/assemble.h"

namespace sterna::volmesh {

/// Error for multi-normal fans without valid cells.
class FanError : public Error {
 public:
  FanError(ErrorInfo info, std::vector<VertexId> feet) : Error(std::move(info)), feet_(std::move(feet)) {}
  /// Ridge base vertices, numbered as in the given wall, ascending: these have to stay closed.
  const std::vector<VertexId>& feet() const { return feet_; }

 private:
  std::vector<VertexId> feet_;
};

/// Creates the cells around opened ridges. On each edge of a ridge, between two growth lines of each ridge base vertex: a prism along the edge on the wall,
/// hexahedra above it, and in the last layer pyramids and tetrahedra around its centre, so that the layer ends in triangles. At a corner, on each triangle
/// around its middle, and at a ridge's end: a tetrahedron, then prisms. The growth line of a ridge's end has one layer less, at the wall, where the cells
/// around it are pyramids. These cells, and the prisms of the wall triangles at growth lines that were added or have a layer less, are explicit; all others
/// stay columns. In planes on which the wall ends boundary faces close the gaps. Nodes: growth lines of the given vertices, growth lines that were added,
/// outer boundary, centres.
/// \pre mesh and boundary from assemble_layers() and fill_boundary() on the opened wall, without disc cuts
/// \post wall faces equal those of the given wall, to the bit; every explicit cell is valid by the exact test of its kind, with positive dual sub-volumes.
/// Points of the boundary keep their numbers, its triangles are reordered: triangles on columns first.
/// \throws FanError if a cell is invalid, or if a growth line of a multi-normal fan is collapsed
void close_fans(const OpenedRidges& ridges, HybridMesh& mesh, FillBoundary& boundary);

}  // namespace sterna::volmesh
