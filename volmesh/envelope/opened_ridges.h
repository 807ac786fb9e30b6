// Ridges opened by domain/open_ridges.h: vertices of sharp edges with several growth lines each, and virtual triangles that close the gaps between the growth
// lines.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <vector>

#include "geom/base/ids.h"
#include "geom/base/vec3.h"

namespace sterna::volmesh {

/// Opened ridges of a wall. The wall vertices of one multi-normal fan have one common ridge base vertex. The first vertex of a fan is the wall vertex as
/// given, the others follow all given vertices. All are raised off the ridge base vertex by a hundredth of the first height, so that virtual triangles have
/// an area; in the finished mesh they coincide with the ridge base vertex again (layer/close_fans.h).
struct OpenedRidges {
  struct Foot {
    VertexId vertex;    ///< the first vertex of the fan
    Point point;        ///< m, as given
    Vec3 middle;        ///< unit, bisector of the normals of both sides
    double visibility;  ///< cosine between `middle` and these normals
    double to_end;      ///< m, along the ridge to its nearer end; infinite for a ridge without end
  };
  std::size_t n_given_vertices = 0, n_given_triangles = 0;  ///< added vertices of the fans, and virtual triangles, follow these
  std::vector<Foot> feet;                                   ///< ascending by vertex
  Column<VertexId, VertexId> foot;                          ///< per vertex: the first vertex of its fan, or the vertex itself if it belongs to no fan; empty:
                                                            ///< no ridge is opened
  std::vector<std::array<VertexId, 4>> quads;               ///< seen from the fluid; 0 and 3 have one ridge base vertex, 1 and 2 the other; two triangles: 012,
                                                            ///< 023
  std::vector<std::array<VertexId, 3>> ends;                ///< virtual triangles from a fan to the end of its ridge: the end, then two vertices of one ridge
                                                            ///< base vertex
  std::vector<std::array<VertexId, 3>> corners;             ///< virtual triangles between growth lines of one ridge base vertex, where ridges meet; seen from
                                                            ///< the fluid
  std::vector<VertexId> end_vertices;                       ///< end vertices in `ends`, ascending: their growth lines have one layer less, at the wall
  bool is_empty() const { return feet.empty(); }
};

}  // namespace sterna::volmesh
