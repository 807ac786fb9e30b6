// Triangles of a model for pictures: in hundredths of a second, whatever its faces look like. No mesh for a solver: long and thin where the surface is
// straight.
#pragma once

#include <array>
#include <cstdint>
#include <vector>

#include "geom/base/run_context.h"
#include "geom/model/model.h"

namespace sterna::surfmesh {

struct FacetOptions {
  double tolerance = 2e-4;      ///< of the model's longest side: triangles' middles and edges are about so near to the surface
  bool with_curvature = false;  ///< of every triangle, which takes as long again
};

/// Neighbouring faces share the points of their edges, but for faces whose borders run around a period without a seam.
struct ModelFacets {
  std::vector<Point> points;                            ///< m
  std::vector<std::array<std::uint32_t, 3>> triangles;  ///< counter-clockwise seen from the side that the face's outward normal points to
  std::vector<FaceId> face;                             ///< of each triangle, ascending
  std::vector<std::uint8_t> edges;                      ///< of each triangle; bit k: corner k to corner k + 1 lies on the border of its face
  std::vector<double> curvature;                        ///< of each triangle's middle, 1/m: the larger principal curvature's magnitude; empty unless asked for
  std::vector<FaceId> untrimmed;                        ///< faces whose borders cross themselves in (u, v): triangles of which the middle is inside
};

/// Cuts every edge by its chord, every face by rows of a grid as fine as its curvature asks for, joined by a Delaunay triangulation in (u, v). Depends on the
/// model alone, not on the threads.
/// \throws Error(cancelled)
ModelFacets facets_of(const Model& model, const FacetOptions& options, const RunContext& context);

}  // namespace sterna::surfmesh
