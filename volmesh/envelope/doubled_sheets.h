// Wake sheets that domain/wake_sheets.h has added to a wall: behind trailing edges, one side for each side of the wing.
#pragma once

#include <array>
#include <cstddef>
#include <vector>

#include "geom/base/ids.h"
#include "geom/base/vec3.h"

namespace sterna::volmesh {

/// Wake sheets whose two sides have separate vertices, raised off their common base vertex by a hundredth of the first height, so that the wall is a thin
/// body; in the finished mesh they coincide with the base vertex again (layer/close_wakes.h). On the free edges of a sheet both sides share vertices, whose
/// growth lines have no height.
struct DoubledSheets {
  struct Foot {
    std::array<VertexId, 2> sides;       ///< left of the trailing edge: on the edge itself a given vertex; right of the trailing edge: always added
    Point point;                         ///< m
    std::array<VertexId, 2> start = {};  ///< vertices of the trailing edge on the same streamwise line, by sides
    int row = 0;                         ///< along the stream; 0: on the trailing edge
    double height_growth = 1.0;          ///< target ratio of first heights from row to row
    bool is_on_base = false;             ///< on the edge of a blunt base: one side is a corner there, and may have a lower layer
  };
  std::size_t n_given_vertices = 0, n_given_triangles = 0;  ///< counts of the wall; vertices and triangles added by sheets follow
  std::vector<Foot> feet;                                   ///< ascending by their first vertex
  std::vector<VertexId> rims;                               ///< free edges of the sheets, ends of the opened edges on the wall included; ascending
  bool is_empty() const { return feet.empty(); }
};

}  // namespace sterna::volmesh
