// Remeshing that is only worth its time where needles go: it ends as soon as it is seen that they do not.
#pragma once

#include <cstdint>
#include <limits>
#include <span>

#include "surfmesh/remesh/remesh_surface.h"

namespace sterna::surfmesh {

/// What a result has to meet.
struct RemeshDemand {
  double most_needles = std::numeric_limits<double>::infinity();              ///< triangles with an angle below k_needle_angle, of all
  double least_angle = 0.0;                                                   ///< rad
  double largest_distance = std::numeric_limits<double>::infinity();          ///< of the body's length, between the two surfaces, seen from either
  double largest_distance_of_edge = std::numeric_limits<double>::infinity();  ///< of the new triangles' edges there
  double more_turned = std::numeric_limits<double>::infinity();               ///< share of the area turned, more than of the given triangles
};

/// remesh_surface that gives up early: before the work, where corners of lines, which stay, force more needles than that (edges between two corners that are
/// much shorter than the edges there will be); and after a round that does not meet the demand, whatever crosses: later rounds keep more of the given
/// triangles. A result that is further from the given surface than demanded, or turned more, is refused at last.
/// \throws Error as remesh_surface; Error(geometry_failed) with the place of the thinnest triangle, or of the largest distance, where it gives up
RemeshResult remesh_surface(const TriMesh& wall, const RemeshOptions& options, std::span<const PatchSurfaceOptions> patches, const SpaceSizes& asked,
                            const RemeshDemand& demand, const RunContext& context);

/// \throws Error(geometry_failed), with the place of the largest distance, where distance or turn are more than demanded: also for a result that was made
/// without demand
void require_likeness(const RemeshReport& report, const RemeshDemand& demand);

}  // namespace sterna::surfmesh
