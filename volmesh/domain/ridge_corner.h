// Where ridges meet (open_ridges.h): which normals the lines of a corner have.
#pragma once

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <vector>

#include "geom/base/ids.h"
#include "geom/base/vec3.h"

namespace sterna::volmesh {

/// The turn across an edge of a ridge, from the normal of its left side to that of its right one.
struct RidgeTurn {
  double angle = 0.0;  ///< rad
  Vec3 axis;           ///< unit: turns the left normal towards the right one
  /// The left normal turned by so much.
  Vec3 turned(const Vec3& left, double by) const { return normalized(std::cos(by) * left + std::sin(by) * cross(axis, left)); }
};

/// A vertex at which ridges meet, or one bends by too much for the inside of a chain: a line for each side between two of its ridges, those of the fans
/// between them, and one in the middle.
struct RidgeCorner {
  std::vector<HalfedgeId> edges;             ///< of ridges, outgoing, counter-clockwise
  std::vector<Vec3> normal;                  ///< unit, of the side left of each
  std::vector<RidgeTurn> turn;               ///< across each: between the facets at it
  std::vector<Vec3> facet;                   ///< unit normal of the left one of these
  std::vector<int> n_sectors;                ///< of the fan across each; 0: not known yet
  std::vector<std::vector<VertexId>> lines;  ///< from left to right of each
  VertexId middle;                           ///< the line in the middle

  const Vec3& right_normal(std::size_t i) const { return normal[(i + normal.size() - 1) % normal.size()]; }
  std::size_t edge_number(HalfedgeId h) const { return static_cast<std::size_t>(std::ranges::find(edges, h) - edges.begin()); }

  /// Of the lines from left to right of an edge: around it from facet to facet, moved to the sides' normals at both ends. \pre n_sectors known
  std::vector<Vec3> normals_across(std::size_t i) const;
  /// Of the line in the middle: the area vector of the spherical polygon of all these.
  Vec3 middle_normal() const;
  /// Whether the triangles between middle and polygon cover it and are seen well from their lines. In notches, where lines would meet, they are not.
  bool is_star() const;
};

}  // namespace sterna::volmesh
