// Derived, immutable connectivity of a TriMesh. A half-edge is 3*triangle + corner and runs from that corner's vertex to the next
// corner's, so next() and tri() are arithmetic and only the twin is stored.
#pragma once

#include <span>

#include "geom/base/halfedge.h"
#include "geom/base/run_context.h"
#include "geom/mesh/tri_mesh.h"

namespace sterna {

class Topology {
 public:
  /// Finds twins by sorting; parallel, O(n log n).
  /// \pre indices in range, no triangle with a repeated vertex.
  /// \throws Error(non_manifold_surface) if an edge has more than two triangles or two of the same sense.
  Topology(const TriMesh& mesh, const RunContext& context);

  HalfedgeId twin(HalfedgeId h) const { return twin_[h]; }  ///< invalid on the boundary
  const Column<HalfedgeId, HalfedgeId>& twins() const { return twin_; }
  VertexId from(HalfedgeId h) const { return from_[h]; }
  VertexId to(HalfedgeId h) const { return from_[next(h)]; }
  bool is_boundary(HalfedgeId h) const { return !twin_[h].is_valid(); }
  std::size_t n_halfedges() const { return from_.size(); }
  std::size_t n_boundary_halfedges() const { return n_boundary_; }

  /// Returns the half-edges that start at v, ordered by id; one per incident triangle.
  std::span<const HalfedgeId> outgoing(VertexId v) const {
    return {outgoing_.data() + first_outgoing_[v.index()], first_outgoing_[v.index() + 1] - first_outgoing_[v.index()]};
  }
  /// Returns the neighbouring vertices of v by ascending id.
  std::span<const VertexId> neighbours(VertexId v) const {
    return {neighbours_.data() + first_neighbour_[v.index()], first_neighbour_[v.index() + 1] - first_neighbour_[v.index()]};
  }

 private:
  Column<HalfedgeId, VertexId> from_;
  Column<HalfedgeId, HalfedgeId> twin_;
  std::vector<std::uint64_t> first_outgoing_;
  std::vector<HalfedgeId> outgoing_;
  std::vector<std::uint64_t> first_neighbour_;
  std::vector<VertexId> neighbours_;
  std::size_t n_boundary_ = 0;
};

/// Component number of every triangle, and the number of components. Components are connected over edges and numbered in the order of their first triangles.
struct Components {
  Column<TriangleId, std::uint32_t> component;
  std::uint32_t count = 0;
};
Components connected_components(const TriMesh& mesh, const Topology& topology);

}  // namespace sterna
