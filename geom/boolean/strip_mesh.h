// For geom/boolean and surfmesh/wrap: a closed triangulation that is changed by local exchanges of triangles, each of which is verified to be valid before it
// is made.
#pragma once

#include <array>
#include <cstdint>
#include <limits>
#include <span>
#include <unordered_map>
#include <vector>

#include "geom/base/borrowed.h"
#include "geom/base/ids.h"
#include "geom/mesh/bvh.h"

namespace sterna {

/// Spatial index of triangles: hashed cells of sizes 2^k, each triangle in the cells of about its own size.
class TriangleGrid {
 public:
  void insert(TriangleId triangle, const Box& box);
  void remove(TriangleId triangle, const Box& box);
  /// Visits candidates whose boxes may overlap `box`, some of them several times.
  template <class Visit>
  void for_each_near(const Box& box, const Visit& visit) const;

 private:
  using Cell = std::array<std::int64_t, 3>;
  struct CellHash {
    std::size_t operator()(const Cell& c) const {
      return static_cast<std::size_t>(c[0]) * 73856093u ^ static_cast<std::size_t>(c[1]) * 19349663u ^ static_cast<std::size_t>(c[2]) * 83492791u;
    }
  };
  struct Level {
    int exponent = 0;
    std::unordered_map<Cell, std::vector<TriangleId>, CellHash> cells;
  };
  static int exponent_of(const Box& box);
  static std::array<Cell, 2> range_of(const Box& box, int exponent);
  Level& level(int exponent);

  std::vector<Level> levels_;  ///< in order of first use
};

/// A triangle with the data that the remesher needs.
struct StripTriangle {
  TriangleVertices v{};
  std::uint32_t region = 0;  ///< the input part and patch that it lies on
  Vec3 normal;               ///< unit normal of the input triangle that it is a piece of; after merging, between the normals of the merged triangles
};

/// Limits of all exchanges.
struct StripLimits {
  double max_bend = 0.35;  ///< rad; edges whose input triangles bend by more are kept, and no triangle's normal may turn by more from that of its input
                           ///< triangle
};

/// Limits of a collapse.
struct CollapseLimits {
  double least_angle = 0.0;      ///< rad; no triangle may get a smaller angle, unless the smallest angle of the changed triangles increases
  double longest = 0.0;          ///< m; limit of new edges
  double tolerance = 0.0;        ///< m; largest distance from the reference, and of kept lines from their original position
  double merge = 0.0;            ///< m; two vertices nearer than this may be merged, even if kept lines or angles would prevent it
  bool is_one_location = false;  ///< the caller has verified that the two vertices may be joined as if they were nearer than `merge`
};

/// Mesh with local operations. Vertices and triangles are never renumbered; removed ones leave unused slots.
class StripMesh {
 public:
  /// `reference`: the surface that limits the deviation.
  /// \pre closed, manifold
  StripMesh(Column<VertexId, Vec3> points, Column<TriangleId, StripTriangle> triangles, const StripLimits& limits, Borrowed<const TriangleTree> reference);

  Column<VertexId, Vec3> points;
  Column<TriangleId, StripTriangle> triangles;
  Column<TriangleId, char> is_alive;
  Column<VertexId, std::vector<TriangleId>> star;  ///< existing triangles at each vertex; empty: the vertex was removed

  std::array<Vec3, 3> corners(TriangleId t) const;
  /// Returns the smallest angle, rad; 0 for zero area.
  double min_angle(TriangleId t) const { return min_angle(triangles[t].v); }
  double min_angle(const TriangleVertices& v) const;
  /// Returns the triangle with the directed edge a -> b; an invalid one if there is no such edge.
  TriangleId triangle_at(VertexId a, VertexId b) const;
  VertexId opposite(TriangleId t, VertexId a, VertexId b) const;
  /// Returns true if the edge is a border of regions (including intersection curves of parts) or a ridge.
  bool is_kept_edge(VertexId a, VertexId b) const;
  /// Returns the neighbouring vertices, ascending.
  std::vector<VertexId> neighbours(VertexId v) const;
  std::vector<VertexId> kept_neighbours(VertexId v) const;

  /// The following operations change the mesh and return true, or leave it unchanged and return false. `tolerance` (m): largest distance from the reference.
  /// flip replaces the edge by the other diagonal.
  /// \pre the edge is not kept
  bool flip(VertexId a, VertexId b, double min_gain, double tolerance);
  /// Moves `from` to `to` and merges the two. A vertex on kept edges can only move along them; a corner cannot move.
  bool collapse(VertexId from, VertexId to, const CollapseLimits& limits);
  /// Inserts a new vertex at the midpoint of an edge and returns it; returns an invalid vertex if the mesh is unchanged.
  VertexId split(VertexId a, VertexId b);
  /// Moves a vertex that is not on kept edges if that increases the smallest angle around it.
  bool move(VertexId v, const Vec3& to, double tolerance);

  /// Returns the number of crossing pairs between triangles of `set` and all others.
  std::size_t count_crossings(std::span<const TriangleId> set) const;

 private:
  struct Exchange {
    std::vector<TriangleId> removed;
    std::vector<StripTriangle> added;
  };
  /// Returns true if no new triangle turns from its input triangle by more than max_bend. Triangles thinner than `negligible` (m) are not tested, since they
  /// have no normal.
  bool are_normals_sound(const Exchange& exchange, double negligible = 0.0) const;
  /// Returns true if the kept edges at `from` allow moving it to `to`.
  bool is_way_along_kept_edges(VertexId from, VertexId to, double tolerance) const;
  bool is_near_reference(const Exchange& exchange, double tolerance) const;
  /// Applies the exchange. Reverts it if it causes new crossings, or does not reduce their number (with `may_leave` an equal number is accepted).
  bool exchange_without_crossing(const Exchange& exchange, bool may_leave = false);
  void apply(const Exchange& exchange, std::vector<TriangleId>& added);
  void revert(const Exchange& exchange, const std::vector<TriangleId>& added);
  void insert(TriangleId t);
  void remove(TriangleId t);
  Box box_of(TriangleId t) const;

  StripLimits limits_;
  const TriangleTree& reference_;
  TriangleGrid grid_;
};

// ---- inline ----

template <class Visit>
void TriangleGrid::for_each_near(const Box& box, const Visit& visit) const {
  for (const Level& level : levels_) {
    const auto [low, high] = range_of(box, level.exponent);
    double n_cells = 1.0;
    for (std::size_t k = 0; k < 3; ++k) n_cells *= static_cast<double>(high[k] - low[k] + 1);
    if (n_cells > static_cast<double>(level.cells.size())) {  // a large box among small triangles
      for (const auto& [cell, items] : level.cells) {
        if (cell[0] < low[0] || cell[0] > high[0] || cell[1] < low[1] || cell[1] > high[1] || cell[2] < low[2] || cell[2] > high[2]) continue;
        for (const TriangleId t : items) visit(t);
      }
      continue;
    }
    for (std::int64_t i = low[0]; i <= high[0]; ++i)
      for (std::int64_t j = low[1]; j <= high[1]; ++j)
        for (std::int64_t k = low[2]; k <= high[2]; ++k) {
          const auto found = level.cells.find({i, j, k});
          if (found == level.cells.end()) continue;
          for (const TriangleId t : found->second) visit(t);
        }
  }
}

}  // namespace sterna
