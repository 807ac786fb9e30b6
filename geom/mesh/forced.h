// Proofs that the given boundary alone forces a value beyond its hard limit. Each proof is a bound, stated in docs/quality_gates.md. A value without proof
// does not count as forced.
#pragma once

#include <array>
#include <cstdint>
#include <optional>
#include <span>
#include <utility>
#include <vector>

#include "geom/base/borrowed.h"
#include "geom/mesh/check_parts.h"

namespace sterna::check_parts {

class GivenBoundary {
 public:
  explicit GivenBoundary(Borrowed<const HybridMesh> mesh);

  /// Returns a proof for G16. A wall node has the same wall edges in any mesh, so the ratio of their lengths bounds the measure. In layer j the ends of an edge
  /// are at most d and d' away from their base vertices. The longest wall edge L is then at least L - d - d' long, and the shortest, s, at most s + d + d'.
  std::optional<Forcing> edge_ratio(NodeId node, double limit) const;
  /// Returns a proof for G14. Tets at a boundary edge divide the fluid angle there: none of them has a larger angle.
  std::optional<Forcing> min_dihedral(const std::array<NodeId, 4>& tet, double limit) const;

 private:
  using Edge = std::pair<std::uint32_t, std::uint32_t>;
  struct Ring {
    double longest = 0.0, shortest = 0.0;  ///< m, bounds
  };
  /// A node of a line: the line's number and the node's layer.
  struct OnLine {
    std::uint32_t line = 0, layer = 0;
  };
  std::optional<OnLine> on_line(std::uint32_t node) const;
  double off_base(const OnLine& location) const;
  std::optional<Ring> ring_of(NodeId node) const;
  double fluid_angle(std::uint32_t a, std::uint32_t b) const;

  const HybridMesh& mesh_;
  std::vector<Edge> wall_edges_;                                  ///< wall edges, from each end, ascending
  std::vector<std::pair<Edge, std::uint32_t>> boundary_sides_;    ///< sides of boundary triangles, lower node first, ascending
  std::vector<std::pair<std::uint32_t, std::uint32_t>> line_at_;  ///< first node and line, ascending
};

}  // namespace sterna::check_parts
