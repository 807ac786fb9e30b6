// For geom/boolean and surfmesh/wrap: a closed triangulation that changes by small exchanges of triangles, each of which is proved harmless before it is made.
#pragma once

#include <array>
#include <cstdint>
#include <limits>
#include <optional>
#include <span>
#include <unordered_map>
#include <vector>

#include "geom/mesh/bvh.h"

namespace sterna {

/// Triangles by place: hashed cells of sizes 2^k, each triangle in the cells of about its own size.
class TriangleGrid {
 public:
  void insert(std::uint32_t triangle, const Box& box);
  void remove(std::uint32_t triangle, const Box& box);
  /// Candidates whose boxes may overlap, some of them several times.
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
    std::unordered_map<Cell, std::vector<std::uint32_t>, CellHash> cells;
  };
  static int exponent_of(const Box& box);
  static std::array<Cell, 2> range_of(const Box& box, int exponent);
  Level& level(int exponent);

  std::vector<Level> levels_;  ///< by first use
};

/// One triangle as the remesher sees it.
struct StripTriangle {
  std::array<std::uint32_t, 3> v{};
  std::uint32_t region = 0;  ///< what it lies on: of one input part, one patch
  Vec3 normal;               ///< unit, of the input triangle that it is a piece of; where triangles were merged, between theirs
};

/// What an exchange must respect.
struct StripLimits {
  double max_bend = 0.35;  ///< rad; edges whose input triangles bend by more are kept, and no triangle may turn further from its input
};

/// What a collapse must respect.
struct CollapseLimits {
  double least_angle = 0.0;   ///< rad; no triangle may get a smaller one, unless the worst of those that change gets better
  double longest = 0.0;       ///< m, of new edges
  double tolerance = 0.0;     ///< m, from the reference, and of kept lines from where they were
  double merge = 0.0;         ///< m; two vertices nearer than this are one place: neither kept lines nor angles keep them apart
  bool is_one_place = false;  ///< the caller knows that the two may be joined as if they were that near
};

/// Vertices and triangles are never renumbered; dead ones stay as holes.
class StripMesh {
 public:
  /// `reference`: the surface to stay near; must outlive this.
  /// \pre closed, manifold
  StripMesh(std::vector<Vec3> points, std::vector<StripTriangle> triangles, const StripLimits& limits, const TriangleTree& reference);

  std::vector<Vec3> points;
  std::vector<StripTriangle> triangles;
  std::vector<char> is_alive;                    ///< per triangle
  std::vector<std::vector<std::uint32_t>> star;  ///< living triangles at each vertex; empty: the vertex is gone

  std::array<Vec3, 3> corners(std::uint32_t t) const;
  /// Smallest angle, rad; 0 without area.
  double min_angle(std::uint32_t t) const { return min_angle(triangles[t].v); }
  double min_angle(const std::array<std::uint32_t, 3>& v) const;
  /// The triangle with the directed edge a -> b; none when there is no such edge.
  std::optional<std::uint32_t> triangle_at(std::uint32_t a, std::uint32_t b) const;
  std::uint32_t opposite(std::uint32_t t, std::uint32_t a, std::uint32_t b) const;
  /// A border of regions (so also the curve in which parts cross) or a ridge.
  bool is_kept_edge(std::uint32_t a, std::uint32_t b) const;
  /// Neighbouring vertices, ascending.
  std::vector<std::uint32_t> neighbours(std::uint32_t v) const;
  std::vector<std::uint32_t> kept_neighbours(std::uint32_t v) const;

  /// Each changes the mesh and returns true, or leaves it as it was. `tolerance` (m): farthest from the reference. Puts the other diagonal.
  /// \pre the edge is not kept
  bool flip(std::uint32_t a, std::uint32_t b, double min_gain, double tolerance);
  /// Puts `from` where `to` is and joins the two. A vertex of kept edges goes along them only, one of a corner nowhere.
  bool collapse(std::uint32_t from, std::uint32_t to, const CollapseLimits& limits);
  /// New vertex in the middle of an edge; its number.
  std::optional<std::uint32_t> split(std::uint32_t a, std::uint32_t b);
  /// Moves a vertex without kept edges where that improves the smallest angle around it.
  bool move(std::uint32_t v, const Vec3& to, double tolerance);

  /// Pairs of triangles among `set` and all others that cross.
  std::size_t count_crossings(std::span<const std::uint32_t> set) const;

 private:
  struct Exchange {
    std::vector<std::uint32_t> removed;
    std::vector<StripTriangle> added;
  };
  /// Triangles thinner than `negligible` (m) have no normal.
  bool are_normals_sound(const Exchange& exchange, double negligible = 0.0) const;
  /// Whether the kept edges at `from` let it go to `to`.
  bool is_way_along_kept_edges(std::uint32_t from, std::uint32_t to, double tolerance) const;
  bool is_near_reference(const Exchange& exchange, double tolerance) const;
  /// Makes it; unmakes it when it brings new crossings, or leaves as many as there were (`may_leave`: that is enough).
  bool exchange_without_crossing(const Exchange& exchange, bool may_leave = false);
  void apply(const Exchange& exchange, std::vector<std::uint32_t>& added);
  void revert(const Exchange& exchange, const std::vector<std::uint32_t>& added);
  void insert(std::uint32_t t);
  void remove(std::uint32_t t);
  Box box_of(std::uint32_t t) const;

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
        for (const std::uint32_t t : items) visit(t);
      }
      continue;
    }
    for (std::int64_t i = low[0]; i <= high[0]; ++i)
      for (std::int64_t j = low[1]; j <= high[1]; ++j)
        for (std::int64_t k = low[2]; k <= high[2]; ++k) {
          const auto found = level.cells.find({i, j, k});
          if (found == level.cells.end()) continue;
          for (const std::uint32_t t : found->second) visit(t);
        }
  }
}

}  // namespace sterna
