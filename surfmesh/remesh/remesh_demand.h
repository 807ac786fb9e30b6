// Remeshing whose only purpose is to remove sliver triangles: it ends as soon as it is clear that they remain.
#pragma once

#include <cstdint>
#include <limits>
#include <span>

#include "surfmesh/remesh/remesh_surface.h"

namespace sterna::surfmesh {

/// Requirements for a result.
struct RemeshDemand {
  double most_needles = std::numeric_limits<double>::infinity();              ///< largest fraction of triangles with an angle below k_needle_angle
  double least_angle = 0.0;                                                   ///< rad
  double largest_distance = std::numeric_limits<double>::infinity();          ///< relative to the body length, between the two surfaces, measured in both
                                                                              ///< directions
  double largest_distance_of_edge = std::numeric_limits<double>::infinity();  ///< relative to the new triangles' edges there
  double more_turned = std::numeric_limits<double>::infinity();               ///< fraction of the area turned, in excess of that of the given triangles
};

/// Calls remesh_surface but ends early. It ends before the work if corners of lines, which stay, force more sliver triangles than allowed (edges between two
/// corners that are much shorter than the target edges there). It also ends after a round that does not meet the demand, even if triangles cross: later
/// rounds keep more of the given triangles. A result that is farther from the given surface than allowed, or turned more, is refused at the end.
/// \throws Error as remesh_surface; Error(geometry_failed) with the location of the thinnest triangle, or of the largest distance, if it ends early
RemeshResult remesh_surface(const TriMesh& wall, const RemeshOptions& options, std::span<const PatchSurfaceOptions> patches, const SpaceSizes& asked,
                            const RemeshDemand& demand, const RunContext& context);

/// Checks distance and turn of a result, also of one that was made without demand.
/// \throws Error(geometry_failed), with the location of the largest distance, if distance or turn exceed the demand
void require_likeness(const RemeshReport& report, const RemeshDemand& demand);

}  // namespace sterna::surfmesh
