// Forecast of the number of triangles of remesh_surface() from its sizes, with the patch that gets most of them.
#pragma once

#include <span>
#include <string>

#include "geom/base/run_context.h"
#include "surfmesh/remesh/remesh_surface.h"

namespace sterna::surfmesh {

struct RemeshForecast {
  double n_triangles = 0.0;
  std::string patch;          ///< patch with most of the triangles
  double of_patch = 0.0;      ///< number of triangles of that patch
  double least_edge = 0.0;    ///< m, shortest target edge in that patch
  Point location;             ///< location of the shortest edge
  bool is_by_longest = true;  ///< true if max_edge causes at least half of the triangles; else curvature, narrow regions or sources do
};

/// Computes the forecast from the sizes of the first round, without making triangles. It is within about 30 % of the result of remesh_surface().
/// \throws the errors of remesh_surface for options and surfaces that it refuses before its work
RemeshForecast forecast_remesh(const TriMesh& wall, const RemeshOptions& options, std::span<const Rule> patches, const SpaceSizes& requested,
                               const RunContext& context);

}  // namespace sterna::surfmesh
