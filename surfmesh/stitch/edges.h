// Edges of an indexed surface that may be anything: open, with many triangles at an edge, inconsistently oriented.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "geom/base/run_context.h"
#include "surfmesh/stitch/weld.h"

namespace sterna::surfmesh {

/// One use of an undirected edge a < b by a triangle.
struct EdgeUse {
  std::uint32_t a, b;
  std::uint32_t triangle;
  std::uint8_t is_forward;  ///< the triangle runs from a to b
};

class EdgeTable {
 public:
  EdgeTable(const IndexedSurface& surface, const RunContext& context);
  /// Calls f(uses) for each undirected edge, edges in ascending order.
  template <class F>
  void for_each(const F& f) const {
    for (std::size_t begin = 0; begin < uses_.size();) {
      std::size_t end = begin + 1;
      while (end < uses_.size() && uses_[end].a == uses_[begin].a && uses_[end].b == uses_[begin].b) ++end;
      f(std::span<const EdgeUse>(uses_.data() + begin, end - begin));
      begin = end;
    }
  }

 private:
  std::vector<EdgeUse> uses_;
};

/// First uses of the edges with one triangle (boundary) and with more than two.
struct EdgeDefects {
  std::vector<EdgeUse> boundary;
  std::vector<EdgeUse> crowded;
};
EdgeDefects find_defects(const EdgeTable& edges);

/// Vertices whose triangles form more than one fan. \pre no crowded edge.
std::vector<std::uint32_t> vertices_with_several_fans(const IndexedSurface& surface, const EdgeTable& edges);

}  // namespace sterna::surfmesh
