// Wake sheets that domain/wake_sheets.h has added to a wall. They lie behind trailing edges, with one side for each side of the wing.
#pragma once

#include <array>
#include <cstddef>
#include <vector>

#include "geom/base/ids.h"
#include "geom/base/vec3.h"

namespace sterna::volmesh {

/// Wake sheets whose two sides have separate vertices. These are raised off their common base vertex by a hundredth of the first height, so that the wall is a
/// thin body. In the finished mesh they coincide with the base vertex again (layer/close_wakes.h). On the free edges of a sheet both sides share vertices, and
/// the growth lines of these vertices have no height.
struct DoubledSheets {
  struct BaseVertex {
    /// Left of the trailing edge: on the edge itself a vertex of the given wall; right of the trailing edge: always an added vertex.
    std::array<VertexId, 2> sides;
    Point point;                         ///< m
    std::array<VertexId, 2> start = {};  ///< vertices of both sides at which the streamwise line of this vertex leaves the trailing edge
    int row = 0;                         ///< number along the stream; 0: on the trailing edge
    double height_growth = 1.0;          ///< target ratio of the first heights of consecutive rows
    bool is_on_base = false;             ///< true on the edge of a blunt base: one side is a corner there, and may have a lower layer
  };
  std::size_t n_given_vertices = 0, n_given_triangles = 0;  ///< numbers of the wall before the sheets; vertices and triangles added by sheets follow
  std::vector<BaseVertex> base_vertices;                    ///< sorted by their first vertex
  std::vector<VertexId> borders;  ///< vertices on the free edges of the sheets, and the end vertices of the opened edges on the wall; ascending
  bool is_empty() const { return base_vertices.empty(); }
};

}  // namespace sterna::volmesh
