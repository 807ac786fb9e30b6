// The new surface while it is changed: connectivity, and the location of each vertex on the reference.
#pragma once

#include <cstdint>

#include "geom/base/vec3.h"
#include "geom/mesh/edit_mesh.h"
#include "surfmesh/remesh/reference.h"

namespace sterna::surfmesh {

enum class VertexKind : std::uint8_t { face, line, corner };

/// Location of a vertex of the new surface on the reference.
struct WorkVertex {
  Point point;
  double size = 0.0;  ///< m, target edge length here
  VertexKind kind = VertexKind::face;
  std::int32_t line = k_no_line;  ///< number of the line; for kind line only
  double s = 0.0;                 ///< m, location along the line; for kind line only
  ReferenceLocation location;     ///< location on the reference; for kind face only
  Vec3 normal;                    ///< the reference's normal at the location; for kind face only
  VertexId corner;                ///< vertex of the reference; for kind corner only
  bool is_fixed = false;          ///< on a line with rows, or at the outer end of rows: neither moved nor removed
};

static_assert(k_no_line == k_no_label);

/// The labels of its edges are lines of the reference.
struct WorkMesh : EditMesh {
  Column<VertexId, WorkVertex> vertices;
  Column<TriangleId, TriangleId> hint;  ///< for each triangle a nearby triangle of the reference in the same smooth piece

  const Point& at(VertexId v) const { return vertices[v].point; }
  std::int32_t line(HalfedgeId h) const { return labels[h]; }
  bool is_line(HalfedgeId h) const { return labels[h] != k_no_line; }
  /// Returns true for one half-edge of each edge.
  bool is_first(HalfedgeId h) const { return !is_removed(triangle_of(h)) && !(twins[h] < h); }

  /// Splits the edge of `h` at the last vertex.
  /// \pre that vertex is new
  void split(HalfedgeId h);
  /// Removes deleted vertices and triangles. Neighbours in space become neighbours in memory.
  void renumber();
};

/// Returns the reference's own triangles as a work mesh.
WorkMesh work_mesh_of(const Reference& reference);

}  // namespace sterna::surfmesh
