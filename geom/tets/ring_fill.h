// Removal of an edge of a tetrahedral mesh: the tetrahedra around it are replaced by pairs of tetrahedra over a triangulation of the ring of vertices around
// it.
#pragma once

#include <algorithm>
#include <array>
#include <cstdint>
#include <limits>

#include "geom/tets/tet_mesh.h"

namespace sterna::tets {

inline std::size_t corner_of(const Corners& v, std::uint32_t node) { return static_cast<std::size_t>(std::ranges::find(v, node) - v.begin()); }
inline bool has(const Corners& v, std::uint32_t node) { return v[0] == node || v[1] == node || v[2] == node || v[3] == node; }

/// Returns the other two corners x and y of a positive tetrahedron, such that (a, b, x, y) is positive.
/// \pre a and b are corners
inline std::array<std::uint32_t, 2> other_two(const Corners& v, std::uint32_t a, std::uint32_t b) {
  const std::size_t i = corner_of(v, a), j = corner_of(v, b);
  // Even permutations of 0123, given by their first two entries.
  constexpr std::uint8_t k_rest[4][4][2] = {
      {{0, 0}, {2, 3}, {3, 1}, {1, 2}}, {{3, 2}, {0, 0}, {0, 3}, {2, 0}}, {{1, 3}, {3, 0}, {0, 0}, {0, 1}}, {{2, 1}, {0, 2}, {1, 0}, {0, 0}}};
  return {v[k_rest[i][j][0]], v[k_rest[i][j][1]]};
}

/// Finds the triangulation of a polygon of at most `Largest` corners with the lowest sum of costs. The lowest cost between two corners follows from the costs
/// of shorter pieces (Klincsek 1980). Used for rings around edges by: Shewchuk, Two discrete optimization algorithms for the topological improvement of
/// tetrahedral meshes (2002).
template <std::size_t Largest>
class RingFill {
 public:
  /// Returns true if there is a triangulation of corners 0 to n - 1 with costs below `limit`. `with_triangle(i, j, k, sum, bound)` returns `sum` plus the cost
  /// of the triangle of corners i < j < k, or any number from `bound` on if that is not below `bound`. `with_diagonal(i, k, sum)` returns `sum` plus the cost
  /// of the diagonal.
  /// \pre n is at most Largest; no cost is negative
  template <class WithTriangle, class WithDiagonal>
  bool find(std::size_t n, double limit, const WithTriangle& with_triangle, const WithDiagonal& with_diagonal) {
    n_ = n;
    for (std::size_t i = 0; i + 1 < n; ++i) least_[i][i + 1] = 0.0;
    for (std::size_t span = 2; span < n; ++span) {
      for (std::size_t i = 0; i + span < n; ++i) {
        const std::size_t k = i + span;
        double& least = least_[i][k];
        least = std::numeric_limits<double>::infinity();
        for (std::size_t j = i + 1; j < k; ++j) {
          const double bound = std::min(least, limit);
          double sum = least_[i][j] + least_[j][k];
          if (sum < bound) sum = with_triangle(i, j, k, sum, bound);
          if (sum >= bound) continue;
          least = sum;
          middle_[i][k] = static_cast<std::uint8_t>(j);
        }
        if (span + 1 < n && least < limit) least = with_diagonal(i, k, least);
      }
    }
    return n >= 3 && cost() < limit;
  }
  /// Returns the sum of costs.
  /// \pre find() has returned true
  double cost() const { return least_[0][n_ - 1]; }
  /// Calls visit(i, j, k) for each triangle, i < j < k.
  /// \pre find() has returned true
  template <class Visit>
  void for_triangles(const Visit& visit) const {
    std::array<std::array<std::size_t, 2>, Largest> waiting;  // pieces; together they have at most n - 1 sides
    std::size_t n_waiting = 0;
    waiting[n_waiting++] = {0, n_ - 1};
    while (n_waiting > 0) {
      const auto [i, k] = waiting[--n_waiting];
      if (k == i + 1) continue;
      const std::size_t j = middle_[i][k];
      visit(i, j, k);
      waiting[n_waiting++] = {i, j};
      waiting[n_waiting++] = {j, k};
    }
  }

 private:
  std::size_t n_ = 0;
  std::array<std::array<double, Largest>, Largest> least_;         ///< lowest cost of the piece from corner i to corner k
  std::array<std::array<std::uint8_t, Largest>, Largest> middle_;  ///< third corner of the piece's triangle at its diagonal
};

}  // namespace sterna::tets
