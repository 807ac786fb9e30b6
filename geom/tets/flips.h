// Other tetrahedra in the place of some: flips of faces and edges that keep every tetrahedron positive and every wanted edge and facet, with a way back.
#pragma once

#include <cstdint>
#include <functional>
#include <span>
#include <vector>

#include "geom/tets/facets.h"
#include "geom/tets/tet_mesh.h"

namespace sterna::tets {

/// Tetrahedra around the edge p-q: tets[i] has p, q, vertices[i] and vertices[i + 1] (cyclic), positive in that order.
struct Ring {
  std::vector<std::uint32_t> tets, vertices;
};

/// What new elements should not do: a number for how bad it would be to have an edge, or a face; 0 is good. May be empty.
struct FlipCosts {
  std::function<int(std::uint32_t, std::uint32_t)> edge;
  std::function<int(std::uint32_t, std::uint32_t, std::uint32_t)> face;
};

/// Works on a mesh that fills a convex region: a face without neighbour is of its hull. Serial. While it lives nobody else changes the mesh. Places of
/// tetrahedra that are gone stay empty.
class Flips {
 public:
  /// \p wanted: edges and facets that are kept where they are there
  Flips(TetMesh& mesh, const FacetIndex& wanted);

  const TetMesh& mesh() const { return mesh_; }
  const FacetIndex& wanted() const { return wanted_; }
  /// A tetrahedron at a point that has one.
  std::uint32_t tet_at(std::uint32_t v) const { return tet_at_[v]; }
  /// All tetrahedra at a point, the first being tet_at().
  void star(std::uint32_t v, std::vector<std::uint32_t>& tets);
  /// A tetrahedron with both points, or k_none.
  std::uint32_t tet_with_edge(std::uint32_t p, std::uint32_t q);
  /// False where there is no such edge, or where it lies on the hull.
  bool find_ring(std::uint32_t p, std::uint32_t q, Ring& ring);
  bool has_facet(std::uint32_t a, std::uint32_t b, std::uint32_t c);

  /// Puts the edge through two neighbours in the place of their face (2-3). False where that gives a flat or inverted tetrahedron, for a wanted facet, and on
  /// the hull. \p face: 4 tet + corner
  bool flip_face(std::uint32_t face);
  /// Fills the ring around an edge without that edge: of all ways with positive tetrahedra the one of least cost. Where there is none, and depth is above 0,
  /// edges from p or q to the ring that stand in the way are removed first, in the same way. False for wanted edges, and on the hull.
  /// \post false: what has been done is undone
  bool remove_edge(std::uint32_t p, std::uint32_t q, int depth, const FlipCosts& costs);
  /// A new point, connected with what the tetrahedra have around whose spheres hold it, as far as wanted edges and facets stay. False where it falls on a
  /// face. \p start: a tetrahedron near to it. There is no way back behind it.
  bool add_point(const Vec3& position, std::uint32_t start);

  /// A new point in the tetrahedra around p-q from the ring's vertex `a` to its vertex `b`, in the ring's sense: afterwards it is the only one between them.
  /// False where one of them does not see it, or where there is no such ring.
  bool add_point_in_ring(std::uint32_t p, std::uint32_t q, std::uint32_t a, std::uint32_t b, const Vec3& position);

  /// A state to which undo() goes back, as long as none before has been gone back to.
  std::size_t state() const { return journal_.size(); }
  void undo(std::size_t state);
  /// Forgets the way back.
  void accept() { journal_.clear(); }

 private:
  struct Entry {
    std::uint32_t tet;
    Corners nodes, neighbours;
    std::uint32_t n_tets;  ///< places before
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
  const FacetIndex& wanted_;
  std::vector<std::uint32_t> tet_at_;
  std::vector<Entry> journal_;
  std::vector<Side> sides_;
  std::vector<std::uint32_t> seen_;  ///< of each place: stamp of the walk that has been there
  std::uint32_t stamp_ = 0;
  std::vector<std::uint32_t> star_;
  int effort_ = 0;  ///< edges that may still be tried before remove_edge() gives up
};

}  // namespace sterna::tets
