// One point into a mesh of tetrahedra: the Delaunay cavity around it, within what the boundary lets it see, is filled anew from the point (Bowyer 1981, Watson
// 1981).
#pragma once

#include <array>
#include <cstdint>
#include <span>
#include <vector>

#include "geom/tets/blocks.h"
#include "geom/tets/tet_mesh.h"

namespace sterna::tets {

/// Whether a point lies inside the sphere around a positive tetrahedron. Of points on one sphere the one with the highest number counts as lifted furthest off
/// the paraboloid, then the next, so every set of points has one Delaunay triangulation (Devillers and Teillaud 2003). Never 0.
int perturbed_sphere_side(const TetMesh& mesh, const Corners& tet, std::uint32_t point);

/// Tetrahedra; beyond strips of needles each point would see all others.
inline constexpr std::size_t k_largest_cavity = 4000;
inline constexpr std::size_t k_chunk = 1 << 13;  ///< places of tetrahedra that are looked at together, or not at all where nothing has changed

enum class Insertion : std::uint8_t {
  done,
  outside,     ///< the way to the point is barred by the boundary
  too_near,    ///< a point of the mesh is nearer than was allowed
  beaten,      ///< the same, and that point has come by the same call of BulkInserter
  encroaches,  ///< the point is too low above a triangle of the boundary
  no_cavity,   ///< no tetrahedra around it can be replaced by positive ones
  foreign,     ///< another block's tetrahedra are in the way, or there is no room: to be tried later
};

/// What insertions of a whole pass work on. Each place belongs to the block that holds the last corner of its tetrahedron, or of the one that was there. That
/// block alone changes it while blocks work at the same time; others read of it at most the corners, next to their own, where it does not change.
struct InsertTarget {
  TetMesh& mesh;
  std::vector<std::uint8_t>& mark;             ///< of each place: 0 between insertions
  std::vector<std::uint8_t>& state;            ///< of each place: set to 0 for each new tetrahedron
  std::vector<std::uint8_t>& is_changed;       ///< of each chunk of k_chunk places: set to 1 where a tetrahedron is made
  std::uint32_t n_corners = 0;                 ///< points of the boundary: the first
  std::uint32_t first_new_point = k_none;      ///< of the pass's points
  std::size_t most_effort = k_largest_cavity;  ///< tetrahedra of a cavity, and steps of a walk, at most
};

/// What a point may come near to.
struct Room {
  double to_points = 0.0;    ///< m; to any point of the mesh but those of the boundary
  double to_corners = 0.0;   ///< m; to those
  double to_boundary = 0.0;  ///< m; above a boundary triangle that it stands over
};

/// Inserts points for one block. Keeps its memory.
class Inserter {
 public:
  /// `free` and [`first_new`, `end_new`): places where this block may put new tetrahedra; `first_start`: where points begin of which nothing better is known,
  /// or k_none.
  Inserter(const InsertTarget& target, const Block& block, std::vector<std::uint32_t> free, std::uint32_t first_new, std::uint32_t end_new,
           std::uint32_t first_start)
      : target_(target), mesh_(target.mesh), block_(block), free_(std::move(free)), next_(first_new), end_(end_new), last_(first_start) {}

  /// \p point: its place is in mesh.points already, in the block; \p start: a place of the block near to it, or k_none
  /// \post with another answer than done the mesh is as before
  Insertion insert(std::uint32_t point, std::uint32_t start, const Room& room);

  /// Places that were not used, ascending behind those that were given back.
  std::vector<std::uint32_t> take_free();

 private:
  struct CavityFace {
    std::array<std::uint32_t, 3> nodes;  ///< the cavity is on the side to which their normal points
    std::uint32_t outer;                 ///< face of the tetrahedron behind it, or k_none
    std::uint32_t tet;                   ///< of the cavity
  };
  struct EdgeEntry {
    std::uint64_t edge = 0;
    std::uint32_t epoch = 0;
    std::uint32_t face = 0;
  };

  bool is_foreign(std::uint32_t t) const { return !block_.holds(mesh_.points[mesh_.nodes[t][3]]); }
  /// done where it is not
  Insertion nearness(std::uint32_t v, const Vec3& p, const Room& room) const {
    const double least = v < target_.n_corners ? room.to_corners : room.to_points;
    if (norm2(mesh_.points[v] - p) >= least * least) return Insertion::done;
    return v < target_.first_new_point ? Insertion::too_near : Insertion::beaten;
  }
  std::uint32_t locate(const Vec3& p, std::uint32_t start, Insertion& why);
  Insertion gather(std::uint32_t point, std::uint32_t base, const Room& room);
  Insertion make_visible(const Vec3& p, std::uint32_t base, const Room& room, int most_grown);
  void collect_faces();
  void reach(std::uint32_t base);
  void fill(std::uint32_t point);
  void link(std::uint32_t a, std::uint32_t b, std::uint32_t face);
  void unmark();

  InsertTarget target_;
  TetMesh& mesh_;
  Block block_;
  std::vector<std::uint32_t> free_;
  std::uint32_t next_, end_;
  std::uint32_t last_;
  std::vector<std::uint32_t> cavity_, touched_;
  std::vector<CavityFace> faces_;
  std::vector<EdgeEntry> edges_ = std::vector<EdgeEntry>(512);
  std::uint32_t epoch_ = 0;
};

}  // namespace sterna::tets
