// Places with a size, and the smallest size that grows from any of them to a point.
#pragma once

#include <array>
#include <cstdint>
#include <span>
#include <vector>

#include "geom/base/run_context.h"
#include "geom/base/vec3.h"
#include "geom/mesh/tri_mesh.h"

namespace sterna::volmesh {

struct SizeSite {
  Vec3 at;            ///< m
  double size = 0.0;  ///< m, positive
};

/// Hierarchy over sites for min over sites of (size + slope * distance), a nearest-neighbour search with additive weights.
class SizeSites {
 public:
  /// Built in parallel, O(n log n).
  /// \pre at least one site, finite coordinates.
  SizeSites(std::span<const SizeSite> sites, double slope, const RunContext& context);

  /// The minimum over all sites, exact to rounding. \p hint: a site to start from, changed to the one that gave the minimum (any value below size() is correct;
  /// a neighbour's makes the search short).
  double smallest(const Vec3& p, std::uint32_t& hint) const;
  std::size_t size() const { return sites_.size(); }

 private:
  struct Node {
    std::array<float, 3> min, max;  ///< rounded outwards
    float smallest;                 ///< of the sizes below, rounded down
    std::uint32_t first;            ///< leaf: first site; inner: left child, the right one follows
    std::uint32_t count;            ///< leaf: number of sites; inner: 0
  };
  double lower_bound(const Node& node, const Vec3& p) const;

  double slope_;
  std::vector<Node> nodes_;
  std::vector<SizeSite> sites_;  ///< in the order of the leaves
};

}  // namespace sterna::volmesh
