// A triangle mesh that is changed in place (splits, collapses, flips). Half-edge 3 t + c begins at corner c of triangle t.
#pragma once

#include <array>
#include <cstdint>
#include <vector>

#include "geom/base/vec3.h"
#include "surfmesh/remesh/reference.h"

namespace sterna::surfmesh {

inline constexpr std::uint32_t k_none = 0xffffffffu;

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
  std::uint32_t out = k_none;     ///< a half-edge that begins here; k_none: the vertex is deleted
  bool is_fixed = false;          ///< on a line with rows, or at the outer end of rows: neither moved nor removed
};

struct WorkMesh {
  std::vector<WorkVertex> vertices;
  std::vector<std::array<std::uint32_t, 3>> triangles;  ///< vertices of each triangle; [0] = k_none: the triangle is deleted
  std::vector<std::uint32_t> twin;                      ///< twin of each half-edge; k_none: open boundary
  std::vector<std::int32_t> line;                       ///< line of the edge of each half-edge
  std::vector<TriangleId> hint;                         ///< for each triangle a nearby triangle of the reference in the same smooth piece

  static std::uint32_t next(std::uint32_t h) { return h % 3 == 2 ? h - 2 : h + 1; }
  static std::uint32_t prev(std::uint32_t h) { return h % 3 == 0 ? h + 2 : h - 1; }
  std::uint32_t from(std::uint32_t h) const { return triangles[h / 3][h % 3]; }
  std::uint32_t to(std::uint32_t h) const { return from(next(h)); }
  std::uint32_t apex(std::uint32_t h) const { return from(prev(h)); }
  bool is_gone(std::uint32_t t) const { return triangles[t][0] == k_none; }
  const Point& at(std::uint32_t v) const { return vertices[v].point; }

  /// Visits the half-edges that begin at v, one for each triangle.
  template <class Visit>
  void for_out(std::uint32_t v, const Visit& visit) const {
    const std::uint32_t first = vertices[v].out;
    std::uint32_t h = first;
    do {
      visit(h);
      h = twin[prev(h)];
    } while (h != first && h != k_none);
    if (h == first) return;
    for (h = twin[first]; h != k_none; h = twin[h]) {
      h = next(h);
      visit(h);
    }
  }
  /// Visits the neighbours of v. On an open boundary this includes the neighbour to which no half-edge from v leads.
  template <class Visit>
  void for_ring(std::uint32_t v, const Visit& visit) const {
    for_out(v, [&](std::uint32_t h) {
      visit(to(h));
      if (twin[prev(h)] == k_none) visit(apex(h));
    });
  }
  bool is_edge(std::uint32_t a, std::uint32_t b) const;

  /// Splits the edge of h; the vertex `m` becomes its middle.
  void split(std::uint32_t h, std::uint32_t m);
  /// Merges the start vertex of h into its end vertex.
  /// \pre the link condition holds
  void collapse(std::uint32_t h);
  /// \pre the edge has two triangles and is not on a line, and no edge joins the apexes of these triangles
  void flip(std::uint32_t h);
  /// Removes deleted vertices and triangles. Neighbours in space become neighbours in memory.
  void renumber();

 private:
  void join(std::uint32_t a, std::uint32_t b, std::int32_t l);
};

/// Returns the reference's own triangles as a work mesh.
WorkMesh work_mesh_of(const Reference& reference);

}  // namespace sterna::surfmesh
