// Tetrahedra inside a boundary whose triangles are all faces of them, to the bit: Delaunay tetrahedra of its points, then flips until no edge and no facet is
// missing.
#pragma once

#include <cstdint>
#include <span>
#include <string>
#include <vector>

#include "geom/base/run_context.h"
#include "geom/tets/facets.h"
#include "geom/tets/tet_mesh.h"

namespace sterna::tets {

struct RecoverReport {
  std::int64_t n_edges = 0, n_facets = 0;
  std::int64_t n_missing_edges = 0;   ///< of the Delaunay mesh
  std::int64_t n_missing_facets = 0;  ///< once all edges were there
  std::int64_t n_points = 0;          ///< put into the volume, because flips did not suffice
};

/// What flips and points could not make a part of the mesh, the first few.
struct RecoverFailure {
  std::string problem;
  std::vector<Vec3> places;
  std::int64_t n_places = 0;
};

struct Recovery {
  TetMesh mesh;  ///< empty: failed
  RecoverReport report;
  RecoverFailure failure;
};

/// \p facets: normals into the domain; closed; they meet in common corners and edges only. \p sheets: facets inside the domain, with it on both sides.
/// Triangulations of points alone are near to what is asked for: 2 % of the edges of a layer's envelope are missing. Each that is missing is made by removing
/// what it crosses, face by face and edge by edge (George, Hecht and Saltel 1991 for the idea, Shewchuk 2002 and Si 2015 for edges removed from rings), so that
/// the number of crossings falls each time; where no flip helps, a point in the volume beside the place makes others. Points parallel, flips serial; same bytes
/// for any number of threads. O(n log n).
/// \post faces without neighbour are the facets, no others; points first, those in the volume behind; or there is a failure
/// \throws Error(cancelled)
Recovery recover(std::span<const Vec3> points, std::span<const Facet> facets, std::span<const Facet> sheets, const RunContext& context);

}  // namespace sterna::tets
