// Connectivity of a triangle mesh that is changed in place by flips, splits and collapses. Positions and other data are kept by the user of the mesh.
// Two editors have a connectivity of their own: Delaunay triangulations (geom/delaunay/triangulation.h) keep a triangle in half a cache line and have triangles
// at infinity; StripMesh (geom/boolean/strip_mesh.h) tries exchanges of triangles and takes them back.
#pragma once

#include "geom/base/halfedge.h"
#include "geom/base/ids.h"
#include "geom/mesh/topology.h"

namespace sterna {

inline constexpr std::int32_t k_no_label = -1;

/// A manifold triangle mesh, open or closed. Removed vertices and triangles leave unused slots. Changes keep the labels of edges; new edges have no label.
struct EditMesh {
  Column<TriangleId, TriangleVertices> triangles;  ///< the first vertex is invalid if the triangle is removed
  Column<HalfedgeId, HalfedgeId> twins;            ///< invalid at an open boundary
  Column<HalfedgeId, std::int32_t> labels;         ///< label of the edge, the same on both sides
  Column<VertexId, HalfedgeId> outgoing;           ///< a half-edge that begins at the vertex; invalid if the vertex has no triangles

  EditMesh() = default;
  /// \pre twins are mutual
  EditMesh(std::size_t n_vertices, Column<TriangleId, TriangleVertices> given_triangles, Column<HalfedgeId, HalfedgeId> given_twins);
  EditMesh(const TriMesh& mesh, const Topology& topology);

  VertexId from(HalfedgeId h) const { return triangles[triangle_of(h)][corner_of(h)]; }
  VertexId to(HalfedgeId h) const { return from(next(h)); }
  VertexId apex(HalfedgeId h) const { return from(previous(h)); }
  bool is_removed(TriangleId t) const { return !triangles[t][0].is_valid(); }

  /// Visits the half-edges with the same start as `first`, one for each triangle.
  /// \pre the triangles at the start of `first` are connected by edges
  template <class Visit>
  void for_out(HalfedgeId first, const Visit& visit) const {
    HalfedgeId h = first;
    do {
      visit(h);
      h = twins[previous(h)];
    } while (h != first && h.is_valid());
    if (h == first) return;
    for (h = twins[first]; h.is_valid(); h = twins[h]) {
      h = next(h);
      visit(h);
    }
  }
  /// \pre the vertex has triangles
  template <class Visit>
  void for_out(VertexId v, const Visit& visit) const {
    for_out(outgoing[v], visit);
  }
  /// Visits the neighbours of a vertex. On an open boundary this includes the neighbour to which no half-edge leads.
  /// \pre the vertex has triangles
  template <class Visit>
  void for_ring(VertexId v, const Visit& visit) const {
    for_out(v, [&](HalfedgeId h) {
      visit(to(h));
      if (!twins[previous(h)].is_valid()) visit(apex(h));
    });
  }
  /// Returns true if an edge joins the start of `first` with a vertex.
  /// \pre the triangles at the start of `first` are connected by edges
  bool is_edge(HalfedgeId first, VertexId other) const;
  bool is_edge(VertexId a, VertexId b) const { return is_edge(outgoing[a], b); }

  /// Replaces the edge of `h` by the other diagonal. The given triangles take the places of the triangles of `h` and of its twin.
  /// \pre `h` has a twin, the given triangles are those on the two sides of the other diagonal, and that diagonal is no edge yet
  void flip(HalfedgeId h, const TriangleVertices& first, const TriangleVertices& second);
  /// Splits the edge of `h` at a new vertex, which is returned. On the side of `h` and then on the side of its twin, the triangle (a, b, c) at the edge (a, b)
  /// becomes (a, m, c), and the new triangle (m, b, c) is appended. Both halves get the label of the edge.
  VertexId split(HalfedgeId h);
  /// Merges the start vertex of `h` into its end vertex, and removes the triangles at the edge.
  /// \pre the link condition holds
  void collapse(HalfedgeId h);
  /// Renumbers the corners of a triangle so that the given corner is the first.
  void rotate(TriangleId t, int first);

 private:
  void join(HalfedgeId a, HalfedgeId b, std::int32_t label);
  HalfedgeId halve(HalfedgeId h, VertexId m);
  void close(HalfedgeId h, VertexId u);
};

}  // namespace sterna
