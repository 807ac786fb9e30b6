// Tears surfaces as bad exports and scans do: holes, gaps, facets missing, doubled and turned, vertices off their place. Seeded: the same in every run.
#pragma once

#include <cstdint>

#include "geom/mesh/surface_soup.h"
#include "geom/mesh/tri_mesh.h"

namespace sterna::test {

struct TearOptions {
  std::uint64_t seed = 1;
  int holes = 5;
  double hole = 0.01;     ///< diameter, of the body length
  int gaps = 2;           ///< bands without facets, along planes
  double gap = 0.01;      ///< their width, of the body length
  double missing = 0.1;   ///< share of the facets
  double doubled = 0.1;   ///< share; some of the copies are turned
  double flipped = 0.05;  ///< share
  double jitter = 1e-4;   ///< of the body length, for each vertex
};

/// Each facet with three vertices of its own, as in an STL file.
SurfaceSoup tear(const TriMesh& mesh, const TearOptions& options);

}  // namespace sterna::test
