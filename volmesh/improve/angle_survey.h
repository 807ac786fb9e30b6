// Computes the dihedral angles of a tetrahedral mesh, and finds the tetrahedra beyond the limits.
#pragma once

#include <cstdint>
#include <numbers>
#include <vector>

#include "geom/base/run_context.h"
#include "volmesh/improve/tet_quality.h"
#include "volmesh/tetra/tetra.h"

namespace sterna::volmesh {

struct AngleSurvey {
  double smallest = std::numbers::pi;  ///< radians, smallest and largest dihedral angle
  double largest = 0.0;
  std::int64_t n_at_boundary = 0;  ///< number of tetrahedra with a vertex on the boundary
  std::vector<std::uint32_t> bad;  ///< tetrahedra beyond the limits, ascending
};

/// Computes the survey. \pre every tetrahedron is positive. Parallel, 60 ns per tetrahedron
AngleSurvey survey_angles(const TetraBoundary& boundary, const TetraResult& tets, const QualityLimits& limits, const RunContext& context);

}  // namespace sterna::volmesh
