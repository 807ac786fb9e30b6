// Faces between straight lines in the parameter plane of a surface.
#pragma once

#include <cstddef>
#include <optional>
#include <vector>

#include "geom/model/model_builder.h"

namespace sterna {

/// A connected graph of edges that are straight lines in (u, v) and meet only at their ends, and the faces that it bounds.
class SideGraph {
 public:
  /// Mark of the faces on one side of a line; empty: the line sets none.
  using Mark = std::optional<std::size_t>;
  /// Adds a line. Ends of lines meet if their coordinates are identical to the bit. Lines of zero length are ignored.
  void add(EdgeId edge, Uv from, Uv to, Mark left = {}, Mark right = {});

  struct Loop {
    std::vector<ModelBuilder::Side> sides;  ///< counter-clockwise in (u, v)
    Mark mark;                              ///< the first mark among its lines on the loop's side
  };
  /// Returns all bounded faces, in the order in which their lines were added.
  std::vector<Loop> loops() const;

 private:
  struct Line {
    EdgeId edge;
    Uv from, to;
    Mark left, right;
  };
  std::vector<Line> lines_;
};

}  // namespace sterna
