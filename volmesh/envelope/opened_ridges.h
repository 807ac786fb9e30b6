// Ridges opened by domain/open_ridges.h: vertices on sharp edges with several growth lines each, and virtual triangles that close the gaps between these growth
// lines.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <vector>

#include "geom/base/ids.h"
#include "geom/base/vec3.h"

namespace sterna::volmesh {

/// Opened ridges of a wall. The wall vertices of one multi-normal fan have one common ridge base vertex. The first vertex of a fan is the vertex of the given
/// wall. The other vertices follow all given vertices. All vertices of a fan are raised off the ridge base vertex by a hundredth of the first height, so that
/// virtual triangles have an area. In the finished mesh they coincide with the ridge base vertex again (layer/close_multi_normals.h).
struct OpenedRidges {
  struct BaseVertex {
    VertexId vertex;    ///< the first vertex of the fan
    Point point;        ///< m, point of the vertex in the given wall
    Vec3 middle;        ///< unit, bisector of the normals of both sides
    double visibility;  ///< smallest cosine between `middle` and these normals
    double to_end;      ///< m, distance along the ridge to its nearer end; infinite for a ridge without end
  };
  std::size_t n_given_vertices = 0, n_given_triangles = 0;  ///< numbers of the given wall; added vertices of the fans and virtual triangles follow these
  std::vector<BaseVertex> base_vertices;                    ///< sorted by vertex
  Column<VertexId, VertexId>
      base_vertex;  ///< for each vertex the first vertex of its fan, or the vertex itself if it belongs to no fan; empty: no ridge is opened
  std::vector<std::array<VertexId, 4>> quads;  ///< virtual quadrilaterals, counter-clockwise as seen from the fluid; vertices 0 and 3 have one ridge base
                                               ///< vertex, 1 and 2 the other; the triangles are 012 and 023
  /// Virtual triangles from a fan to the end of its ridge: first the end vertex, then two vertices with one ridge base vertex.
  std::vector<std::array<VertexId, 3>> ends;
  /// Virtual triangles between growth lines of one ridge base vertex where ridges meet, counter-clockwise as seen from the fluid.
  std::vector<std::array<VertexId, 3>> corners;
  std::vector<VertexId> end_vertices;  ///< end vertices in `ends`, ascending; their growth lines have one layer less, next to the wall
  bool is_empty() const { return base_vertices.empty(); }
};

}  // namespace sterna::volmesh
