// Private to surfmesh/wrap: moves many vertices at once, each as far as possible without self-intersection.
#pragma once

#include <array>
#include <cstdint>
#include <vector>

#include "geom/base/run_context.h"
#include "geom/base/vec3.h"

namespace sterna::surfmesh {

struct ClearMoveLimits {
  double max_turn = 1.2;      ///< rad; largest turn of a triangle
  double least_angle = 0.05;  ///< rad; smallest angle of a triangle, unless it had less than half of it before
  bool is_whole = false;      ///< true: a vertex moves to its target or not at all; false: also to a half, a quarter etc. of the distance
};

struct ClearMove {
  std::vector<Vec3> points;
  std::vector<char> has_arrived;  ///< per vertex: true if it reached its target
};

/// Moves vertices in rounds. In each round, a triangle that turns too far or becomes too thin resets its vertex that moves farthest. Once there are no such
/// triangles, crossing pairs reset all of their vertices. The loop ends, because every round resets at least one vertex, and the initial state is valid.
/// Parallel; the result does not depend on the number of threads.
/// \pre no self-intersection; one target for each point
ClearMove move_clear(std::vector<Vec3> points, const std::vector<std::array<std::uint32_t, 3>>& triangles, const std::vector<Vec3>& targets,
                     const ClearMoveLimits& limits, const RunContext& context);

}  // namespace sterna::surfmesh
