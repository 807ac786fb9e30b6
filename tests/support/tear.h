// Tears surfaces as bad exports and scans do: holes, gaps, missing, duplicated and flipped facets, displaced vertices. Seeded: identical in every run.
#pragma once

#include <cstdint>

#include "geom/mesh/surface_soup.h"
#include "geom/mesh/tri_mesh.h"

namespace sterna::test {

struct TearOptions {
  std::uint64_t seed = 1;
  int holes = 5;
  double hole = 0.01;     ///< diameter, relative to the body length
  int gaps = 2;           ///< bands without facets, along planes
  double gap = 0.01;      ///< width of the gaps, relative to the body length
  double missing = 0.1;   ///< fraction of the facets
  double doubled = 0.1;   ///< fraction of the facets; some of the copies are flipped
  double flipped = 0.05;  ///< fraction of the facets
  double jitter = 1e-4;   ///< displacement of each vertex, relative to the body length
};

/// Returns the torn surface; each facet has three vertices of its own, as in an STL file.
SurfaceSoup tear(const TriMesh& mesh, const TearOptions& options);

}  // namespace sterna::test
