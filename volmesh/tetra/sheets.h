// Sheets without thickness in a boundary (actuator discs): for an engine their two sides are one layer of facets inside the domain; for all other code they are
// two surfaces back to back.
#pragma once

#include <array>
#include <cstdint>
#include <span>
#include <vector>

#include "geom/base/run_context.h"
#include "volmesh/tetra/tetra.h"

namespace sterna::volmesh {

/// A boundary whose sheets have one side. Points keep their order; of two points at one location the first is kept.
struct JoinedBoundary {
  std::vector<Vec3> points;
  std::vector<std::array<std::uint32_t, 3>> facets;  ///< triangles of the boundary, then those of the sheets, each represented by its first side
  std::size_t n_sheets = 0;                          ///< number of sheet facets, which are the last
  std::vector<std::uint32_t> facet2triangle;         ///< for each facet: its triangle of the boundary
  std::vector<std::array<std::uint32_t, 2>>
      sources;  ///< for each point: its points in the boundary on the first and on the second side; identical if both sides share the point

  std::span<const std::array<std::uint32_t, 3>> triangles() const { return std::span(facets).first(facets.size() - n_sheets); }
  std::span<const std::array<std::uint32_t, 3>> sheets() const { return std::span(facets).last(n_sheets); }
};

/// Joins triangles with the same three locations and opposite orientation. Serial, O(n log n).
/// \throws Error(bad_argument) with the location for an index out of range, for three points at one location, for a sheet's triangle whose corners are shared
/// by both sides (its sides could not be distinguished), and if no triangles lie back to back
JoinedBoundary join_sheets(const TetraBoundary& boundary, const RunContext& context);

/// Converts a mesh inside the joined boundary, in which each triangle of the sheets is a face of two tetrahedra, to a mesh inside the boundary: each
/// tetrahedron gets the point of its own side. \p result: nodes are points of `joined`, then new ones.
/// \post nodes are points of `boundary`, then new ones
/// \throws Error(tetra_result_invalid) with the first location where the two sides of a sheet cannot be distinguished
void part_sheets(const TetraBoundary& boundary, const JoinedBoundary& joined, TetraResult& result);

}  // namespace sterna::volmesh
