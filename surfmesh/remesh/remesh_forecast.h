// How many triangles remesh_surface() will make, by its sizes, and which patch takes most of them.
#pragma once

#include <span>
#include <string>

#include "geom/base/run_context.h"
#include "surfmesh/remesh/remesh_surface.h"

namespace sterna::surfmesh {

struct RemeshForecast {
  double n_triangles = 0.0;
  std::string patch;          ///< that takes most of them
  double of_patch = 0.0;      ///< its triangles
  double least_edge = 0.0;    ///< m, the shortest in that patch
  Point place;                ///< where it is
  bool is_by_longest = true;  ///< max_edge asks for at least half of them; else curvature, narrow places or sources
};

/// From the sizes of the first round, without its triangles: within about 30 % of what remesh_surface() makes.
/// \throws Error of remesh_surface for options and surfaces that it refuses at once
RemeshForecast forecast_remesh(const TriMesh& wall, const RemeshOptions& options, std::span<const PatchSurfaceOptions> patches, const SpaceSizes& asked,
                               const RunContext& context);

}  // namespace sterna::surfmesh
