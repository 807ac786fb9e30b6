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
  double angle = 0.0;  ///< rad
  Vec3 axis;           ///< unit: turns the left normal towards the right one
  /// Returns the left normal turned by this angle.
  Vec3 turned(const Vec3& left, double by) const { return normalized(std::cos(by) * left + std::sin(by) * cross(axis, left)); }
};

/// A vertex at which ridges meet, or at which a ridge bends too much for the inside of a chain. It has a growth line for each side between two of its ridges,
/// the lines of the multi-normal fans between them, and one in the middle.
struct RidgeCorner {
  std::vector<HalfedgeId> edges;             ///< edges of ridges, outgoing, counter-clockwise
  std::vector<Vec3> normal;                  ///< unit normal of the side left of each edge
  std::vector<RidgeTurn> turn;               ///< turn across each edge: between its facets
  std::vector<Vec3> facet;                   ///< unit normal of the left facet of each edge
  std::vector<int> n_sectors;                ///< number of sectors of the fan across each edge; 0: not known yet
  std::vector<std::vector<VertexId>> lines;  ///< growth lines from left to right of each edge
  VertexId middle;                           ///< the middle growth line

  const Vec3& right_normal(std::size_t i) const { return normal[(i + normal.size() - 1) % normal.size()]; }
  std::size_t edge_number(HalfedgeId h) const { return static_cast<std::size_t>(std::ranges::find(edges, h) - edges.begin()); }

  /// Normals of the growth lines from left to right of an edge: around it from facet to facet, adjusted to the sides' normals at both ends. \pre n_sectors
  /// known
  std::vector<Vec3> normals_across(std::size_t i) const;
  /// Normal of the middle growth line: the area vector of the spherical polygon of all these normals.
  Vec3 middle_normal() const;
  /// Returns true if the triangles between middle and polygon cover the polygon and are well visible from their growth lines. In notches, where growth lines
  /// would meet, they are not.
  bool is_star() const;
};

}  // namespace sterna::volmesh
