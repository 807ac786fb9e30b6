// A mesh that a file gives by its faces (OpenFOAM, Fluent), and its cells rebuilt from them.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "geom/base/run_context.h"
#include "geom/mesh/hybrid_mesh.h"

namespace sterna::io {

/// Faces with their cells. Internal faces have a neighbour, boundary faces a patch.
struct FaceBasedMesh {
  static constexpr std::uint32_t k_none = NodeId::k_invalid;
  std::vector<std::uint32_t> nodes;      ///< of all faces, one after the other
  std::vector<std::uint64_t> first;      ///< of each face in `nodes`, and the end; starts with 0
  std::vector<std::uint32_t> owner;      ///< the face's right-hand normal points out of it
  std::vector<std::uint32_t> neighbour;  ///< k_none at the boundary
  std::vector<PatchId> patch;            ///< invalid inside
  std::uint64_t n_cells = 0;

  std::size_t n_faces() const { return owner.size(); }
};

/// Fills the explicit cells and the boundary of `mesh`, whose points and patches are there. Cells of a kind keep their order; prisms stand on the triangle with
/// their lowest node.
/// \pre node and cell numbers in range
/// \throws Error file_malformed (a cell whose faces do not close, a face with the wrong sense), unsupported_format (polyhedra, faces of five and more nodes)
void add_cells_and_boundary(const FaceBasedMesh& faces, HybridMesh& mesh, const std::string& source, const RunContext& context);

}  // namespace sterna::io
