// Corners where ridges meet (open_ridges.h): normals of their growth lines.
#pragma once

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <vector>

#include "geom/base/ids.h"
#include "geom/base/vec3.h"

namespace sterna::volmesh {

/// The turn across an edge of a ridge, from the normal of its left side to that of its right side.
struct RidgeTurn {
  double angle = 0.0;  ///< rad, angle of the turn
  Vec3 axis;           ///< unit axis about which the left normal turns towards the right one
  /// Returns the left normal turned by the angle `by`.
  Vec3 turned(const Vec3& left, double by) const { return normalized(std::cos(by) * left + std::sin(by) * cross(axis, left)); }
};

/// A vertex at which ridges meet, or at which a ridge bends too much to be inside a chain. It has a growth line for each side between two of its ridges, the
/// growth lines of the multi-normal fans between them, and one in the middle.
struct RidgeCorner {
  std::vector<HalfedgeId> edges;             ///< outgoing ridge edges, counter-clockwise
  std::vector<Vec3> normal;                  ///< unit normal of the side left of each edge
  std::vector<RidgeTurn> turn;               ///< turn across each edge, between the normals of its two facets
  std::vector<Vec3> facet;                   ///< unit normal of the left facet of each edge
  std::vector<int> n_sectors;                ///< number of sectors of the fan across each edge; 0: not known yet
  std::vector<std::vector<VertexId>> lines;  ///< growth lines of each edge, from left to right of it
  VertexId middle;                           ///< the middle growth line

  const Vec3& right_normal(std::size_t i) const { return normal[(i + normal.size() - 1) % normal.size()]; }
  std::size_t edge_number(HalfedgeId h) const { return static_cast<std::size_t>(std::ranges::find(edges, h) - edges.begin()); }

  /// Returns the normals of the growth lines from left to right of an edge. They turn around the edge from facet to facet, and are adjusted to the normals of
  /// the sides at both ends. \pre n_sectors are known
  std::vector<Vec3> normals_across(std::size_t i) const;
  /// Returns the normal of the middle growth line: the area vector of the spherical polygon that all these normals form.
  Vec3 middle_normal() const;
  /// Returns true if the triangles between the middle and the polygon cover the polygon, and are well visible from their growth lines. This is not so in
  /// notches, where growth lines would meet.
  bool is_star() const;
};

}  // namespace sterna::volmesh
