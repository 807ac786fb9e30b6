// What domain/open_ridges.h has made of a wall: vertices of sharp edges with several lines each, and the gaps between these closed by virtual triangles.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <vector>

#include "geom/base/ids.h"
#include "geom/base/vec3.h"

namespace sterna::volmesh {

/// The wall vertices of one fan have one foot. The first of them is the wall vertex as it was given, the others follow all given vertices. All are raised off
/// the foot by a hundredth of the first height, so that virtual triangles have an area; the finished mesh has them on the foot again (layer/close_fans.h).
struct OpenedRidges {
  struct Foot {
    VertexId vertex;    ///< the first of the fan
    Point point;        ///< m, where it was given
    Vec3 middle;        ///< unit, between the normals of both sides
    double visibility;  ///< cosine between it and these
    double to_end;      ///< m, along the ridge to its nearer end; infinite where it has none
  };
  std::size_t n_given_vertices = 0, n_given_triangles = 0;  ///< those of the fans, and virtual triangles, follow
  std::vector<Foot> feet;                                   ///< ascending by vertex
  Column<VertexId, VertexId> foot;                          ///< of every vertex: the first of its fan, itself where it has none; empty: nothing is open
  std::vector<std::array<VertexId, 4>> quads;               ///< seen from the fluid; 0 and 3 have one foot, 1 and 2 the other; two triangles: 012, 023
  std::vector<std::array<VertexId, 3>> ends;                ///< virtual triangles from a fan to the end of its ridge: the end, then two of one foot
  std::vector<std::array<VertexId, 3>> corners;             ///< virtual triangles between lines of one foot, where ridges meet; seen from the fluid
  std::vector<VertexId> end_vertices;                       ///< of them, ascending: their lines have one layer less, at the wall
  bool is_empty() const { return feet.empty(); }
};

}  // namespace sterna::volmesh
