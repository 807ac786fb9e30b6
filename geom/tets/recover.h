// Fills a boundary with tetrahedra so that all its triangles are recovered exactly as faces. It starts with the Delaunay tetrahedra of the boundary points and
// flips until no edge and no facet is missing.
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
  std::int64_t n_missing_edges = 0;   ///< missing in the Delaunay mesh
  std::int64_t n_missing_facets = 0;  ///< missing after all edges were recovered
  std::int64_t n_points = 0;          ///< points added in the volume because flips were not sufficient
};

/// The first few edges and facets that could not be recovered by flips and points.
struct RecoverFailure {
  std::string problem;
  std::vector<Vec3> locations;
  std::int64_t n_locations = 0;
};

struct Recovery {
  TetMesh mesh;  ///< empty if the recovery failed
  RecoverReport report;
  RecoverFailure failure;
};

/// \p facets: normals into the domain; closed; they meet in common corners and edges only. \p baffles: facets inside the domain, with the domain on both sides.
/// The Delaunay mesh of the points alone already contains nearly all required facets: 2 % of the edges of a layer envelope are missing. Each missing edge is
/// recovered by removing the entities that it crosses, face by face and edge by edge (George, Hecht and Saltel 1991 for the method, Shewchuk 2002 and Si 2015
/// for edges removed from rings), so that the number of crossings decreases each time. Where no flip helps, a point inserted in the volume nearby makes further
/// flips possible. Points are inserted in parallel, flips are serial; the result has the same bytes for any number of threads. O(n log n).
/// \post unless the recovery failed: faces without neighbour are exactly the facets; the given points come first, points added in the volume after them
/// \throws Error(cancelled)
Recovery recover(std::span<const Vec3> points, std::span<const Facet> facets, std::span<const Facet> baffles, const RunContext& context);

}  // namespace sterna::tets
