// A mesh given by its faces (OpenFOAM, Fluent), and reconstruction of its cells.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "geom/base/run_context.h"
#include "geom/mesh/hybrid_mesh.h"

namespace sterna::io {

/// Faces with their cells. Internal faces have a neighbour, boundary faces have a patch.
struct FaceBasedMesh {
  std::vector<std::uint32_t> nodes;      ///< nodes of all faces, concatenated
  std::vector<std::uint64_t> first;      ///< start of each face in `nodes`, and the end; the first value is 0
  std::vector<std::uint32_t> owner;      ///< the face's right-hand normal points out of it
  std::vector<std::uint32_t> neighbour;  ///< k_none at the boundary
  std::vector<PatchId> patch;            ///< invalid for internal faces
  std::uint64_t n_cells = 0;

  std::size_t n_faces() const { return owner.size(); }
};

/// Adds the explicit cells and the boundary to `mesh`, which already has points and patches. Cells of a kind keep their order; a prism's base is the triangle
/// with the lowest node.
/// \pre node and cell numbers in range
/// \throws Error file_malformed (a cell with an open surface, a face with the wrong orientation), unsupported_format (polyhedra, faces of five and more nodes)
void add_cells_and_boundary(const FaceBasedMesh& faces, HybridMesh& mesh, const std::string& source, const RunContext& context);

}  // namespace sterna::io
