// The wanted length of edges all over a model: the least of what sources ask for, growing with the distance from them.
#pragma once

#include <cstdint>
#include <vector>

#include "geom/base/vec3.h"

namespace sterna::surfmesh {

/// At `point` edges are at most `size` metres long.
struct SizeSource {
  Point point;
  double size = 0.0;
};

/// size(p) = min over sources of size_i + growth |p - x_i|, through space: a lower bound of what SurfaceSizes carries along the surface.
/// Sources nearer to each other than half of their size are thinned to the least of them.
class SizeField {
 public:
  /// `growth`: change of length by distance, > 0. Only sources below `largest` matter.
  SizeField(std::vector<SizeSource> sources, double growth, double largest);
  /// Metres; `cap` where no source asks for less; the least within `reach` of p. From many threads.
  double operator()(const Point& p, double cap, double reach = 0.0) const;
  std::size_t n_sources() const { return sources_.size(); }
  double growth() const { return growth_; }

 private:
  struct Node {
    Point low, high;
    double least = 0.0;                  ///< size of its sources
    std::uint32_t first = 0, count = 0;  ///< of sources_
    std::uint32_t right = 0;             ///< child; the left one follows its parent. 0: a leaf
  };
  std::uint32_t build(std::uint32_t first, std::uint32_t count);

  std::vector<SizeSource> sources_;
  std::vector<Node> nodes_;
  double growth_;
};

}  // namespace sterna::surfmesh
