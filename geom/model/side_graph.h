// Faces between straight lines in the parameter plane of a surface.
#pragma once

#include <cstddef>
#include <optional>
#include <vector>

#include "geom/model/model_builder.h"

namespace sterna {

/// A connected net of edges whose places in (u, v) are straight lines that meet only at their ends, and the faces that it bounds.
class SideGraph {
 public:
  /// Mark of the faces at one side of a line; nothing: not said by it.
  using Mark = std::optional<std::size_t>;
  /// Ends of lines meet where their coordinates are the same to the bit. Lines of no length are left out.
  void add(EdgeId edge, Uv from, Uv to, Mark left = {}, Mark right = {});

  struct Loop {
    std::vector<ModelBuilder::Side> sides;  ///< counter-clockwise in (u, v)
    Mark mark;                              ///< the first that one of its lines has on the loop's side
  };
  /// All bounded faces, in the order of the lines that were added.
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
