// Finds mesh entities that obstruct a missing edge or facet.
#pragma once

#include <array>
#include <cstdint>
#include <optional>
#include <vector>

#include "geom/tets/flips.h"

namespace sterna::tets {

/// Entity crossed by a segment between two tetrahedra: a face, or an edge of the mesh.
struct Crossing {
  bool is_edge = false;
  std::uint32_t face = k_none;  ///< 4 tet + corner, if it is a face
  Edge edge{};                  ///< if it is an edge
};

/// Returns the entities on the segment from point a to point b, in order. Empty if the mesh has the edge.
/// \return nothing if the segment passes through another point (exactly)
std::optional<std::vector<Crossing>> crossings(Flips& flips, std::uint32_t a, std::uint32_t b);

/// Returns the edges of the mesh that pierce a facet whose own edges all exist; an empty list if the mesh has the facet.
/// \return nothing if a point lies on the facet (exactly)
std::optional<std::vector<Edge>> piercing_edges(Flips& flips, const Facet& facet);

/// Returns true if a segment passes through a triangle. Ends of the segment and corners of the triangle do not count, nor does touching (exact).
bool pierces(const TetMesh& mesh, std::uint32_t a, std::uint32_t b, std::uint32_t u, std::uint32_t v, std::uint32_t w);

}  // namespace sterna::tets
