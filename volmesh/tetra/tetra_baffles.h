// Sheets without thickness in a boundary (actuator discs). For an engine, their two sides are a single layer of facets inside the domain. For all other code,
// they are two surfaces back to back.
#pragma once

#include <array>
#include <cstdint>
#include <span>
#include <vector>

#include "geom/base/run_context.h"
#include "volmesh/tetra/tetra.h"

namespace sterna::volmesh {

/// A boundary in which each baffle is a single layer of facets: its two sides are joined. Points keep their order. If two points have the same location, only
/// the first is kept.
struct JoinedBoundary {
  std::vector<Vec3> points;
  std::vector<std::array<std::uint32_t, 3>> facets;  ///< triangles of the boundary, then those of the baffles, which are represented by their first side
  std::size_t n_baffles = 0;                         ///< number of baffle facets, which are the last
  std::vector<std::uint32_t> facet2triangle;         ///< triangle of the boundary for each facet
  std::vector<std::array<std::uint32_t, 2>>
      sources;  ///< points in the boundary on the first and on the second side for each point; both are the same if both sides share the point

  std::span<const std::array<std::uint32_t, 3>> triangles() const { return std::span(facets).first(facets.size() - n_baffles); }
  std::span<const std::array<std::uint32_t, 3>> baffles() const { return std::span(facets).last(n_baffles); }
};

/// Joins triangles with the same three locations and opposite orientation. Serial, O(n log n).
/// \throws Error(bad_argument) with the location for an index out of range, for three points at one location, for a baffle's triangle whose corners are all
/// shared by both sides (its sides cannot be distinguished), and if no triangles lie back to back
JoinedBoundary join_baffles(const TetraBoundary& boundary, const RunContext& context);

/// Converts a mesh inside the joined boundary, in which each triangle of the sheets is a face of two tetrahedra, to a mesh inside the boundary. Each
/// tetrahedron gets the points of its own side. \p result its nodes are points of `joined`, then new ones
/// \post nodes of the result are points of `boundary`, then new ones
/// \throws Error(tetra_result_invalid) with the first location at which the two sides of a sheet cannot be distinguished
void part_baffles(const TetraBoundary& boundary, const JoinedBoundary& joined, TetraResult& result);

}  // namespace sterna::volmesh
