// The pre-flight inspection: predicts in seconds, before meshing, if volume_mesh will succeed with full layers.
#pragma once

#include <optional>

#include "geom/base/run_context.h"
#include "volmesh/case/mesh_case.h"
#include "volmesh/flow/flow_state.h"
#include "volmesh/inspect/finding.h"
#include "volmesh/inspect/options.h"

namespace sterna::volmesh {

struct InspectRequest {
  MeshCase volume;  ///< as volume_mesh receives them; without a first height (global or in a rule), checks that need one are skipped, and the report lists this
  InspectOptions limits;
  std::optional<FlowState> flow;  ///< for y+
};

/// Inspects a joined surface, closed or open, with or without intersections. Never throws for a bad surface: errors of volume_mesh are findings. Cost: about 10
/// s of processor time per million triangles. The report is the same for any number of threads.
/// \pre manifold, consistently oriented, finite coordinates, no triangle with a repeated vertex (the result of surfmesh::stitch_surface with allow_open and
/// without check_intersections)
/// \throws Error(cancelled)
InspectReport inspect_wall(const TriMesh& surface, const InspectRequest& request, const RunContext& context);

/// Inspects triangles that could not be joined: only checks that need no neighbours.
/// \pre indices in range; coordinates may be arbitrary.
/// \throws Error(cancelled)
InspectReport inspect_triangles(const TriMesh& triangles, const InspectRequest& request, const RunContext& context);

/// Inserts a finding at its position and marks the triangles in the field "finding".
void add_finding(InspectReport& report, Finding finding, const std::vector<TriangleId>& where);

}  // namespace sterna::volmesh
