// Finds boundary faces of a mesh that no patch lists, for files without a boundary, or with only a part of it.
#pragma once

#include <cstdint>
#include <vector>

#include "geom/base/run_context.h"
#include "geom/mesh/hybrid_mesh.h"

namespace sterna {

/// Faces of exactly one cell that no boundary face covers, with their normals outwards; their `patch` is invalid.
struct OpenFaces {
  std::vector<BoundaryTriangle> triangles;
  std::vector<BoundaryQuad> quads;
  std::size_t size() const { return triangles.size() + quads.size(); }
  /// Returns the centre of the first face. \pre size() > 0
  Point first_location(const HybridMesh& mesh) const;
};

/// Finds the open faces, in the order of their cells. If the boundary is complete, this takes one pass over the faces.
/// \pre node ids in range
/// \throws Error(overflow) for meshes of some 500 million cells
OpenFaces find_open_faces(const HybridMesh& mesh, const RunContext& context);

/// Adds the faces as a wall patch called `name` (with an appended number if the mesh already has such a patch). \returns the new patch
PatchId add_boundary(HybridMesh& mesh, const OpenFaces& faces, std::string_view name);

/// Returns the number of points that no cell and no boundary face uses.
std::uint64_t count_unused_points(const HybridMesh& mesh);
/// Removes the unused points; the order of the others is kept. \pre a mesh without columns (HybridMesh::layers)
void drop_unused_points(HybridMesh& mesh);

}  // namespace sterna
