// Triangles that a tetrahedral mesh must contain, and their edges, indexed by their corners.
#pragma once

#include <array>
#include <cstdint>
#include <span>
#include <utility>
#include <vector>

#include "geom/base/ids.h"
#include "geom/base/run_context.h"

namespace sterna::tets {

using Facet = std::array<std::uint32_t, 3>;
using Edge = std::array<std::uint32_t, 2>;

/// Edges and facets by number. Edges are in ascending order of their lower corner, then of the other.
class FacetIndex {
 public:
  /// \pre corner indices are below n_points; the three corners of a facet differ
  FacetIndex(std::span<const Facet> facets, std::size_t n_points, const RunContext& context);

  std::span<const Facet> facets() const { return facets_; }
  std::size_t n_edges() const { return high_.size(); }
  Edge edge(std::size_t i) const { return {low_[i], high_[i]}; }
  /// Returns the number of the edge between two points (any points), or k_none.
  std::uint32_t find_edge(std::uint32_t a, std::uint32_t b) const;
  /// Returns the number of the facet with these corners in any order (any points), or k_none.
  std::uint32_t find_facet(std::uint32_t a, std::uint32_t b, std::uint32_t c) const;

 private:
  struct AtPoint {
    std::uint32_t middle, high, facet;
  };
  std::span<const Facet> facets_;
  std::vector<std::uint32_t> first_edge_, low_, high_;  ///< edges, stored at their lower corner
  std::vector<std::uint32_t> first_facet_;
  std::vector<AtPoint> at_point_;  ///< facets, stored at their lowest corner
};

}  // namespace sterna::tets
