// Inserts one point into a tetrahedral mesh. The Delaunay cavity around the point, as far as it is visible within the boundary, is filled with tetrahedra at
// the point (Bowyer 1981, Watson 1981).
#pragma once

#include <array>
#include <cstdint>
#include <span>
#include <vector>

#include "geom/tets/blocks.h"
#include "geom/tets/tet_mesh.h"

namespace sterna::tets {

/// Tests if a point lies inside the sphere around a positive tetrahedron. Among cospherical points the one with the highest number counts as lifted furthest
/// off the paraboloid, then the next, so every set of points has a unique Delaunay triangulation (Devillers and Teillaud 2003). Never 0.
int perturbed_sphere_side(const TetMesh& mesh, const Corners& tet, std::uint32_t point);

/// Largest number of tetrahedra in a cavity. Without this limit, each point beyond a strip of sliver triangles would see all others.
inline constexpr std::size_t k_largest_cavity = 4000;
inline constexpr std::size_t k_chunk = 1 << 13;  ///< slots of tetrahedra that are processed together, or skipped if nothing has changed

enum class Insertion : std::uint8_t {
  done,
  outside,     ///< the path to the point is blocked by the boundary
  too_near,    ///< a point of the mesh is nearer than allowed
  beaten,      ///< a point inserted by the same call of BulkInserter is nearer than allowed
  encroaches,  ///< the point is too low above a boundary triangle
  no_cavity,   ///< the tetrahedra around the point cannot be replaced by positive ones
  foreign,     ///< tetrahedra of another block are affected, or there are no free slots: to be retried later
};

/// Data that insertions of a whole pass work on. Each slot belongs to the block that contains the last corner of its tetrahedron, or of its former tetrahedron.
/// Only that block changes it while blocks run in parallel; other blocks read at most the corners of slots next to their own, which do not change.
struct InsertTarget {
  TetMesh& mesh;
  std::vector<std::uint8_t>& mark;             ///< per slot: 0 between insertions
  std::vector<std::uint8_t>& state;            ///< per slot: set to 0 for each new tetrahedron
  std::vector<std::uint8_t>& is_changed;       ///< per chunk of k_chunk slots: set to 1 if a tetrahedron is created
  std::uint32_t n_corners = 0;                 ///< number of boundary points, which come first
  std::uint32_t first_new_point = k_none;      ///< first point of the pass
  std::size_t most_effort = k_largest_cavity;  ///< limit of tetrahedra in a cavity, and of steps in a walk
};

/// Minimum distances of a new point.
struct Room {
  double to_points = 0.0;    ///< m; smallest distance to points of the mesh that are not on the boundary
  double to_corners = 0.0;   ///< m; smallest distance to points of the boundary
  double to_boundary = 0.0;  ///< m; smallest height above a boundary triangle if the point is over it
};

/// Inserts points for one block. Reuses its memory.
class Inserter {
 public:
  /// \p free and [`first_new`, `end_new`): slots in which this block may store new tetrahedra. \p first_start: start of walks for points without a better
  /// start, or k_none.
  Inserter(const InsertTarget& target, const Block& block, std::vector<std::uint32_t> free, std::uint32_t first_new, std::uint32_t end_new,
           std::uint32_t first_start)
      : target_(target), mesh_(target.mesh), block_(block), free_(std::move(free)), next_(first_new), end_(end_new), last_(first_start) {}

  /// \p point: its position is already in mesh.points, within the block; \p start: a slot of the block near to it, or k_none
  /// \post unless the result is done, the mesh is unchanged
  Insertion insert(std::uint32_t point, std::uint32_t start, const Room& room);

  /// Returns the unused slots, first those given back, then the unused new ones, ascending.
  std::vector<std::uint32_t> take_free();

 private:
  struct CavityFace {
    std::array<std::uint32_t, 3> nodes;  ///< the cavity is on the side to which the normal points
    std::uint32_t outer;                 ///< this face in the tetrahedron behind it (4 tet + corner), or k_none
    std::uint32_t tet;                   ///< tetrahedron of the cavity that has the face
  };
  struct EdgeEntry {
    std::uint64_t edge = 0;
    std::uint32_t epoch = 0;
    std::uint32_t face = 0;
  };

  bool is_foreign(std::uint32_t t) const { return !block_.holds(mesh_.points[mesh_.nodes[t][3]]); }
  /// Returns done if the point is not too near to v.
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
