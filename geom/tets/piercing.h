// What of a mesh is in the way of an edge or a facet that it does not have.
#pragma once

#include <array>
#include <cstdint>
#include <optional>
#include <vector>

#include "geom/tets/flips.h"

namespace sterna::tets {

/// What a segment crosses between two tetrahedra: a face, or an edge of the mesh.
struct Crossing {
  bool is_edge = false;
  std::uint32_t face = k_none;  ///< 4 tet + corner, where it is a face
  Edge edge{};                  ///< where it is an edge
};

/// What lies on the way from point a to point b, in order. None where the mesh has the edge.
/// \return nothing where the way leads through another point (exactly)
std::optional<std::vector<Crossing>> crossings(Flips& flips, std::uint32_t a, std::uint32_t b);

/// Edges of the mesh that pierce a facet, whose own edges are all there.
/// \return nothing where a point lies on the facet (exactly); empty where the mesh has the facet
std::optional<std::vector<Edge>> piercing_edges(Flips& flips, const Facet& facet);

/// Whether a segment goes through a triangle, both without their ends and corners (exact; touching does not count).
bool pierces(const TetMesh& mesh, std::uint32_t a, std::uint32_t b, std::uint32_t u, std::uint32_t v, std::uint32_t w);

}  // namespace sterna::tets
