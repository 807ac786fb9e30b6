// Private to surfmesh/wrap: many vertices moved at once, each as far as the surface stays clear of itself.
#pragma once

#include <array>
#include <cstdint>
#include <vector>

#include "geom/base/run_context.h"
#include "geom/base/vec3.h"

namespace sterna::surfmesh {

struct ClearMoveLimits {
  double max_turn = 1.2;      ///< rad; no triangle turns by more
  double least_angle = 0.05;  ///< rad; no triangle gets a smaller one, unless it had half of one
  bool is_whole = false;      ///< a vertex goes all the way or not at all; else half of it, a quarter ...
};

struct ClearMove {
  std::vector<Vec3> points;
  std::vector<char> has_arrived;  ///< per vertex: is at its target
};

/// Rounds: triangles that turn or get thin take back the vertex of theirs that goes farthest; when there are none, pairs that cross take back all of theirs.
/// Ends, because every round takes back something, and nobody's moving is where it began. Parallel, the same for any number of threads.
/// \pre clear of itself; one target for each point
ClearMove move_clear(std::vector<Vec3> points, const std::vector<std::array<std::uint32_t, 3>>& triangles, const std::vector<Vec3>& targets,
                     const ClearMoveLimits& limits, const RunContext& context);

}  // namespace sterna::surfmesh
