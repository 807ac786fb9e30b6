// Sheets without thickness in a boundary (actuator discs): for an engine their two sides are one layer of facets inside the domain, for everybody else they are
// two surfaces back to back.
#pragma once

#include <array>
#include <cstdint>
#include <span>
#include <vector>

#include "geom/base/run_context.h"
#include "volmesh/tetra/tetra.h"

namespace sterna::volmesh {

/// A boundary whose sheets have one side. Points keep their order; of two at one place the first is kept.
struct JoinedBoundary {
  std::vector<Vec3> points;
  std::vector<std::array<std::uint32_t, 3>> facets;  ///< triangles of the boundary, then those of the sheets: of each its first side
  std::size_t n_sheets = 0;                          ///< of the facets, the last
  std::vector<std::uint32_t> facet2triangle;         ///< of each: its triangle of the boundary
  std::vector<std::array<std::uint32_t, 2>>
      sources;  ///< of each point: its points in the boundary on the first and on the second side; twice the same where they share it

  std::span<const std::array<std::uint32_t, 3>> triangles() const { return std::span(facets).first(facets.size() - n_sheets); }
  std::span<const std::array<std::uint32_t, 3>> sheets() const { return std::span(facets).last(n_sheets); }
};

/// Joins triangles with the same three places, one of which is the other one turned over. Serial, O(n log n).
/// \throws Error(bad_argument) with the place for an index out of range, for three points at one place, for a sheet's triangle whose corners are shared by both
/// sides (nothing could tell its sides), and when nothing lies back to back
JoinedBoundary join_sheets(const TetraBoundary& boundary, const RunContext& context);

/// From a mesh inside the joined boundary, each of whose sheets' triangles is a face of two tetrahedra, to one inside the boundary: each tetrahedron gets the
/// point of its own side. \p result: nodes are points of `joined`, then new ones.
/// \post the same of `boundary`
/// \throws Error(tetra_result_invalid) with the first place where the two sides of a sheet cannot be told
void part_sheets(const TetraBoundary& boundary, const JoinedBoundary& joined, TetraResult& result);

}  // namespace sterna::volmesh
