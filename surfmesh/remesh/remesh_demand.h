// Remeshing whose only purpose is to remove sliver triangles. It ends as soon as it is clear that they remain.
#pragma once

#include <cstdint>
#include <limits>
#include <span>

#include "surfmesh/remesh/remesh_surface.h"

namespace sterna::surfmesh {

/// Requirements for a result.
struct RemeshDemand {
  double most_slivers = std::numeric_limits<double>::infinity();  ///< largest fraction of triangles with an angle below k_sliver_angle
  double least_angle = 0.0;                                       ///< rad, smallest angle that the result may have
  /// Largest distance between the two surfaces in both directions, relative to the body length.
  double largest_distance = std::numeric_limits<double>::infinity();
  double largest_distance_of_edge = std::numeric_limits<double>::infinity();  ///< the same distance relative to the edges of the new triangles there
  double more_turned = std::numeric_limits<double>::infinity();  ///< largest increase of the turned fraction of the area over that of the given triangles
};

/// Calls remesh_surface, but ends early if the demand cannot be met. It ends before the work if corners of lines force more sliver triangles than allowed.
/// (Corners stay, and edges between two corners may be much shorter than the target edges there.) It ends after a round that does not meet the demand, even if
/// triangles cross, because later rounds keep more of the given triangles. At the end it refuses a result that is farther from the given surface than allowed,
/// or turned more.
/// \throws Error like remesh_surface; Error(geometry_failed) if it ends early, with the location of the thinnest triangle or of the largest distance
RemeshResult remesh_surface(const TriMesh& wall, const RemeshOptions& options, std::span<const Rule> patches, const SpaceSizes& requested,
                            const RemeshDemand& demand, const RunContext& context);

/// Checks the distance and the turn of a result. The result may have been made without demand.
/// \throws Error(geometry_failed), with the location of the largest distance, if distance or turn exceed the demand
void require_likeness(const RemeshReport& report, const RemeshDemand& demand);

}  // namespace sterna::surfmesh
