// Private to surfmesh/wrap: moves many vertices at once, each as far as the surface does not intersect itself.
#pragma once

#include <array>
#include <cstdint>
#include <vector>

#include "geom/base/run_context.h"
#include "geom/base/vec3.h"

namespace sterna::surfmesh {

struct ClearMoveLimits {
  double max_turn = 1.2;      ///< rad; no triangle turns by more
  double least_angle = 0.05;  ///< rad; no triangle gets a smaller angle, unless it had less than half of it before
  bool is_whole = false;      ///< a vertex moves to its target or not at all; else to half of the distance, a quarter ...
};

struct ClearMove {
  std::vector<Vec3> points;
  std::vector<char> has_arrived;  ///< per vertex: is at its target
};

/// Moves vertices in rounds. In each round, triangles that turn or become thin reset the vertex that moves farthest. Once there are none, crossing pairs
/// reset all of their vertices. Terminates, because every round resets at least one vertex, and the initial state is valid. Parallel; the result does not
/// depend on the number of threads.
/// \pre no self-intersection; one target for each point
ClearMove move_clear(std::vector<Vec3> points, const std::vector<std::array<std::uint32_t, 3>>& triangles, const std::vector<Vec3>& targets,
                     const ClearMoveLimits& limits, const RunContext& context);

}  // namespace sterna::surfmesh
