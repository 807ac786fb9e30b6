// Converts the layer on an opened wall to the layer on the given wall. Growth lines with a common ridge base vertex meet in this vertex, and explicit cells
// fill the open gaps.
#pragma once

#include <vector>

#include "geom/base/error.h"
#include "volmesh/envelope/opened_ridges.h"
#include "volmesh/layer/assemble.h"

namespace sterna::volmesh {

/// Error for multi-normal fans that have no valid cells.
class MultiNormalError : public Error {
 public:
  MultiNormalError(ErrorInfo info, std::vector<VertexId> base_vertices) : Error(std::move(info)), base_vertices_(std::move(base_vertices)) {}
  /// Returns the ridge base vertices that have to stay closed, numbered as in the given wall, ascending.
  const std::vector<VertexId>& base_vertices() const { return base_vertices_; }

 private:
  std::vector<VertexId> base_vertices_;
};

/// Creates the cells around opened ridges. On each ridge edge, between two growth lines of each ridge base vertex, there are a prism along the edge on the
/// wall, hexahedra above it, and in the last layer pyramids and tetrahedra around its centre, so that the layer ends in triangles. On each triangle around the
/// middle of a corner, and at the end of a ridge, there are a tetrahedron and prisms above it. The growth line at the end of a ridge has one layer less, next
/// to the wall, where the cells around it are pyramids. These cells are explicit. Explicit are also the prisms of wall triangles at growth lines that were
/// added or have one layer less; all other cells stay in columns. In planes in which the wall ends, boundary faces close the gaps. Nodes: growth lines of the
/// given vertices, added growth lines, outer boundary, centres.
/// \pre mesh and boundary were made by assemble_layers() and fill_boundary() on the wall with at least one opened ridge, without disc cuts
/// \post wall faces equal those of the given wall bit-exactly; every explicit cell is valid by the exact test of its kind, with positive dual sub-volumes.
/// Points of the boundary keep their numbers. Its triangles are reordered, with triangles on columns first
/// \throws MultiNormalError if a cell is invalid, or if a growth line of a multi-normal fan is collapsed
void close_multi_normals(const OpenedRidges& ridges, HybridMesh& mesh, FillBoundary& boundary);

}  // namespace sterna::volmesh
