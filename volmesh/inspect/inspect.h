// The pre-flight inspection: will volume_mesh succeed, and with full layers? In seconds, before anything is meshed.
#pragma once

#include <optional>

#include "geom/base/run_context.h"
#include "volmesh/case/mesh_case.h"
#include "volmesh/flow/flow_state.h"
#include "volmesh/inspect/finding.h"
#include "volmesh/inspect/options.h"

namespace sterna::volmesh {

struct InspectRequest {
  MeshCase volume;  ///< as volume_mesh gets them; without a first height (of its own or of a rule) what needs one is left out, and the report says so
  InspectOptions limits;
  std::optional<FlowState> flow;  ///< for y+
};

/// Looks at a joined surface: closed or open, crossing or not. Never throws for a bad surface: what volume_mesh would say is a finding. Cost: about 10 s of
/// processor time per million triangles. The same report for any number of threads.
/// \pre manifold, consistently oriented, finite coordinates, no triangle with a repeated vertex (what surfmesh::stitch_surface gives with allow_open and
/// without check_intersections)
/// \throws Error(cancelled)
InspectReport inspect_wall(const TriMesh& surface, const InspectRequest& request, const RunContext& context);

/// Of triangles that could not be joined: only what needs no neighbours.
/// \pre indices in range; coordinates may be anything.
/// \throws Error(cancelled)
InspectReport inspect_triangles(const TriMesh& triangles, const InspectRequest& request, const RunContext& context);

/// Adds a finding in its place and marks the triangles in the field "finding".
void add_finding(InspectReport& report, Finding finding, const std::vector<TriangleId>& where);

}  // namespace sterna::volmesh
