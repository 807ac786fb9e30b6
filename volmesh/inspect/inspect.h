// The pre-flight inspection predicts in seconds, before meshing, if volume_mesh will succeed with full layers.
#pragma once

#include <optional>

#include "geom/base/run_context.h"
#include "volmesh/case/mesh_case.h"
#include "volmesh/flow/flow_state.h"
#include "volmesh/inspect/finding.h"
#include "volmesh/inspect/options.h"

namespace sterna::volmesh {

struct InspectRequest {
  MeshCase volume;  ///< options as volume_mesh receives them; without a first height (for all walls or in a rule), checks that need one are skipped and listed
                    ///< in the report
  InspectOptions limits;
  std::optional<FlowState> flow;  ///< flow conditions, for y+
};

/// Inspects a joined surface, which may be open and may intersect itself. Never throws for a bad surface, because errors of volume_mesh become findings. Takes
/// about 10 s of processor time per million triangles. The report is the same for any number of threads.
/// \pre the surface is manifold and consistently oriented, has finite coordinates and no triangle with a repeated vertex (it is the result of
/// surfmesh::stitch_surface with allow_open and without check_intersections)
/// \throws Error(cancelled)
InspectReport inspect_wall(const TriMesh& surface, const InspectRequest& request, const RunContext& context);

/// Inspects triangles that could not be joined, by the checks that need no neighbours.
/// \pre indices are in range; coordinates may have any value
/// \throws Error(cancelled)
InspectReport inspect_triangles(const TriMesh& triangles, const InspectRequest& request, const RunContext& context);

/// Inserts a finding at its position, and marks its triangles in the field "finding".
void add_finding(InspectReport& report, Finding finding, const std::vector<TriangleId>& where);

}  // namespace sterna::volmesh
