// Triangulated surface with named patches: the wall, a farfield, or the connectivity of an envelope. It is closed or has a boundary. Once it has passed
// surfmesh::stitch_surface it is manifold and consistently oriented.
#pragma once

#include <cstdint>
#include <string>
#include <string_view>

#include "geom/base/ids.h"
#include "geom/base/vec3.h"

namespace sterna {

enum class PatchKind { wall, slip, symmetry, inflow, outflow, farfield, interface };
/// Returns "wall", "slip", ...
std::string_view to_string(PatchKind kind);

struct Patch {
  std::string name;
  PatchKind kind = PatchKind::wall;
  friend bool operator==(const Patch&, const Patch&) = default;
};

/// Triangulated surface as a plain struct of columns. Invariants (checked by surfmesh::stitch_surface and geom/mesh/check.h, not by this type): indices in
/// range; every edge has one or two triangles, two with opposite sense; normals (right-hand rule) point into the fluid, out of the body.
struct TriMesh {
  Column<VertexId, Point> points;  ///< metres
  Column<TriangleId, TriangleVertices> triangles;
  Column<TriangleId, PatchId> triangle_patch;  ///< same size as triangles
  Column<PatchId, Patch> patches;

  std::size_t n_vertices() const { return points.size(); }
  std::size_t n_triangles() const { return triangles.size(); }
};

struct Box {
  Vec3 min{1e300, 1e300, 1e300};
  Vec3 max{-1e300, -1e300, -1e300};
  void add(const Vec3& p);
  void add(const Box& b);
  bool empty() const { return min.x > max.x; }
  Vec3 center() const { return 0.5 * (min + max); }
  /// Returns the longest side; for the box of all walls this is the "body length" of docs/method/envelope.md, "Notation".
  double longest_side() const;
};

Box bounding_box(const TriMesh& mesh);
/// Returns the body length L = longest side of the axis-parallel box of all walls (docs/method/envelope.md, "Notation").
double body_length(const TriMesh& wall);

/// Returns the corner points of a triangle.
inline std::array<Point, 3> corners(const TriMesh& mesh, TriangleId t) {
  const TriangleVertices& v = mesh.triangles[t];
  return {mesh.points[v[0]], mesh.points[v[1]], mesh.points[v[2]]};
}

/// Appends `other`; patches of the same name and kind are merged. Vertices are not merged.
void append(TriMesh& mesh, const TriMesh& other);

}  // namespace sterna
