// Replaces groups of tetrahedra by flips of faces and edges, with undo. The flips keep every tetrahedron positive, and keep every required edge and facet.
#pragma once

#include <cstdint>
#include <functional>
#include <span>
#include <vector>

#include "geom/base/borrowed.h"
#include "geom/tets/facets.h"
#include "geom/tets/tet_mesh.h"

namespace sterna::tets {

/// Tetrahedra around the edge p-q: tets[i] has p, q, vertices[i] and vertices[i + 1] (cyclic), positive in that order.
struct Ring {
  std::vector<std::uint32_t> tets, vertices;
};

/// Penalties of new edges and faces. Larger numbers are worse, 0 is good. The functions may be empty.
struct FlipCosts {
  std::function<int(std::uint32_t, std::uint32_t)> edge;
  std::function<int(std::uint32_t, std::uint32_t, std::uint32_t)> face;
};

/// Operates on a mesh that fills a convex region: a face without neighbour is on its hull. Serial. During its lifetime no other code may change the mesh. Slots
/// of removed tetrahedra stay empty.
class Flips {
 public:
  /// The edges and facets of the second argument are kept where they exist.
  Flips(Borrowed<TetMesh> mesh, Borrowed<const FacetIndex> required);

  const TetMesh& mesh() const { return mesh_; }
  const FacetIndex& required() const { return required_; }
  /// Returns a tetrahedron at a point that has one.
  std::uint32_t tet_at(std::uint32_t v) const { return tet_at_[v]; }
  /// Collects all tetrahedra at a point, the first being tet_at().
  void star(std::uint32_t v, std::vector<std::uint32_t>& tets);
  /// Returns a tetrahedron with both points, or k_none.
  std::uint32_t tet_with_edge(std::uint32_t p, std::uint32_t q);
  /// Collects the tetrahedra around an edge. Returns false if there is no such edge, or if it lies on the hull.
  bool find_ring(std::uint32_t p, std::uint32_t q, Ring& ring);
  bool has_facet(std::uint32_t a, std::uint32_t b, std::uint32_t c);

  /// Replaces a face by the edge through its two neighbours (2-3 flip). Returns false if the result would contain a flat or inverted tetrahedron, and for
  /// required facets and faces on the hull. \p face: 4 tet + corner
  bool flip_face(std::uint32_t face);
  /// Retetrahedralises the ring around an edge without that edge, choosing the positive tetrahedra of lowest cost. If there are none and `depth` is above 0,
  /// edges from p or q to the ring that prevent the removal are removed first, in the same way. Returns false for required edges and edges on the hull.
  /// \post if the result is false, all changes are undone
  bool remove_edge(std::uint32_t p, std::uint32_t q, int depth, const FlipCosts& costs);
  /// Inserts a new point and connects it to the boundary of the tetrahedra whose spheres contain it, as far as required edges and facets allow. Returns false
  /// if it falls on a face. \p start: a tetrahedron near to it. The insertion cannot be undone.
  bool add_point(const Vec3& position, std::uint32_t start);

  /// Inserts a new point in the tetrahedra around p-q from the ring's vertex `a` to its vertex `b`, in the ring's orientation; these tetrahedra are replaced by
  /// tetrahedra with the new point. Returns false if one of them is not visible from it, or if there is no such ring.
  bool add_point_in_ring(std::uint32_t p, std::uint32_t q, std::uint32_t a, std::uint32_t b, const Vec3& position);

  /// Returns a state to which undo() can return, as long as no earlier state has been restored.
  std::size_t state() const { return journal_.size(); }
  void undo(std::size_t state);
  /// Discards the undo history.
  void accept() { journal_.clear(); }

 private:
  struct Entry {
    std::uint32_t tet;
    Corners nodes, neighbours;
    std::uint32_t n_tets;  ///< number of slots before the change
  };
  struct Side {
    Facet corners;  ///< ascending
    std::uint32_t face;
    bool is_outer;
  };
  void save(std::uint32_t t);
  bool replace(std::span<const std::uint32_t> gone, std::span<const Corners> made);
  bool fill_ring(std::uint32_t p, std::uint32_t q, const Ring& ring, const FlipCosts& costs);
  std::uint32_t tet_around_lost_edge(std::span<const std::uint32_t> cavity, std::span<const Facet> hull) const;
  bool is_positive(const Corners& v) const;

  TetMesh& mesh_;
  const FacetIndex& required_;
  std::vector<std::uint32_t> tet_at_;
  std::vector<Entry> journal_;
  std::vector<Side> sides_;
  std::vector<std::uint32_t> seen_;  ///< per slot: stamp of the last walk that visited it
  std::uint32_t stamp_ = 0;
  std::vector<std::uint32_t> star_;
  int effort_ = 0;  ///< number of edges that may still be tried before remove_edge() gives up
};

}  // namespace sterna::tets
