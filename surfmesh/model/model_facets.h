// Triangles of a model for display, made in hundredths of a second for any faces. They are not suited as a solver mesh, because they are long and thin where
// the surface is straight.
#pragma once

#include <array>
#include <cstdint>
#include <vector>

#include "geom/base/run_context.h"
#include "geom/model/model.h"

namespace sterna::surfmesh {

struct FacetOptions {
  double tolerance = 2e-4;      ///< relative to the model's longest side: approximate limit for the distance of triangle and edge middles from the surface
  bool with_curvature = false;  ///< compute the curvature of every triangle, which doubles the time
};

/// Triangles for display. Neighbouring faces share the points of their edges, except faces whose borders run around a period without a seam.
struct ModelFacets {
  std::vector<Point> points;                            ///< m
  std::vector<std::array<std::uint32_t, 3>> triangles;  ///< counter-clockwise seen from the side of the face's outward normal
  std::vector<FaceId> face;                             ///< face of each triangle, ascending
  std::vector<std::uint8_t> edges;                      ///< bits of each triangle; bit k: the side from corner k to corner k + 1 lies on the border of its face
  std::vector<double> curvature;  ///< 1/m, at the middle of each triangle: magnitude of the larger principal curvature; empty unless requested
  std::vector<FaceId> untrimmed;  ///< faces whose borders cross themselves in (u, v); they get the triangles whose middle is inside
};

/// Divides every edge by its chord error. Divides every face by the rows of a grid as fine as its curvature requires, and joins edges and grid by a Delaunay
/// triangulation in (u, v). The result depends on the model alone, not on the number of threads.
/// \throws Error(cancelled)
ModelFacets facets_of(const Model& model, const FacetOptions& options, const RunContext& context);

}  // namespace sterna::surfmesh
